#include "core/app/sweep/variations.h"

#include <glob.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <map>
#include <utility>

#include "core/app/experiment/exit_codes.h"
#include "core/app/files/json_file.h"
#include "core/app/files/yaml_file.h"
#include "core/kernel/interfaces/solver.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

namespace {

namespace fs = std::filesystem;
using NodeKind = ConfigNode::Kind;

constexpr std::size_t most_variations = 10000;

void refuse_repeated_keys(const ConfigNode& map, const std::string& name, ConfigErrors& errors) {
  std::map<std::string, Location> locations;
  for (std::size_t k = 0; k < map.entries.size(); ++k) {
    const auto [first, is_first] = locations.emplace(map.entries[k].first, map.key_locations[k]);
    if (!is_first)
      errors.push_back({map.key_locations[k], "repeated key \"" + first->first + "\" in " + name +
                                                  "; it is first set at " + first->second.text()});
  }
}

/// The name of each path of the grid: its last key, if that is unambiguous.
std::vector<std::string> short_keys(const ConfigNode& grid) {
  const auto last = [](const std::string& path) { return path.substr(path.rfind('.') + 1); };
  std::map<std::string, int> times;
  for (const auto& entry : grid.entries) ++times[last(entry.first)];
  std::vector<std::string> keys;
  for (const auto& entry : grid.entries)
    keys.push_back(times[last(entry.first)] == 1 ? last(entry.first) : entry.first);
  return keys;
}

/// The product of the grid's lists, the last one running fastest.
std::vector<Variation> product(const ConfigNode& grid, ConfigErrors& errors) {
  refuse_repeated_keys(grid, "grid", errors);
  std::size_t count = 1;
  for (std::size_t k = 0; k < grid.entries.size(); ++k) {
    const auto& [path, values] = grid.entries[k];
    if (values.kind != NodeKind::list || values.items.empty()) {
      errors.push_back({grid.key_locations[k], "\"" + path +
                                                   "\" in grid must be a list of at least one value, as in "
                                                   "\"refiner: [loop, midpoint]\""});
      return {};
    }
    count = std::min(count * values.items.size(), most_variations + 1);
  }
  if (count > most_variations) {
    errors.push_back({grid.where, "the grid has more than " + std::to_string(most_variations) +
                                      " variations; take some values out"});
    return {};
  }
  const std::vector<std::string> keys = short_keys(grid);
  std::vector<Variation> all(1);
  all[0].where = grid.where;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const auto& [path, values] = grid.entries[k];
    std::vector<Variation> longer;
    for (const Variation& before : all)
      for (const ConfigNode& value : values.items) {
        Variation& v = longer.emplace_back(before);
        v.set.add(path, value);
        v.set.key_locations.back() = grid.key_locations[k];
        const auto place = &value - values.items.data() + 1;  // a map's, in the list
        v.name +=
            (k > 0 ? "," : "") + keys[k] + "=" + (value.is_scalar() ? value.scalar : std::to_string(place));
      }
    all = std::move(longer);
  }
  return all;
}

Variation named(const ConfigNode& node, ConfigErrors& errors) {
  Variation v;
  schema_of<Variation>("a variation").read(&v, node, errors);
  if (!has_converged(v.expect.status) && v.expect.message.empty())
    errors.push_back({node.find("expect")->where,
                      "\"expect\" of a status other than converged needs a \"message\": a part of the "
                      "expected message then"});
  check_settings(v.set, errors);
  if (v.levels) {
    if (const std::optional<Location> other = v.set.remove("levels"))
      errors.push_back(
          {*other, "\"levels\" is given twice in variation \"" + v.name + "\"; take one of them out"});
    v.set.add("levels", *node.find("levels"));  // it comes first
    std::ranges::rotate(v.set.entries, v.set.entries.end() - 1);
    std::ranges::rotate(v.set.key_locations, v.set.key_locations.end() - 1);
  }
  v.where = node.where_of("name");
  v.methods_where = node.where_of("methods");
  if (v.name.empty() && node.find("name"))
    errors.push_back({v.where, "\"name\" in a variation must not be empty"});
  return v;
}

struct GridParameters {
  ConfigNode grid;
  static void declare(Declaration<GridParameters>& d) { d.add("grid", &GridParameters::grid).required(); }
};

void check_names(const std::vector<Variation>& all, ConfigErrors& errors) {
  std::map<std::string, std::string> names;  // by folder
  for (const Variation& v : all) {
    const std::string folder = folder_name(v.name);
    if (const std::string fault = fault_of_file_name(folder); !fault.empty())
      errors.push_back({v.where, "variation \"" + v.name + "\" names a folder: it " + fault});
    const auto [other, first] = names.emplace(folder, v.name);
    if (first || v.name.empty()) continue;
    const std::string& name = other->second;
    errors.push_back({v.where, name == v.name
                                   ? "variation \"" + v.name + "\" is given twice; rename one of them"
                                   : "variations \"" + name + "\" and \"" + v.name +
                                         "\" would share the folder " + folder + "; rename one of them"});
  }
}

/// The files in a folder that match a pattern, sorted. A name without wildcard is returned whether it exists
/// or not.
std::vector<fs::path> files_of(const fs::path& folder, const std::string& pattern) {
  const char* const wildcards = "*?[";
  if (pattern.find_first_of(wildcards) == std::string::npos) return {folder / pattern};
  std::string literal;  // wildcards in the folder's own name are none
  for (const char c : folder.string()) {
    if (c == '\\' || std::strchr(wildcards, c)) literal += '\\';
    literal += c;
  }
  glob_t found{};
  std::vector<fs::path> files;
  if (glob((fs::path(literal) / pattern).c_str(), 0, nullptr, &found) == 0)
    for (std::size_t k = 0; k < found.gl_pathc; ++k) files.emplace_back(found.gl_pathv[k]);
  globfree(&found);
  return files;
}

void read_one(const fs::path& file, const std::string& key, const Location& where,
              std::vector<ExperimentSource>& all, ConfigErrors& errors) {
  const std::size_t before = errors.size();
  ConfigNode root = read_yaml(file, errors);
  if (errors.size() > before)
    errors[before].message += " (the sweep's \"" + key + "\", named at " + where.text() + ")";
  else
    all.push_back({std::move(root), "", where});
}

/// Refuses equal names of experiments, whose folders would coincide.
void label(std::vector<ExperimentSource>& all, ConfigErrors& errors) {
  std::map<std::string, Location> locations;
  for (ExperimentSource& one : all) {
    if (const ConfigNode* name = one.root.find("name")) one.label = name->scalar;
    const auto [first, is_first] = locations.emplace(one.label, one.root.where);
    if (!is_first)
      errors.push_back({one.where, "experiments " + first->second.file + " and " + one.root.where.file +
                                       " have the same name, \"" + one.label +
                                       "\"; rename one of them, or name each once"});
  }
}

}  // namespace

std::string folder_name(std::string name) {
  for (char& c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && !std::isalnum(byte) && !std::strchr("_-.=,", c)) c = '_';
  }
  if (!name.empty() && name[0] == '.') name[0] = '_';
  return name;
}

void check_settings(const ConfigNode& set, ConfigErrors& errors) {
  if (set.kind != NodeKind::map && set.kind != NodeKind::null)
    errors.push_back({set.where,
                      "\"set\" must be a map of paths of keys and values, as in \"set: {newton.step_size: "
                      "0.2}\""});
  refuse_repeated_keys(set, "set", errors);
}

std::vector<Variation> variations_of(const ConfigNode& ablation, ConfigErrors& errors) {
  std::vector<Variation> all;
  if (ablation.kind == NodeKind::null) {
    all.emplace_back().name = "base";
    all.back().where = ablation.where;
  }
  if (ablation.kind == NodeKind::list)
    for (const ConfigNode& node : ablation.items) all.push_back(named(node, errors));
  if (ablation.kind == NodeKind::map) {
    GridParameters p;
    const std::size_t before = errors.size();
    schema_of<GridParameters>("ablation").read(&p, ablation, errors);
    if (errors.size() == before && (p.grid.kind != NodeKind::map || p.grid.entries.empty()))
      errors.push_back({p.grid.where,
                        "\"grid\" must be a map of paths of keys and lists of values, as in \"grid: "
                        "{refiner: [loop, midpoint], levels: [2, 3]}\""});
    else if (errors.size() == before)
      all = product(p.grid, errors);
  }
  if (ablation.is_scalar() || (ablation.kind == NodeKind::list && all.empty()))
    errors.push_back({ablation.where,
                      "\"ablation\" must be a list of variations, as in \"ablation: [{name: coarse, set: "
                      "{methods.pcs.hessian: coarse}}]\", or a map with a \"grid\""});
  check_names(all, errors);
  return all;
}

std::vector<ExperimentSource> experiment_sources(const SweepParameters& p, const ConfigNode& source,
                                                 ConfigErrors& errors) {
  std::vector<ExperimentSource> all;
  const ConfigNode *base = source.find("base"), *several = source.find("experiments");
  if (bool(base) == bool(several)) {
    errors.push_back({several ? several->where : source.where,
                      base ? "\"base\" and \"experiments\" are both given; keep one of them"
                           : "\"base\" is required and missing, or \"experiments\" in its place"});
    return all;
  }
  if (base) {
    if (!p.base.empty())
      read_one(p.base, "base", base->where, all, errors);
    else if (base->is_scalar())
      errors.push_back({base->where, "\"base\" is empty; name an experiment"});
    return all;
  }
  if (p.experiments.empty())
    errors.push_back({several->where, "\"experiments\" is empty; name an experiment"});
  for (std::size_t k = 0; k < p.experiments.size(); ++k) {
    const Location& where = several->items[k].where;
    const auto files = files_of(fs::path(where.file).parent_path(), p.experiments[k]);
    if (files.empty())
      errors.push_back({where, "no file is called like " + p.experiments[k] + ", seen from this file"});
    for (const fs::path& file : files) read_one(file, "experiments", where, all, errors);
  }
  label(all, errors);
  return all;
}

}  // namespace drape

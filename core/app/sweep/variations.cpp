#include "core/app/sweep/variations.h"

#include <algorithm>
#include <cctype>
#include <cstring>
#include <map>

#include "core/app/files/file_name.h"
#include "core/kernel/interfaces/solver.h"

namespace drape {

namespace {

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
  std::vector<Variation> all;
  for (std::size_t index = 0; index < count; ++index) {
    Variation v;
    v.where = grid.where;
    std::size_t rest = index;
    for (std::size_t k = grid.entries.size(); k-- > 0;) {
      const auto& [path, values] = grid.entries[k];
      const std::size_t at = rest % values.items.size();
      rest /= values.items.size();
      const ConfigNode& value = values.items[at];
      v.settings.insert(v.settings.begin(), {path, value, grid.key_locations[k]});
      const std::string shown = value.kind == NodeKind::scalar
                                    ? value.scalar
                                    : std::to_string(at + 1);  // a map's index in the list
      v.name = keys[k] + "=" + shown + (v.name.empty() ? "" : "," + v.name);
    }
    all.push_back(v);
  }
  return all;
}

Variation named(const ConfigNode& node, ConfigErrors& errors) {
  VariationParameters p;
  schema_of<VariationParameters>("a variation").read(&p, node, errors);
  Variation v{p.name, "", node.where, {}, p.methods, node.where, p.expect};
  if (!has_converged(p.expect.status) && p.expect.message.empty())
    errors.push_back({node.find("expect")->where,
                      "\"expect\" of a status other than converged needs a \"message\": a part of the "
                      "expected message then"});
  if (p.levels) v.settings.push_back({"levels", *node.find("levels"), node.find("levels")->where});
  for (Setting& setting : settings_of(p.set, errors)) {
    if (p.levels && setting.path == "levels")
      errors.push_back(
          {setting.where, "\"levels\" is given twice in variation \"" + p.name + "\"; take one of them out"});
    v.settings.push_back(std::move(setting));
  }
  if (const ConfigNode* methods = node.find("methods")) v.methods_where = methods->where;
  if (const ConfigNode* name = node.find("name")) v.where = name->where;
  if (p.name.empty() && node.find("name"))
    errors.push_back({v.where, "\"name\" in a variation must not be empty"});
  return v;
}

struct GridParameters {
  ConfigNode grid;
  static void declare(Declaration<GridParameters>& d) { d.add("grid", &GridParameters::grid).required(); }
};

void check_names(std::vector<Variation>& all, ConfigErrors& errors) {
  std::map<std::string, const Variation*> folders;
  for (Variation& v : all) {
    v.folder = folder_name(v.name);
    if (const std::string fault = fault_of_file_name(v.folder); !fault.empty())
      errors.push_back({v.where, "variation \"" + v.name + "\" names a folder: it " + fault});
    const auto [other, first] = folders.emplace(v.folder, &v);
    if (first || v.name.empty()) continue;
    const std::string& name = other->second->name;
    errors.push_back({v.where, name == v.name
                                   ? "variation \"" + v.name + "\" is given twice; rename one of them"
                                   : "variations \"" + name + "\" and \"" + v.name +
                                         "\" would share the folder " + v.folder + "; rename one of them"});
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

std::vector<Setting> settings_of(const ConfigNode& set, ConfigErrors& errors) {
  std::vector<Setting> settings;
  if (set.kind == NodeKind::null) return settings;
  if (set.kind != NodeKind::map)
    errors.push_back({set.where,
                      "\"set\" must be a map of paths of keys and values, as in \"set: {newton.step_size: "
                      "0.2}\""});
  refuse_repeated_keys(set, "set", errors);
  for (std::size_t k = 0; k < set.entries.size(); ++k)
    settings.push_back({set.entries[k].first, set.entries[k].second, set.key_locations[k]});
  return settings;
}

std::vector<Variation> variations_of(const ConfigNode& ablation, ConfigErrors& errors) {
  std::vector<Variation> all;
  if (ablation.kind == NodeKind::null) all.push_back({"base", "", ablation.where, {}, {}, {}, {}});
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
  if (ablation.kind == NodeKind::scalar || (ablation.kind == NodeKind::list && all.empty()))
    errors.push_back({ablation.where,
                      "\"ablation\" must be a list of variations, as in \"ablation: [{name: coarse, set: "
                      "{methods.pcs.hessian: coarse}}]\", or a map with a \"grid\""});
  check_names(all, errors);
  return all;
}

}  // namespace drape

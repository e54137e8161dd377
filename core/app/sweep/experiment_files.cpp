#include "core/app/sweep/experiment_files.h"

#include <glob.h>

#include <cstring>
#include <map>

#include "core/app/files/yaml_file.h"

namespace drape {

namespace {

namespace fs = std::filesystem;

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
    if (p.base.empty())
      errors.push_back({base->where, "\"base\" is empty; name an experiment"});
    else
      read_one(p.base, "base", base->where, all, errors);
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

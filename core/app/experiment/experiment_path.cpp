#include "core/app/experiment/experiment_path.h"

#include <algorithm>

#include "core/app/experiment/experiment_parameters.h"
#include "core/app/files/yaml_file.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

namespace {

using NodeKind = ConfigNode::Kind;

bool is_missing(const ConfigNode* node) {
  return !node || node->kind == NodeKind::null || (node->kind == NodeKind::list && node->items.empty());
}

/// Whether the experiment's key chooses one plugin, as `refiner` and `contact` do.
bool chooses_plugin(const std::string& key) {
  const Parameter* p = parameter_named(experiment_schema(), key);
  return p && p->type.is_one(ValueKind::node) && !p->plugin_kind.empty();
}

/// The path of the first list on the way whose items the words name although it has none; "" without one.
std::string missing_list(const ConfigNode& experiment, const std::vector<std::string>& words) {
  const Schema* section = &experiment_schema();
  const ConfigNode* node = &experiment;
  std::string path;
  for (std::size_t k = 0; k + 1 < words.size(); ++k) {
    const Parameter* p = parameter_named(*section, words[k]);
    if (!p) return "";
    path += (path.empty() ? "" : ".") + words[k];
    if (node) node = node->find(words[k]);
    if (p->type.is_list() && !p->type.of_scalars()) {
      if (is_missing(node)) return path;
      const auto index = node->index_of(words[++k]);
      if (!index) return "";
      node = &node->items[*index];
    }
    if (!p->section) return "";
    section = p->section.get();
  }
  return "";
}

/// Adds the words that lead to a plugin's named constant, if the last of the words names one.
void lead_to_constant(const ConfigNode& experiment, std::vector<std::string>& words) {
  const ConfigNode* node = &experiment;
  for (std::size_t k = 0; k < words.size(); ++k) {
    const ConfigNode *next = node->child(words[k]), *constants = node->find(constants_key);
    if (!next && constants && constants->find(words[k])) {
      words.insert(words.begin() + static_cast<std::ptrdiff_t>(k), constants_key);
      next = constants;
    }
    if (!next) return;
    const bool is_last = next == constants && k + 2 == words.size();
    const ConfigNode* number = is_last ? next->find(words[k + 1]) : nullptr;
    if (number && number->kind == NodeKind::map) words.emplace_back("value");
    node = next;
  }
}

}  // namespace

std::vector<std::string> words_of_path(const ConfigNode& experiment, const std::string& path) {
  std::vector<std::string> words = split(path, '.');
  lead_to_constant(experiment, words);
  if (words.size() < 3 || words[1].empty() || !chooses_plugin(words[0])) return words;
  const ConfigNode* plugin = experiment.find(words[0]);
  if (plugin && plugin->plugin_name() == words[1]) words.erase(words.begin() + 1);
  return words;
}

const ConfigNode* value_at(const ConfigNode& experiment, const std::string& path) {
  const ConfigNode* node = &experiment;
  for (const std::string& word : words_of_path(experiment, path))
    if (node) node = node->child(word);
  return node;
}

std::string unit_of(const std::string& path) {
  std::vector<std::string> words = split(path, '.');
  if (words.size() > 3 && words[0] == "methods" && words[2] == "newton")
    words.erase(words.begin(), words.begin() + 2);
  const Schema* section = &experiment_schema();
  for (std::size_t k = 0; section && k < words.size(); ++k) {
    const Parameter* p = parameter_named(*section, words[k]);
    if (!p) return "";
    if (k + 1 == words.size()) return p->unit == "1" ? "" : p->unit;
    if (p->type.is_list() && !p->type.of_scalars()) ++k;  // an item's index or name
    section = p->section.get();
  }
  return "";
}

bool set_parameter(ConfigNode& experiment, const std::string& path, ConfigNode value, const Location& where,
                   ConfigErrors& errors) {
  const std::string key = path.substr(0, path.find('.'));
  const bool within = key != path;
  if (within && key == "refiner" && is_missing(experiment.find(key))) {
    ConfigNode refiner = ConfigNode::of(default_refiner);
    refiner.where = where;
    set_path(experiment, key, std::move(refiner), where, errors);
  } else if (within && chooses_plugin(key) && is_missing(experiment.find(key))) {
    errors.push_back({where, "the experiment has no \"" + key + "\"; name its plugin first"});
    return false;
  }
  const std::vector<std::string> words = words_of_path(experiment, path);
  if (const std::string list = missing_list(experiment, words); !list.empty()) {
    errors.push_back({where, "the experiment has no \"" + list + "\"; write that list first"});
    return false;
  }
  return set_path(experiment, joined(words, ".", "."), std::move(value), where, errors);
}

bool set_parameter(ConfigNode& experiment, const std::string& path, const std::string& value,
                   const std::string& option, ConfigErrors& errors) {
  const std::optional<ConfigNode> parsed = value_of_option(value, option, errors);
  return parsed && set_parameter(experiment, path, *parsed, Location{option, 0, 0}, errors);
}

void refuse_scheduled(const ConfigNode& experiment, const std::string& path, const std::string& option,
                      ConfigErrors& errors) {
  const ConfigNode* schedule = experiment.find("schedule");
  const ConfigNode *keys = schedule ? schedule->find("keys") : nullptr, *set = value_at(experiment, path);
  for (std::size_t k = 0; set && keys && k < keys->items.size(); ++k) {
    const ConfigNode* own = keys->items[k].find("parameter");
    const ConfigNode* scheduled = own ? value_at(experiment, own->scalar) : nullptr;
    // By their places: an item of a list has an index and a name, and a number may be one of a list's.
    if (scheduled &&
        (scheduled == set ||
         std::ranges::any_of(scheduled->items, [&](const ConfigNode& item) { return &item == set; }) ||
         std::ranges::any_of(scheduled->entries, [&](const auto& entry) {
           return &entry.second == set;  // of a list that is not written
         })))
      errors.push_back({{option, 0, 0},
                        "has no effect, since a schedule sets it; set the schedule's values, as in --set "
                        "schedule.keys." +
                            std::to_string(k) + ".values=…"});
  }
}

}  // namespace drape

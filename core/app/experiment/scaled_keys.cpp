#include "core/app/experiment/scaled_keys.h"

#include <algorithm>
#include <cmath>

#include "core/app/experiment/experiment_path.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {
namespace {

using NodeKind = ConfigNode::Kind;

std::optional<double> number_of(const ConfigNode* node) {
  const bool is_scalar = node && node->kind == NodeKind::scalar && !node->quoted;
  const std::optional<double> number = is_scalar ? parse_number(node->scalar) : std::nullopt;
  return number && std::isfinite(*number) ? number : std::nullopt;
}

/// Appends the paths of all numbers in a node.
void list_numbers(const ConfigNode& node, const std::string& path, std::vector<std::string>& paths) {
  if (number_of(&node)) paths.push_back(path);
  const std::string before = path.empty() ? "" : path + ".";
  for (const auto& [key, value] : node.entries) list_numbers(value, before + key, paths);
  for (std::size_t k = 0; k < node.items.size(); ++k)
    list_numbers(node.items[k], before + std::to_string(k), paths);
}

/// The numbers of a group: of a section's path with a part of a key's name.
std::vector<ScaledKey> group(const ConfigNode& resolved, const std::string& path) {
  static const ConfigNode plain = [] {
    const ExperimentParameters parameters;
    return experiment_schema().write(&parameters);
  }();
  std::vector<ScaledKey> changed, defaults;
  const std::size_t dot = path.rfind('.');
  const ConfigNode* section = dot == std::string::npos ? nullptr : value_at(resolved, path.substr(0, dot));
  if (!section) return {};
  for (const auto& [key, node] : section->entries) {
    const std::optional<double> value = number_of(&node);
    if (!value || *value == 0 || key.find(path.substr(dot + 1)) == std::string::npos) continue;
    const std::string own = path.substr(0, dot + 1) + key;
    const bool is_default = number_of(value_at(plain, own)) == value;
    (is_default ? defaults : changed).push_back({own, *value});
  }
  return changed.empty() ? defaults : changed;
}

std::string fault(const ConfigNode& resolved, const std::string& path) {
  const std::string name = "\"" + excerpt(path) + "\"";
  if (const ConfigNode* node = value_at(resolved, path)) {
    if (node->kind == NodeKind::null)
      return name + " is not set, so there is nothing to scale; give it a value with --set";
    return name + " is " +
           (number_of(node) ? "0, which no factor changes" : node->shown() + ", not a number");
  }
  std::vector<std::string> all;
  list_numbers(resolved, "", all);
  const std::string near = nearest_word(path, all);
  return "the experiment has no number " + name +
         (near.empty() ? "; `drape describe experiment` lists its keys" : "; did you mean \"" + near + "\"?");
}

}  // namespace

std::vector<ScaledKey> scaled_keys(const Experiment& experiment, const std::vector<std::string>& paths,
                                   const std::string& option, ConfigErrors& errors) {
  std::vector<ScaledKey> keys;
  for (const std::string& path : paths) {
    const ConfigNode* node = value_at(experiment.resolved, path);
    const double value = number_of(node).value_or(0);
    std::vector<ScaledKey> named{{path, value}};
    if (!node) named = group(experiment.resolved, path);
    if (named.empty() || (node && value == 0))
      errors.push_back({{option, 0, 0}, fault(experiment.resolved, path)});
    for (const ScaledKey& key : named)
      if (std::none_of(keys.begin(), keys.end(), [&](const ScaledKey& own) { return own.path == key.path; }))
        keys.push_back(key);
  }
  return keys;
}

}  // namespace drape

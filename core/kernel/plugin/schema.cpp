#include <filesystem>
#include <map>
#include <set>

#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {
namespace {

using NodeKind = ConfigNode::Kind;

/// A path, or each of a list, as an absolute one that is marked as such. Links are followed: ".." after one
/// leads up from the folder that it names.
ConfigNode absolute_path(ConfigNode path) {
  for (ConfigNode& item : path.items) item = absolute_path(item);
  path.names_file = !path.scalar.empty();
  if (!path.names_file) return path;
  const std::filesystem::path whole = std::filesystem::absolute(path.scalar);
  std::error_code unknown;  // as where a folder may not be searched
  const std::filesystem::path followed = std::filesystem::weakly_canonical(whole, unknown);
  path.scalar = (unknown ? whole.lexically_normal() : followed).string();
  return path;
}

constexpr std::size_t most_hints = 100;  // no more errors are listed

/// "did you mean …?" or the known keys, for an unknown one of this map. --set names constants as if they were
/// keys.
std::string hint_for(const std::string& key, const Schema& schema, const ConfigNode& map) {
  std::vector<std::string> known, constants;
  for (const Parameter& p : schema.parameters) {
    if (!p.from_experiment) known.push_back(p.name);
    if (const ConfigNode* written = p.type.is_map() ? map.find(p.name) : nullptr)
      for (const auto& [name, value] : written->entries) constants.push_back(name);
  }
  return did_you_mean(
      key, known,
      did_you_mean(key, constants, known.empty() ? "it takes no keys" : "known keys are " + joined(known)));
}

}  // namespace

void Schema::read(void* object, const ConfigNode& map, ConfigErrors& errors) const {
  const std::string in = name.empty() ? "" : " in " + name;
  if (map.kind != NodeKind::map && map.kind != NodeKind::null) {
    const std::string label = name.empty() ? "this" : "\"" + name + "\"";
    errors.push_back({map.where, label + " must be a map of keys and values, not " + map.shown()});
    return;
  }
  std::map<std::string, size_t> first_of;
  std::set<std::string> invalid;
  for (size_t i = 0; i < map.entries.size(); ++i) {
    const auto& [key, node] = map.entries[i];
    const size_t first = first_of.emplace(key, i).first->second;
    const Parameter* known = parameter_named(*this, key);
    if (first != i) {
      errors.push_back({map.key_locations[i], "repeated key \"" + excerpt(key) + "\"" + in +
                                                  "; it is first set at " + map.key_locations[first].text()});
    } else if (!known) {
      const std::string hint = errors.size() < most_hints ? "; " + hint_for(key, *this, map) : "";
      errors.push_back({map.key_locations[i], "unknown key \"" + excerpt(key) + "\"" + in + hint});
    } else {
      const size_t before = errors.size();
      read_parameter(*known, object, node, errors);
      if (errors.size() > before) invalid.insert(key);
    }
  }
  for (const Parameter& p : parameters)
    if (p.required && !map.find(p.name))
      errors.push_back({map.where, "\"" + p.name + "\"" + in + " is required and missing"});
  for (const Parameter& p : parameters) {
    // What an invalid selector would have selected is not known.
    const bool selected = !p.selector.empty() && !invalid.contains(p.selector);
    const ConfigNode* written = selected ? map.find(p.name) : nullptr;
    if (const std::string fault = written ? unread_fault(p, object) : ""; !fault.empty())
      errors.push_back({written->where, fault});
  }
}

std::string Schema::unread_fault(const Parameter& p, const void* object) const {
  const Parameter* selector = parameter_named(*this, p.selector);
  if (!selector) return "";
  const ConfigNode chosen = selector->write(object);
  const bool given = chosen.is_scalar() ? !chosen.scalar.empty() : chosen.kind != NodeKind::null;
  const auto& reads = p.selector_values;
  if ((reads.empty() ? given : is_one_of(chosen.scalar, reads)) ||
      p.write(object).one_line() == p.write(fresh().get()).one_line())
    return "";
  std::string needed = reads.empty() ? p.selector : "";
  for (const std::string& value : reads) needed += (needed.empty() ? "" : " or ") + p.selector + ": " + value;
  return "\"" + p.name + "\"" + (name.empty() ? "" : " in " + name) + " needs \"" + needed + "\"; here \"" +
         p.selector + "\" is " + (given ? chosen.scalar : "not given");
}

const Parameter* parameter_named(const Schema& schema, const std::string& name) {
  for (const Parameter& p : schema.parameters)
    if (p.name == name) return &p;
  return nullptr;
}

ConfigNode Schema::write(const void* object) const {
  ConfigNode map(NodeKind::map);
  for (const Parameter& p : parameters)
    map.add(p.name, p.path ? absolute_path(p.write(object)) : p.write(object));
  return map;
}

}  // namespace drape

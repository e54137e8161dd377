#include "core/kernel/plugin/registry.h"

#include <algorithm>
#include <stdexcept>

#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/plugin/config_node.h"
#include "core/kernel/plugin/make.h"
#include "core/kernel/plugin/refused_parameters.h"

namespace drape {

Schema section_schema(const RegistryEntry& entry) {
  Schema schema = entry.schema;
  Parameter type;
  type.name = "type";
  type.type = {ValueKind::text};
  type.description = "which " + entry.kind;
  type.required = true;
  type.choices = {entry.name};
  type.read = [](void*, const ConfigNode&, ConfigErrors&) {};
  type.write = [name = entry.name](const void*) { return ConfigNode::of(name); };
  schema.parameters.insert(schema.parameters.begin(), type);
  return schema;
}

namespace {

bool is_name(const std::string& name) {
  constexpr const char* letters = "abcdefghijklmnopqrstuvwxyz0123456789_";
  return !name.empty() && name[0] >= 'a' && name[0] <= 'z' &&
         name.find_first_not_of(letters) == std::string::npos;
}

/// The fault of a declaration with which a saved config could not be read again; empty if there is none.
std::string fault_of(const Schema& schema) {
  const std::shared_ptr<void> defaults = schema.fresh(), read = schema.fresh();
  for (const Parameter& p : schema.parameters) {
    if (!is_name(p.name) || p.name == "type")
      return "parameter \"" + p.name +
             "\" needs another name: lower case, digits and underscores, and not type";
    if (p.required) continue;
    ConfigErrors errors;
    read_parameter(p, read.get(), p.write(defaults.get()), errors);
    if (!errors.empty())
      return "the default of parameter \"" + p.name + "\" is refused: " + errors[0].message;
  }
  return "";
}

/// Where a path leads from a node, at a byte of its text; or the last node on the way that is written.
Location location_of(const ConfigNode& written, const std::string& path,
                     const std::optional<std::size_t>& at) {
  const ConfigNode* node = &written;
  for (const std::string& word : split(path, '.')) {
    const ConfigNode* next = node->child(word);
    if (!next) break;
    node = next;
  }
  if (node->where.text().empty()) return written.where;
  return at ? location_in_text(*node, *at) : node->where;
}

/// The registered entry that a node names. Null, with an error appended, if there is none.
const RegistryEntry* find_plugin(const Registry& registry, const std::string& kind, const ConfigNode& node,
                                 ConfigErrors& errors) {
  const ConfigNode* type = node.kind == ConfigNode::Kind::map ? node.find("type") : &node;
  if (!type || !type->is_scalar()) {
    errors.push_back({type ? type->where : node.where, "expected the name of a plugin of kind " + kind +
                                                           ", or a map with its name as \"type\""});
    return nullptr;
  }
  if (const RegistryEntry* entry = registry.find(kind, type->scalar)) return entry;
  std::vector<std::string> names;
  for (const RegistryEntry* entry : registry.of_kind(kind)) names.push_back(entry->name);
  const std::string hint = did_you_mean(type->scalar, names, "");
  errors.push_back(
      {type->where, "unknown " + kind + " \"" + excerpt(type->scalar) + "\"; " +
                        (hint.empty() ? "" : hint + " ") +
                        (names.empty() ? "no plugin of that kind is loaded" : "known: " + joined(names)) +
                        "; a plugin of your own is given by --plugin or found by DRAPE_PLUGIN_PATH; one "
                        "registered in Python is known to that program alone"});
  return nullptr;
}

}  // namespace

const RegistryEntry* Registry::find(const std::string& kind, const std::string& name) const {
  for (const auto& entry : entries_)
    if (entry->kind == kind && entry->name == name) return entry.get();
  return nullptr;
}

const std::vector<std::string>& plugin_kinds() {
  static const std::vector<std::string> kinds = {"energy", "refiner", "contact", "solver", "metric"};
  return kinds;
}

std::vector<const RegistryEntry*> Registry::of_kind(const std::string& kind) const {
  std::vector<const RegistryEntry*> found;
  for (const auto& entry : entries_)
    if (entry->kind == kind) found.push_back(entry.get());
  std::sort(found.begin(), found.end(), [](auto* a, auto* b) { return a->name < b->name; });
  return found;
}

void Registry::add_entry(std::unique_ptr<RegistryEntry> entry) {
  if (entry->name.empty())
    throw std::runtime_error(entry->library + ": registers a " + entry->kind +
                             " without a name; give it one");
  if (!is_name(entry->name))
    throw std::runtime_error(entry->library + ": the name of " + entry->kind + " \"" + entry->name +
                             "\" must be lower case, digits and underscores");
  if (const std::string fault = fault_of(entry->schema); !fault.empty())
    throw std::runtime_error(entry->library + ": " + entry->kind + " " + entry->name + ": " + fault);
  if (const RegistryEntry* other = find(entry->kind, entry->name))
    throw std::runtime_error(entry->kind + " \"" + entry->name + "\" of " + entry->library +
                             " is already registered by " + other->library +
                             "; rename it or take one of them out of the search path");
  entries_.push_back(std::move(entry));
}

std::unique_ptr<RegistryEntry> Registry::remove(const std::string& kind, const std::string& name) {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const auto& entry) {
    return entry->kind == kind && entry->name == name;
  });
  if (found == entries_.end()) return nullptr;
  std::unique_ptr<RegistryEntry> entry = std::move(*found);
  entries_.erase(found);
  return entry;
}

std::shared_ptr<void> make_plugin(const Registry& registry, const std::string& kind, const ConfigNode& node,
                                  ConfigErrors& errors, ConfigNode* resolved, const void* before) {
  const RegistryEntry* entry = find_plugin(registry, kind, node, errors);
  if (!entry) return nullptr;
  const Schema schema = section_schema(*entry);
  const std::shared_ptr<void> values = entry->schema.fresh();
  const size_t faults = errors.size();
  if (node.is_scalar())
    schema.read(values.get(), node.as_map("type"), errors);
  else
    schema.read(values.get(), node, errors);  // uncopied: it may have thousands of obstacles
  if (resolved) *resolved = schema.write(values.get());
  if (errors.size() > faults) return nullptr;
  try {
    return entry->make(values.get(), before);
  } catch (const RefusedParameters& refused) {
    for (const ParameterFault& fault : refused.faults)
      errors.push_back(
          {location_of(node, fault.path, fault.at), entry->name + ": " + fault.message, fault.shown});
  } catch (...) {
    errors.push_back({node.where, entry->name + ": " + message_in_flight()});
  }
  return nullptr;
}

}  // namespace drape

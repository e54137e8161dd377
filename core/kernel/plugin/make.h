#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/kernel/plugin/config_node.h"

namespace drape {

class Registry;
struct RegistryEntry;

/// A plugin's parameters, before the object is made from them.
struct PluginParameters {
  const RegistryEntry* entry = nullptr;  ///< that the node names, by itself or as `type`; null without one
  std::shared_ptr<void> values;          ///< the entry's parameter struct; null if the node is not valid
};

/// Reads them; `resolved` receives the node with every parameter.
PluginParameters read_plugin_parameters(const Registry& registry, const std::string& kind,
                                        const ConfigNode& node, ConfigErrors& errors,
                                        ConfigNode* resolved = nullptr);

/// The location of a plugin's refused parameter: its path in the plugin's section, and its place in a text.
using LocateFault = std::function<Location(const std::string& path, const std::optional<std::size_t>& at)>;
/// The location in a node that is written; its own, if the path leads to nothing that is written.
LocateFault locate_in(const ConfigNode& written);

/// The object with these parameters, a pointer to the kind's interface, which may share with `before` what
/// does not differ (RegistryEntry::make). Null, with every error appended, if the plugin refuses them.
std::shared_ptr<void> make_plugin(const PluginParameters& parameters, const LocateFault& locate,
                                  ConfigErrors& errors, const void* before = nullptr);

/// The plugin object of a node, `loop` or `{type: loop, corner_angle: 30}`; null, with every error appended,
/// if the node is not valid. `resolved` receives the node with every parameter. The object may share with
/// `before`, an object of the same plugin, what does not differ.
template <class Interface>
std::shared_ptr<Interface> make_from(const Registry& registry, const ConfigNode& node, ConfigErrors& errors,
                                     ConfigNode* resolved = nullptr, const Interface* before = nullptr) {
  const PluginParameters parameters =
      read_plugin_parameters(registry, Interface::kind, node, errors, resolved);
  return std::static_pointer_cast<Interface>(make_plugin(parameters, locate_in(node), errors, before));
}

}  // namespace drape

#pragma once

#include "core/kernel/plugin/registry.h"

namespace drape {

/// The registered entry that a node names: the node is a name, or a map with the name as `type`. Null, with
/// an error appended, if there is none.
const RegistryEntry* find_plugin(const Registry& registry, const std::string& kind, const ConfigNode& node,
                                 ConfigErrors& errors);

/// As `make_from` for a kind given by name; the pointer is to the kind's interface.
std::shared_ptr<void> make_plugin(const Registry& registry, const std::string& kind, const ConfigNode& node,
                                  ConfigErrors& errors, ConfigNode* resolved = nullptr);

/// The plugin object of a node, `loop` or `{type: loop, corner_angle: 30}`; null, with every error appended,
/// if the node is not valid. `resolved` receives the node with every parameter.
template <class Interface>
std::shared_ptr<Interface> make_from(const Registry& registry, const ConfigNode& node, ConfigErrors& errors,
                                     ConfigNode* resolved = nullptr) {
  return std::static_pointer_cast<Interface>(
      make_plugin(registry, Kind<Interface>::name, node, errors, resolved));
}

}  // namespace drape

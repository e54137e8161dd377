#pragma once

#include <memory>
#include <string>

#include "core/kernel/plugin/config_node.h"

namespace drape {

class Registry;

/// make_from, of a kind's interface.
std::shared_ptr<void> make_plugin(const Registry& registry, const std::string& kind, const ConfigNode& node,
                                  ConfigErrors& errors, ConfigNode* resolved, const void* before);

/// The plugin object of a node, `loop` or `{type: loop, corner_angle: 30}`; null, with every error appended,
/// if the node is not valid. `resolved` receives the node with every parameter. The object may share with
/// `before`, an object of the same plugin, what does not differ.
template <class Interface>
std::shared_ptr<Interface> make_from(const Registry& registry, const ConfigNode& node, ConfigErrors& errors,
                                     ConfigNode* resolved = nullptr, const Interface* before = nullptr) {
  return std::static_pointer_cast<Interface>(
      make_plugin(registry, Interface::kind, node, errors, resolved, before));
}

}  // namespace drape

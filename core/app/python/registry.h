#pragma once

#include <memory>

#include "core/kernel/plugin/registry.h"

namespace drape::python {

/// The process's plugins, loaded at the first call, and the prototypes that Python has registered. Call with
/// the GIL held. Throws std::runtime_error for a library that cannot be loaded.
const Registry& registry();

/// Registers an entry; it takes the place of a prototype of the same kind and name. Throws std::runtime_error
/// if a plugin's library has the name.
void register_prototype(std::unique_ptr<RegistryEntry> entry);

/// The library of prototypes, in messages.
inline constexpr const char* prototype_library = "Python";

}  // namespace drape::python

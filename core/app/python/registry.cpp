#include "core/app/python/registry.h"

#include <vector>

#include "core/kernel/plugin/loader.h"

namespace drape::python {

namespace {

/// Never destroyed: experiments and plugins' objects may outlive the interpreter's last call.
Registry& mutable_registry() {
  static Registry* const all = [] {
    auto loaded = std::make_unique<Registry>();
    load_plugins(*loaded, plugin_directories());
    return loaded.release();
  }();
  return *all;
}

}  // namespace

const Registry& registry() { return mutable_registry(); }

void register_prototype(std::unique_ptr<RegistryEntry> entry) {
  // Experiments that were made of an earlier prototype refer to its entry.
  static auto* const replaced = new std::vector<std::unique_ptr<RegistryEntry>>;
  Registry& all = mutable_registry();
  const RegistryEntry* before = all.find(entry->kind, entry->name);
  if (before && before->library == prototype_library)
    replaced->push_back(all.remove(entry->kind, entry->name));
  all.add_entry(std::move(entry));
}

}  // namespace drape::python

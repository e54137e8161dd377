#pragma once

#include <functional>
#include <memory>
#include <string>
#include <typeinfo>
#include <vector>

#include "core/kernel/plugin/parameters.h"

namespace drape {

/// "energy", "refiner", "contact", "solver", "metric": one for each interface in core/kernel/interfaces.
const std::vector<std::string>& plugin_kinds();

/// One plugin that experiments choose by name.
struct RegistryEntry {
  std::string kind;     ///< one of plugin_kinds
  std::string name;     ///< as written in YAML, snake_case
  std::string summary;  ///< one sentence
  std::string library;  ///< path of its shared library
  std::string details;  ///< lines that `drape describe` prints below the parameters; may be empty
  Schema schema;        ///< its parameters
  /// Makes the object from a struct of the schema. `before`, null or an object of this entry with other
  /// parameters, may share with it what does not differ. Both objects' pointers are to the interface.
  std::function<std::shared_ptr<void>(const void* parameters, const void* before)> make;
};

/// The schema of a plugin's section in a config: the key `type`, then its parameters.
Schema section_schema(const RegistryEntry& entry);

/// All plugins. The loader fills it, the experiment reads it.
class Registry {
 public:
  /// Registers `Implementation` under a name. Its parameters are members of its own that its static function
  /// `declare` declares; or those of a struct `Implementation::Parameters`, which its constructor takes; or
  /// none. In the second case one that is costly to make can have another constructor, from the parameters
  /// and a `const Implementation&`: when a schedule changes its parameters, that one is given the object
  /// before, to share what stays the same. A static function `details()`, if there is one, gives the entry's
  /// details. Interface is one of the five of core/kernel/interfaces. Throws std::runtime_error on a repeated
  /// name, with the paths of both libraries.
  template <class Interface, class Implementation>
  void add(const std::string& name, const std::string& summary);

  /// Registers an entry that was made without a class of its own, as a prototype in Python. Throws as above.
  void add_entry(std::unique_ptr<RegistryEntry> entry);
  /// Takes an entry out, so that its name is free again; null if there is none. Experiments refer to their
  /// entries: the caller keeps the entry as long as they live.
  std::unique_ptr<RegistryEntry> remove(const std::string& kind, const std::string& name);

  const RegistryEntry* find(const std::string& kind, const std::string& name) const;
  std::vector<const RegistryEntry*> of_kind(const std::string& kind) const;
  const std::vector<std::unique_ptr<RegistryEntry>>& entries() const { return entries_; }

  /// The library that is being loaded; set by the loader.
  std::string current_library;

 private:
  std::vector<std::unique_ptr<RegistryEntry>> entries_;
};

}  // namespace drape

#include "core/kernel/plugin/registry_impl.h"

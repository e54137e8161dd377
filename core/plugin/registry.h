#pragma once

#include <functional>
#include <memory>
#include <string>
#include <typeinfo>
#include <vector>

#include "core/plugin/parameters.h"

namespace drape {

/// One thing that experiments choose by name.
struct RegistryEntry {
  std::string kind;     ///< "energy", "refiner", "contact", "solver", "metric"
  std::string name;     ///< as written in YAML, snake_case
  std::string summary;  ///< one sentence
  std::string library;  ///< path of the shared library it came from
  Schema schema;        ///< its parameters
  /// A parameter struct with its defaults, to be read into by `schema`.
  std::function<std::shared_ptr<void>()> make_parameters;
  /// The object made from such a struct, as a pointer to the kind's interface.
  std::function<std::shared_ptr<void>(const void* parameters)> make;
};

/// The schema of such a thing as a config writes it: the key `type` with its name, then its parameters.
Schema section_schema(const RegistryEntry& entry);

/// Everything that can be chosen by name. Filled by the loader, read by the experiment.
class Registry {
 public:
  /// Registers `Implementation` (constructible from `const Implementation::Parameters&`) under a name.
  /// Interface is one of the five of core/model. Throws std::runtime_error on a repeated name, with
  /// the paths of both libraries.
  template <class Interface, class Implementation>
  void add(const std::string& name, const std::string& summary);

  const RegistryEntry* find(const std::string& kind, const std::string& name) const;
  std::vector<const RegistryEntry*> of_kind(const std::string& kind) const;
  const std::vector<std::unique_ptr<RegistryEntry>>& entries() const { return entries_; }

  /// The library whose entries are being added; set by the loader.
  std::string current_library;

 private:
  void add_entry(std::unique_ptr<RegistryEntry> entry);
  std::vector<std::unique_ptr<RegistryEntry>> entries_;
};

}  // namespace drape

#include "core/plugin/registry_impl.h"

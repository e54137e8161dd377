#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/kernel/plugin/parameters.h"

namespace drape {

/// The parameter of this name; null without one.
const Parameter* parameter_named(const Schema& schema, const std::string& name);

/// One declared parameter of a struct, resolved once by its path and then written often. Refers to the
/// schema.
class ParameterPath {
 public:
  /// Follows the words of a path, such as "obstacles", "plate", "translate", "2", in a struct with this
  /// schema. An item of a list is named by its index from 0, or a section's by its type or name; a named
  /// number by its name, with or without "value" behind it. Empty without such a parameter.
  static std::optional<ParameterPath> find(const Schema& schema, void* object,
                                           const std::vector<std::string>& words);

  /// Writes the parameter of a struct whose lists are as long as in find's. Appends an error if the value is
  /// not valid.
  void set(void* object, const ConfigNode& value, ConfigErrors& errors) const;

 private:
  struct Section {
    const Parameter* parameter;
    std::size_t item;  // of a list of sections
  };
  std::vector<Section> sections_;  // from the outside in
  const Parameter* parameter_ = nullptr;
  std::optional<std::size_t> item_;  // of the parameter, if only one number of its list or map is meant
};

}  // namespace drape

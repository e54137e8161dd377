#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/kernel/plugin/config_node.h"

namespace drape {

struct Parameter;
class Schema;

/// A declared number of a struct, or a list of them: found once by its path, then written often, as numbers.
/// Not an integer, which would jump. Refers to the schema.
class DeclaredNumbers {
 public:
  /// Follows the words of a path, such as "obstacles", "plate", "translate", "2", in a struct with this
  /// schema. An item of a list is named by its index from 0, or a section's by its type or name; a named
  /// number by its name, with or without "value" behind it. Empty without such a parameter with numbers.
  static std::optional<DeclaredNumbers> find(const Schema& schema, void* object,
                                             const std::vector<std::string>& words);

  std::size_t count() const { return count_; }
  /// Number k in a struct whose lists are as long as in find's.
  double* at(void* object, std::size_t k) const;
  /// Writes `count` values; none if the parameter refuses any: appends an error without a location for each.
  void set(void* object, const double* values, ConfigErrors& errors) const;

 private:
  struct Section {
    const Parameter* parameter;
    std::size_t item;  // of a list of sections
  };
  void* owner(void* object) const;

  std::vector<Section> sections_;  // from the outside in
  const Schema* schema_ = nullptr;
  const Parameter* parameter_ = nullptr;
  std::size_t first_ = 0, count_ = 1;  // of the parameter's numbers
  std::vector<std::string> labels_;    // of each, for messages
};

}  // namespace drape

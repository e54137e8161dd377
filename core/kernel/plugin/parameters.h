#pragma once

#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/kernel/plugin/config_node.h"
#include "core/kernel/plugin/declaration.h"

namespace drape {

/// Kinds of values. A section is a map of parameters; a node is read later, as a plugin's.
enum class ValueKind { number, integer, boolean, text, section, node };

/// The type of a parameter: one value of a kind, a list of them, or a map from names to them.
struct ParameterType {
  enum class Shape { one, list, map };

  ValueKind kind = ValueKind::text;
  Shape shape = Shape::one;
  int size = 0;           ///< of a list: its number of items, 0 for any
  bool nullable = false;  ///< null is allowed and means "none"

  bool is_one(ValueKind wanted) const { return shape == Shape::one && kind == wanted; }
  bool is_list() const { return shape == Shape::list; }
  bool is_map() const { return shape == Shape::map; }
  /// Whether the value, or each item, is a scalar.
  bool of_scalars() const { return kind != ValueKind::section && kind != ValueKind::node; }
  ParameterType item() const { return {kind}; }
  std::string text() const;  ///< as in help and messages: "number", "list of numbers", "map of numbers"
};

/// One parameter, declared once. Parsing, validation, `drape describe`, the reference page, the JSON schema
/// and the saved config derive from it. Its default is the member's value in a default-constructed struct.
struct Parameter {
  std::string name;
  ParameterType type;
  std::string description;  ///< one phrase: what it sets
  std::string unit;         ///< SI; empty or "1" if dimensionless
  std::string source;       ///< paper and equation, or a page; empty if the parameter is this project's
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool open_minimum = false;  ///< the minimum itself is excluded
  bool open_maximum = false;
  bool required = false;
  std::vector<std::string> choices;  ///< text: the allowed words, empty for any
  std::string plugin_kind;           ///< nodes: the kind of plugin they choose, empty for none
  std::string shorthand_key;         ///< a section: a bare word is read as the value of this key
  bool path = false;                 ///< text: a file, relative to the config's folder
  bool from_experiment = false;      ///< a contact model's: its value stands at the top of the experiment
  bool identifies_item = false;      ///< an obstacle's: only the obstacles of this contact model have the key
  std::string selector;  ///< the choice beside it that decides whether it is read; empty: it always is
  std::vector<std::string> selector_values;  ///< … the values of that choice with which it is

  // Type-erased access to the member of a struct; `read` receives only validated nodes.
  std::function<void(void* object, const ConfigNode&, ConfigErrors&)> read;
  std::function<ConfigNode(const void* object)> write;
  std::shared_ptr<const class Schema> section;  ///< of a section, or of the items of a list of sections
};

/// Reads a value of one parameter into the struct `object`. Appends an error if the value is not valid.
void read_parameter(const Parameter& parameter, void* object, const ConfigNode& value, ConfigErrors& errors);

/// The parameters of one struct.
class Schema {
 public:
  std::string name;  ///< for messages ("in newton"); may be empty
  std::vector<Parameter> parameters;
  std::function<std::shared_ptr<void>()> fresh;  ///< a default-constructed struct

  /// Reads a map into `object` (a struct with this schema). Appends an error for every unknown key (with the
  /// nearest known one), wrong type, value out of range, missing required and repeated key.
  void read(void* object, const ConfigNode& map, ConfigErrors& errors) const;
  /// The object as a map with every parameter.
  ConfigNode write(const void* object) const;

 private:
  /// Why the choice beside it makes a parameter of the object meaningless (ParameterHandle::only_with), such
  /// as a mesh file for a square; "" if it does not, or the parameter has its default.
  std::string unread_fault(const Parameter& parameter, const void* object) const;
};

/// The parameter of this name; null without one.
const Parameter* parameter_named(const Schema& schema, const std::string& name);

/// Sets properties of the parameter that was just added; calls can be chained.
class ParameterHandle {
 public:
  explicit ParameterHandle(Parameter& parameter) : p_(parameter) {}
  ParameterHandle& description(std::string text) { return set(&Parameter::description, std::move(text)); }
  ParameterHandle& unit(std::string text) { return set(&Parameter::unit, std::move(text)); }
  ParameterHandle& source(std::string text) { return set(&Parameter::source, std::move(text)); }
  ParameterHandle& at_least(double v) { return set(&Parameter::minimum, v); }
  ParameterHandle& at_most(double v) { return set(&Parameter::maximum, v); }
  ParameterHandle& between(double least, double most) { return at_least(least).at_most(most); }
  ParameterHandle& above(double v) { return at_least(v).set(&Parameter::open_minimum, true); }
  ParameterHandle& below(double v) { return at_most(v).set(&Parameter::open_maximum, true); }
  ParameterHandle& size(int n) {
    p_.type.size = n;
    return *this;
  }
  ParameterHandle& required() { return set(&Parameter::required, true); }
  ParameterHandle& choices(std::vector<std::string> words) {
    return set(&Parameter::choices, std::move(words));
  }
  ParameterHandle& plugin(std::string kind) { return set(&Parameter::plugin_kind, std::move(kind)); }
  ParameterHandle& shorthand(std::string key) { return set(&Parameter::shorthand_key, std::move(key)); }
  ParameterHandle& path() { return set(&Parameter::path, true); }
  /// A contact model's parameter that is written at the top of the experiment, once for all models.
  ParameterHandle& from_experiment() { return set(&Parameter::from_experiment, true); }
  /// It is read only where the choice `key` beside it has one of these values or, without any, is given.
  /// Written elsewhere, it is refused unless it is the default, which a saved config has.
  ParameterHandle& only_with(std::string key, std::vector<std::string> values = {}) {
    return set(&Parameter::selector, std::move(key)).set(&Parameter::selector_values, std::move(values));
  }
  /// A key that tells an obstacle of this contact model from those of others.
  ParameterHandle& identifies_item() { return set(&Parameter::identifies_item, true); }

 private:
  template <class Value>
  ParameterHandle& set(Value Parameter::*member, Value value) {
    p_.*member = std::move(value);
    return *this;
  }

  Parameter& p_;
};

/// The schema that `Struct::declare` declares.
template <class Struct>
Schema schema_of(const std::string& name = "");

}  // namespace drape

#include "core/kernel/plugin/parameters_impl.h"

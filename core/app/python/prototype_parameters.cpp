#include "core/app/python/prototype_parameters.h"

#include <cmath>
#include <variant>

#include "core/app/python/config_value.h"

namespace drape::python {

namespace {

/// The parameter struct of a prototype: a value for each parameter of the schema.
using ParameterValue = std::variant<ConfigNode, double>;  // a double for type "number"
using ParameterValues = std::vector<ParameterValue>;

ParameterValue value_of(const ConfigNode& node, const std::string& type) {
  if (type == "number") return parse_number(node.scalar).value();
  return node;
}

std::string type_of(const py::object& value, const std::string& name) {
  if (py::isinstance<py::bool_>(value)) return "boolean";
  if (py::isinstance<py::int_>(value)) return "integer";
  if (py::isinstance<py::float_>(value)) return "number";
  if (py::isinstance<py::str>(value)) return "text";
  throw py::type_error("the parameter " + name + " must default to a bool, int, float or str, not " +
                       std::string(py::repr(value)));
}

Parameter parameter_of(const std::string& name, const py::object& declared, std::size_t index,
                       ParameterValue& value) {
  const bool plain = !py::hasattr(declared, "default");
  const py::object initial = plain ? declared : py::object(declared.attr("default"));
  Parameter p;
  p.name = name;
  p.type = type_of(initial, name);
  value = value_of(node_of(initial), p.type);
  if (!plain) {
    p.description = declared.attr("description").cast<std::string>();
    p.unit = declared.attr("unit").cast<std::string>();
    p.source = declared.attr("source").cast<std::string>();
    if (!declared.attr("minimum").is_none()) p.minimum = declared.attr("minimum").cast<double>();
    if (!declared.attr("maximum").is_none()) p.maximum = declared.attr("maximum").cast<double>();
  }
  p.read = [index, type = p.type](void* values, const ConfigNode& node, ConfigErrors&) {
    static_cast<ParameterValues*>(values)->at(index) = value_of(node, type);
  };
  p.write = [index](const void* values) {
    const ParameterValue& own = static_cast<const ParameterValues*>(values)->at(index);
    const double* number = std::get_if<double>(&own);
    return number ? ConfigNode::of(*number) : std::get<ConfigNode>(own);
  };
  p.number = [index](void* values, std::size_t k) {
    return k == 0 ? std::get_if<double>(&static_cast<ParameterValues*>(values)->at(index)) : nullptr;
  };
  return p;
}

}  // namespace

Schema schema_of_class(const py::object& type, const std::string& name) {
  Schema schema;
  schema.name = name;
  ParameterValues defaults;
  for (const auto& [key, declared] : type.attr("parameters").cast<py::dict>()) {
    ParameterValue value;
    schema.parameters.push_back(parameter_of(
        key.cast<std::string>(), py::reinterpret_borrow<py::object>(declared), defaults.size(), value));
    defaults.push_back(std::move(value));
  }
  schema.fresh = [defaults] { return std::make_shared<ParameterValues>(defaults); };
  schema.copy = [](const void* values) {
    return std::make_shared<ParameterValues>(*static_cast<const ParameterValues*>(values));
  };
  return schema;
}

py::dict keyword_arguments(const Schema& schema, const void* values) {
  py::dict all;
  for (const Parameter& p : schema.parameters) {
    const ConfigNode node = p.write(values);
    const py::str name(p.name);
    if (p.type == "boolean")
      all[name] = node.scalar == "true";
    else if (p.type == "integer")
      all[name] = parse_integer(node.scalar).value();
    else if (p.type == "number")
      all[name] = parse_number(node.scalar).value();
    else
      all[name] = node.scalar;
  }
  return all;
}

}  // namespace drape::python

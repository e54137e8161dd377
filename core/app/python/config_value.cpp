#include "core/app/python/config_value.h"

#include "core/app/experiment/describe.h"
#include "core/app/files/json_file.h"

namespace drape::python {

namespace {

/// Deepest nesting, as of YAML files; a list that contains itself ends here.
constexpr int max_depth = 100;

/// A str's text, which a config.yaml can hold.
std::string text_of(const py::handle& value) {
  std::string text;
  try {
    text = value.cast<std::string>();
  } catch (const py::cast_error&) {
    throw py::value_error(std::string(py::repr(value)) + " is no text that UTF-8 can hold");
  }
  if (text.find('\0') != std::string::npos)
    throw py::value_error(std::string(py::repr(value)) + " has a NUL character; take it out");
  return text;
}

ConfigNode nested_node(const py::handle& value, int depth) {
  if (depth > max_depth) throw py::value_error("the experiment is nested too deeply");
  if (value.is_none()) return {};
  if (py::isinstance<py::bool_>(value)) return ConfigNode::of(value.cast<bool>());
  if (py::isinstance<py::int_>(value)) {
    ConfigNode node = ConfigNode::of(std::string(py::str(value)));
    node.quoted = false;
    return node;
  }
  if (py::isinstance<py::float_>(value)) return ConfigNode::of(value.cast<double>());
  if (py::isinstance<py::str>(value)) return ConfigNode::of(text_of(value));
  ConfigNode node;
  if (py::isinstance<py::dict>(value)) {
    node.kind = ConfigNode::Kind::map;
    for (const auto& [key, entry] : py::reinterpret_borrow<py::dict>(value)) {
      if (!py::isinstance<py::str>(key))
        throw py::type_error("a key of an experiment must be a str, not " + std::string(py::repr(key)));
      node.add(text_of(key), nested_node(entry, depth + 1));
    }
    return node;
  }
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    node.kind = ConfigNode::Kind::list;
    for (const py::handle item : value) node.items.push_back(nested_node(item, depth + 1));
    return node;
  }
  if (py::hasattr(value, "tolist")) return nested_node(value.attr("tolist")(), depth + 1);  // numpy's
  if (py::hasattr(value, "__fspath__")) return ConfigNode::of(text_of(value.attr("__fspath__")()));
  throw py::type_error("an experiment cannot hold " + std::string(py::repr(value)));
}

}  // namespace

ConfigNode node_of(const py::handle& value) { return nested_node(value, 0); }

py::object value_of(const ConfigNode& node) {
  return py::module_::import("json").attr("loads")(json_text(json_value(node)));
}

void throw_errors(const ConfigErrors& errors) {
  if (errors.empty()) return;
  const py::module_ types = py::module_::import("drape.errors");
  py::list faults;
  for (const ConfigError& error : errors)
    faults.append(types.attr("ConfigFault")(error.message, error.where.file, error.where.line,
                                            error.where.column, error.where.key));
  const py::object type = types.attr("ConfigError");
  PyErr_SetObject(type.ptr(), type(faults).ptr());
  throw py::error_already_set();
}

}  // namespace drape::python

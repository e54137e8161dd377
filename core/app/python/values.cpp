#include "core/app/python/values.h"

#include <limits>
#include <regex>
#include <utility>

#include "core/app/experiment/experiment_path.h"
#include "core/app/files/json_file.h"
#include "core/app/files/yaml_file.h"
#include "core/kernel/interfaces/topology.h"

namespace drape::python {

namespace {

/// An array of anything that numpy takes. Throws TypeError unless its kind is among `kinds` (numpy's
/// letters).
py::array array_of_kind(const py::handle& values, const std::string& kinds, const std::string& name,
                        const std::string& wanted) {
  const py::array array = py::array::ensure(values);
  if (!array) PyErr_Clear();
  if (!array || kinds.find(array.dtype().kind()) == kinds.npos)
    throw py::type_error(
        name + " must be an array of " + wanted + ", not " +
        (array ? "of " + std::string(py::str(array.dtype())) : std::string(py::str(py::type::of(values)))));
  return array;
}

/// Deepest nesting, as of YAML files; a list that contains itself ends here.
constexpr int max_depth = 100;

[[noreturn]] void refuse_nul(const py::handle& value) {
  throw py::value_error(shown(value) + " has a NUL character; take it out");
}

ConfigNode nested_node(const py::handle& value, int depth) {
  if (depth > max_depth) throw py::value_error("the experiment is nested too deeply");
  if (value.is_none()) return {};
  if (py::isinstance<py::bool_>(value)) return ConfigNode::of(value.cast<bool>());
  if (py::isinstance<py::int_>(value)) return ConfigNode::plain(py::str(value));
  if (py::isinstance<py::float_>(value)) return ConfigNode::of(value.cast<double>());
  if (py::isinstance<py::str>(value)) return ConfigNode::of(text_of(value));
  if (py::isinstance<py::dict>(value)) {
    ConfigNode node(ConfigNode::Kind::map);
    for (const auto& [key, entry] : py::reinterpret_borrow<py::dict>(value)) {
      if (!py::isinstance<py::str>(key))
        throw py::type_error("a key of an experiment must be a str, not " + shown(key));
      node.add(text_of(key), nested_node(entry, depth + 1));
    }
    return node;
  }
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    ConfigNode node(ConfigNode::Kind::list);
    for (const py::handle item : value) node.items.push_back(nested_node(item, depth + 1));
    return node;
  }
  if (py::hasattr(value, "tolist")) return nested_node(value.attr("tolist")(), depth + 1);  // numpy's
  if (py::hasattr(value, "__fspath__")) return ConfigNode::of(text_of(value.attr("__fspath__")()));
  throw py::type_error("an experiment cannot hold " + shown(value));
}

}  // namespace

std::string text_of(const py::handle& value) {
  std::string text;
  try {
    text = value.cast<std::string>();
  } catch (const py::cast_error&) {
    throw py::value_error(shown(value) + " is no text that UTF-8 can hold");
  }
  if (text.find('\0') != std::string::npos) refuse_nul(value);
  return text;
}

py::array_t<double> real_array(const py::handle& values, const std::string& name) {
  return py::array_t<double>::ensure(array_of_kind(values, "fiu", name, "real numbers"));
}

Stencils integer_rows(const py::handle& values, Eigen::Index columns, const std::string& name) {
  const auto array = py::array_t<std::int64_t>::ensure(array_of_kind(values, "iu", name, "integers"));
  if (array.ndim() != 2 || (columns >= 0 && array.shape(1) != columns))
    throw py::value_error(name + " must have the shape (m, " +
                          (columns >= 0 ? std::to_string(columns) : "k") + "), not " +
                          shown(array.attr("shape")));
  const auto wide =
      array.cast<Eigen::Matrix<std::int64_t, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>();
  using Limits = std::numeric_limits<int>;
  if (wide.size() > 0 && (wide.maxCoeff() > Limits::max() || wide.minCoeff() < Limits::min()))
    throw py::value_error(name + " has an integer that does not fit 32 bits");
  return wide.cast<int>();
}

const Positions& State::of(Eigen::Index vertices) const {
  if (x.rows() != vertices)
    throw py::value_error("positions must have the shape (" + std::to_string(vertices) +
                          ", 3), one row a vertex, not (" + std::to_string(x.rows()) + ", 3)");
  return x;
}

State state_of(const py::handle& values) {
  const auto array = real_array(values, "positions");
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw py::value_error("positions must have the shape (n, 3), one row a vertex, not " +
                          shown(array.attr("shape")));
  return {array.cast<Positions>()};
}

py::object bsr_matrix(const BlockMatrix& matrix) {
  const BlockPattern& pattern = *matrix.pattern;
  const AdjacencyList rows = pattern.neighbours();
  py::array_t<double> blocks({static_cast<py::ssize_t>(rows.items.size()), py::ssize_t{3}, py::ssize_t{3}});
  std::vector<int> next = rows.start;
  using Block = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const auto put = [&](int row, const Block& values) {
    Eigen::Map<Block>(blocks.mutable_data() + 9 * static_cast<std::ptrdiff_t>(next[row]++)) = values;
  };
  // Within each row by ascending columns, as neighbours() has them.
  pattern.for_each_block([&](int i, int j, int b) {
    const Eigen::Map<const Block> block(matrix.block(b));
    put(i, block);
    if (j != i) put(j, block.transpose());
  });
  const auto array_of = [](const std::vector<int>& integers) {
    return py::array_t<int>(static_cast<py::ssize_t>(integers.size()), integers.data());
  };
  const int size = 3 * pattern.rows();
  return py::module_::import("scipy.sparse")
      .attr("bsr_matrix")(py::make_tuple(blocks, array_of(rows.items), array_of(rows.start)),
                          py::arg("shape") = py::make_tuple(size, size));
}

ConfigNode node_of(const py::handle& value) { return nested_node(value, 0); }

std::filesystem::path path_of(const py::handle& value) {
  const std::string bytes = py::module_::import("os").attr("fsencode")(value).cast<py::bytes>();
  if (bytes.find('\0') != std::string::npos) refuse_nul(value);
  return bytes;
}

py::dict value_of(const ConfigNode& node) {
  return py::module_::import("json").attr("loads")(json_text(json_value(node)));
}

std::string option_of(const std::string& key) { return "--set " + key; }

ConfigNode with_value(ConfigNode experiment, const std::string& key, const py::object& value) {
  ConfigErrors errors;
  if (py::isinstance<py::str>(value)) {
    set_parameter(experiment, key, text_of(value), option_of(key), errors);
  } else {
    const Location where{option_of(key)};
    ConfigNode node = node_of(value);
    set_places(node, where);
    set_parameter(experiment, key, std::move(node), where, errors);
  }
  refuse_scheduled(experiment, key, option_of(key), errors);
  throw_errors(errors);
  return experiment;
}

std::string in_python(std::string message) {
  static constexpr std::pair<const char*, const char*> terms[] = {
      {"--method all", "methods=\"all\""},     {"--method", "methods"}, {"--overwrite", "overwrite=True"},
      {"--allow-memory", "allow_memory=True"}, {"--out", "out"},        {"--plugin", "drape.load_plugin"}};
  for (const auto& [option, argument] : terms)
    message = std::regex_replace(message, std::regex(std::string(option) + "\\b"), argument);
  return message;
}

void warn(const std::string& message) {
  if (PyErr_WarnEx(PyExc_UserWarning, message.c_str(), 1) != 0) throw py::error_already_set();
}

void throw_errors(const ConfigErrors& errors) {
  if (errors.empty()) return;
  const py::module_ types = py::module_::import("drape.experiment");
  py::list faults;
  for (const ConfigError& error : errors)
    faults.append(types.attr("ConfigFault")(in_python(error.message), error.where.file, error.where.line,
                                            error.where.column, error.where.key));
  const py::object type = types.attr("ConfigError");
  PyErr_SetObject(type.ptr(), type(faults).ptr());
  throw py::error_already_set();
}

}  // namespace drape::python

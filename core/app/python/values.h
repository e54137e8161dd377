#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <filesystem>
#include <string>

#include "core/kernel/interfaces/block_sink.h"
#include "core/kernel/interfaces/triangle_mesh.h"
#include "core/kernel/plugin/config_node.h"
#include "core/numerics/linear_algebra/block_matrix.h"

namespace drape::python {

namespace py = pybind11;

/// Python's repr() of a value, for messages.
inline std::string shown(const py::handle& value) { return py::repr(value); }
/// The name of the value's class.
inline std::string class_of(const py::handle& value) {
  return py::str(py::type::handle_of(value).attr("__name__"));
}

/// An argument that is an integer: pybind11 would cut a numpy.float32, a Fraction or a Decimal.
inline py::arg whole(const char* name) { return py::arg(name).noconvert(); }

/// The value as a T. Throws TypeError, which says that `what` must be `wanted`.
template <class T>
T cast_to(const py::handle& value, const std::string& what, const std::string& wanted) {
  try {
    return value.cast<T>();
  } catch (const py::cast_error&) {
    throw py::type_error(what + " must be " + wanted + ", not " + shown(value));
  }
}

/// An array of doubles, in any order in memory. Throws TypeError for what is not made of real numbers.
py::array_t<double> real_array(const py::handle& values, const std::string& name);
/// Rows of integers, all within int. Throws TypeError, or ValueError for another shape: `columns` -1 allows
/// any number.
Stencils integer_rows(const py::handle& values, Eigen::Index columns, const std::string& name);

/// Positions that Python gives: n×3 real numbers of any type. A wrong type raises TypeError, a wrong shape
/// ValueError.
struct State {
  Positions x;
  /// x. Throws ValueError, with both shapes, unless it has `vertices` rows.
  const Positions& of(Eigen::Index vertices) const;
};
State state_of(const py::handle& values);

/// A symmetric matrix of 3×3 blocks as a scipy.sparse.bsr_matrix with both triangles.
py::object bsr_matrix(const BlockMatrix& matrix);

/// A str's text, which a config.yaml can hold. Throws ValueError for one with a NUL character, at which a
/// message would end, or that UTF-8 cannot hold.
std::string text_of(const py::handle& value);
/// A name or a key, as text_of reads it.
struct Text : std::string {};

/// A Python value as a node of a config: None, bool, int, float, str, a path, dicts, lists, tuples and numpy
/// arrays of them. Throws TypeError for anything else.
ConfigNode node_of(const py::handle& value);

/// A str, bytes or path of Python as a path. Throws ValueError for one with a NUL character, which the system
/// would cut there.
std::filesystem::path path_of(const py::handle& value);

/// The node as Python's dict, list, str, int, float, bool or None.
py::dict value_of(const ConfigNode& node);

/// The "file" in the locations of a value that is set: "--set material.thickness".
std::string option_of(const std::string& key);

/// The experiment with another value at the key, whose location is option_of(key); a str is read as YAML.
/// Throws drape.ConfigError for a path that is none.
ConfigNode with_value(ConfigNode experiment, const std::string& key, const py::object& value);

/// A message with the arguments of Experiment.run in place of the command's options.
std::string in_python(std::string message);

/// Warns in Python. Throws what Python raises where warnings are errors.
void warn(const std::string& message);

/// Throws a Python exception drape.ConfigError unless the list is empty.
void throw_errors(const ConfigErrors& errors);

}  // namespace drape::python

namespace pybind11::detail {

template <>
struct type_caster<drape::python::State> {
  PYBIND11_TYPE_CASTER(drape::python::State, const_name("numpy.typing.ArrayLike"));
  bool load(handle source, bool) {
    value = drape::python::state_of(source);
    return true;
  }
};

template <>
struct type_caster<std::filesystem::path> {
  PYBIND11_TYPE_CASTER(std::filesystem::path, const_name("os.PathLike"));
  bool load(handle source, bool) {
    value = drape::python::path_of(source);
    return true;
  }
};

template <>
struct type_caster<drape::python::Text> {
  PYBIND11_TYPE_CASTER(drape::python::Text, const_name("str"));
  bool load(handle source, bool) {
    if (PyUnicode_Check(source.ptr()) == 0) return false;
    value = {drape::python::text_of(source)};
    return true;
  }
};

template <>
struct type_caster<drape::BlockMatrix> {
  static constexpr auto name = const_name("scipy.sparse.bsr_matrix");
  static handle cast(const drape::BlockMatrix& matrix, return_value_policy, handle) {
    return drape::python::bsr_matrix(matrix).release();
  }
};

}  // namespace pybind11::detail

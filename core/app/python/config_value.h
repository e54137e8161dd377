#pragma once

#include <pybind11/pybind11.h>

#include "core/kernel/plugin/config_node.h"

namespace drape::python {

namespace py = pybind11;

/// A Python value as a node of a config: None, bool, int, float, str, a path, dicts, lists, tuples and numpy
/// arrays of them. Throws TypeError for anything else.
ConfigNode node_of(const py::handle& value);

/// The node as Python's dict, list, str, int, float, bool or None.
py::object value_of(const ConfigNode& node);

/// Throws a Python exception drape.ConfigError unless the list is empty.
void throw_errors(const ConfigErrors& errors);

}  // namespace drape::python

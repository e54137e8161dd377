#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "core/kernel/plugin/parameters.h"

namespace drape::python {

namespace py = pybind11;

/// The parameters that a Python class declares in its dict `parameters`, from a name to a drape.Parameter or
/// a plain default. Throws TypeError or ValueError, naming the parameter, for a declaration that is not one.
Schema schema_of_class(const py::object& type, const std::string& name);

/// The values of a parameter struct with such a schema, as keyword arguments of the class.
py::dict keyword_arguments(const Schema& schema, const void* values);

}  // namespace drape::python

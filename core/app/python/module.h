#pragma once

#include <pybind11/pybind11.h>

namespace drape::python {

namespace py = pybind11;

// What each file adds to the module; Python's own part of the package is in drape/.

void bind_errors(py::module_& m);      ///< C++ exceptions as Python's
void bind_levels(py::module_& m);      ///< Material, Level
void bind_model(py::module_& m);       ///< Model: energies and their derivatives
void bind_scene(py::module_& m);       ///< Scene: levels, prolongations, models, metrics
void bind_iterations(py::module_& m);  ///< Iteration, LevelResult
void bind_result(py::module_& m);      ///< Result: what a run has written
void bind_solve(py::module_& m);       ///< Solve: a method step by step
void bind_experiment(py::module_& m);  ///< Experiment
void bind_prototypes(py::module_& m);  ///< registering Python classes as plugins

}  // namespace drape::python

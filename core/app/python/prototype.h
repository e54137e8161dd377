#pragma once

#include "core/app/python/module.h"
#include "core/app/python/python_call.h"

namespace drape::python {

// The implementations of the kernel's interfaces by objects of Python's classes (drape/prototypes.py), as
// pointers to the interface. Call with the GIL held. They throw TypeError or ValueError for a declaration
// that is not one.

std::shared_ptr<Energy> prototype_energy(const py::object& prototype);
std::shared_ptr<Metric> prototype_metric(const py::object& prototype);
std::shared_ptr<Refiner> prototype_refiner(const py::object& prototype);
std::shared_ptr<Solver> prototype_solver(const py::object& prototype);

}  // namespace drape::python

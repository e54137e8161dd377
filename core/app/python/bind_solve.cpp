#include <pybind11/stl.h>

#include "core/app/python/arrays.h"
#include "core/app/python/callbacks.h"
#include "core/app/python/config_value.h"
#include "core/app/python/module.h"
#include "core/app/python/registry.h"
#include "core/app/python/scene_handle.h"
#include "core/app/python/solve_handle.h"

namespace drape::python {

SolveHandle::~SolveHandle() {
  const py::gil_scoped_release released;  // the solver's thread may need the GIL to end
  solve_.reset();
}

void SolveHandle::require_idle() const {
  if (busy_) throw std::runtime_error("the solve is being advanced, by another thread or by its own solver");
}

std::optional<Iteration> SolveHandle::next() {
  require_idle();
  busy_ = true;
  bool advanced = false;
  std::exception_ptr error;
  {
    const py::gil_scoped_release released;
    try {
      advanced = solve_->solve().advance();
    } catch (...) {
      error = std::current_exception();
    }
  }
  busy_ = false;
  if (error) std::rethrow_exception(error);
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (!advanced) return std::nullopt;
  SteppedSolve& solve = solve_->solve();
  return Iteration{solve.row(), std::make_shared<const Positions>(solve.x())};
}

void SolveHandle::set(const std::string& key, const std::string& value) {
  require_idle();
  busy_ = true;
  ConfigErrors errors;
  std::exception_ptr error;
  {
    const py::gil_scoped_release released;
    try {
      solve_->set(key, value, errors);
    } catch (...) {
      error = std::current_exception();
    }
  }
  busy_ = false;
  if (error) std::rethrow_exception(error);
  throw_errors(errors);
}

void bind_solve(py::module_& m) {
  py::class_<MethodState, std::shared_ptr<MethodState>>(
      m, "Checkpoint",
      "The state of a solve at the beginning of a step. Experiment.solver(method, start=checkpoint) goes on "
      "from it with the bits of a solve that was not interrupted, and repeats the step.")
      .def_readonly("level", &MethodState::level);

  py::class_<SolveHandle>(
      m, "Solve",
      "One method of an experiment, advanced an iteration at a time: `for iteration in solver.iterate()`. "
      "Nothing is recorded.")
      .def(
          "iterate", [](py::object self) { return self; }, "An iterator over Iterations.")
      .def("__iter__", [](py::object self) { return self; })
      .def("__next__",
           [](SolveHandle& s) {
             const std::optional<Iteration> iteration = s.next();
             if (!iteration) throw py::stop_iteration();
             return *iteration;
           })
      .def("stop", &SolveHandle::stop, "End the solve at its next step.")
      .def("refine", &SolveHandle::refine, "End the level at its next step and begin the next finer one.")
      .def(
          "set",
          [](SolveHandle& s, const std::string& key, const py::object& value) {
            s.set(key,
                  py::isinstance<py::str>(value) ? value.cast<std::string>() : node_of(value).one_line());
          },
          py::arg("key"), py::arg("value"),
          "Change one value of the experiment, a material's or a pin's, and go on from the present state. "
          "Raises ConfigError, with nothing changed, if it is refused.")
      .def("checkpoint", &SolveHandle::checkpoint,
           "The state at the beginning of the step of the last iteration.")
      .def_property_readonly("levels", &SolveHandle::levels,
                             "Results of the finished levels since the last `set`.")
      .def_property_readonly("method", [](const SolveHandle& s) { return s.steered().method(); })
      .def_property_readonly("scene", [](const SolveHandle& s) {
        return SceneHandle{s.steered().experiment(), s.steered().scene()};
      });
}

}  // namespace drape::python

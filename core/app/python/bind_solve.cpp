#include <pybind11/stl.h>

#include <set>

#include "core/app/python/arrays.h"
#include "core/app/python/callbacks.h"
#include "core/app/python/config_value.h"
#include "core/app/python/module.h"
#include "core/app/python/registry.h"
#include "core/app/python/scene_handle.h"
#include "core/app/python/solve_handle.h"

namespace drape::python {

namespace {

/// Those that exist, guarded by the GIL. Never destroyed: solves may outlive the module.
std::set<SolveHandle*>& all_solves() {
  static auto* const all = new std::set<SolveHandle*>;
  return *all;
}

}  // namespace

void end_all_solves() {
  const std::set<SolveHandle*> all = all_solves();
  for (SolveHandle* solve : all)
    if (all_solves().count(solve) > 0) solve->end();  // one's end may destroy another
}

SolveHandle::SolveHandle(std::unique_ptr<SteeredSolve> solve) : solve_(std::move(solve)) {
  all_solves().insert(this);
}

SolveHandle::~SolveHandle() {
  all_solves().erase(this);
  end();
}

void SolveHandle::end() {
  if (busy_) return;  // whoever advances it keeps it
  std::unique_ptr<SteeredSolve> ended = std::move(solve_);
  const py::gil_scoped_release released;  // the solver's thread may need the GIL to end
  ended.reset();
}

void SolveHandle::require_idle() const {
  if (busy_) throw std::runtime_error("the solve is being advanced, by another thread or by its own solver");
  if (!solve_) throw std::runtime_error("the solve has ended, with the interpreter");
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
  py::module_::import("atexit").attr("register")(py::cpp_function(&end_all_solves));
  py::class_<CheckpointHandle, std::shared_ptr<CheckpointHandle>>(
      m, "Checkpoint",
      "The state of a solve at the beginning of a step. Experiment.solver(method, start=checkpoint) goes on "
      "from it with the bits of a solve that was not interrupted, and repeats the step.")
      .def_property_readonly("level", [](const CheckpointHandle& c) { return c.state.level; });

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

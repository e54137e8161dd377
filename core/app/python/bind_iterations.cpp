#include <pybind11/stl.h>

#include "core/app/python/arrays.h"
#include "core/app/python/callbacks.h"
#include "core/app/python/module.h"
#include "core/kernel/files/number_text.h"

namespace drape::python {

namespace {

template <class Member>
auto row_member(Member IterationRow::*member) {
  return [member](const Iteration& i) { return i.row.*member; };
}

}  // namespace

void bind_iterations(py::module_& m) {
  py::class_<Iteration>(m, "Iteration", "One Newton iteration and the state after it.")
      .def_property_readonly("level", row_member(&IterationRow::level))
      .def_property_readonly("step", row_member(&IterationRow::step))
      .def_property_readonly("iteration", row_member(&IterationRow::iteration), "Within its step.")
      .def_property_readonly("time", row_member(&IterationRow::time), "Pseudo-time; None without a schedule.")
      .def_property_readonly("seconds", row_member(&IterationRow::seconds), "Since the method's start [s].")
      .def_property_readonly("flops", row_member(&IterationRow::flops), "Of the level's factorisations.")
      .def_property_readonly("energy", row_member(&IterationRow::energy), "Plain energy of the level [J].")
      .def_property_readonly("proxy_energy", row_member(&IterationRow::proxy_energy),
                             "Energy that the method minimises in its place [J], or None.")
      .def_property_readonly("decrement", row_member(&IterationRow::decrement), "‖p‖ / (h √n) [m/s].")
      .def_property_readonly("force_residual", row_member(&IterationRow::force_residual), "[1]")
      .def_property_readonly("step_length", row_member(&IterationRow::step_length), "α of the line search.")
      .def_property_readonly("step_size", row_member(&IterationRow::step_size), "h [s].")
      .def_property_readonly("contacts", row_member(&IterationRow::contacts),
                             "Contacts closer than d̂; None without a contact model.")
      .def_property_readonly("smallest_gap", row_member(&IterationRow::smallest_gap), "Of them [m].")
      .def_property_readonly(
          "x", [](const Iteration& i) { return view(*i.x, i.x); }, "n×3 positions [m], read-only.")
      .def("__repr__", [](const Iteration& i) {
        return "<drape.Iteration level " + std::to_string(i.row.level) + ", step " +
               std::to_string(i.row.step) + ", force_residual " + fixed_text(i.row.force_residual, 6) + ">";
      });

  py::class_<LevelResult, std::shared_ptr<LevelResult>>(m, "LevelResult", "How a level of a solve ended.")
      .def_readonly("level", &LevelResult::level)
      .def_property_readonly(
          "status", [](const LevelResult& r) { return to_string(r.outcome); },
          "converged, max_steps_reached, stalled, cancelled, infeasible, …")
      .def_readonly("message", &LevelResult::message)
      .def_readonly("steps", &LevelResult::steps)
      .def_readonly("iterations", &LevelResult::iterations)
      .def_readonly("factorisations", &LevelResult::factorisations)
      .def_readonly("seconds", &LevelResult::seconds)
      .def_readonly("seconds_by_phase", &LevelResult::seconds_by_phase)
      .def_readonly("force_residual", &LevelResult::force_residual, "Of the objective [1].")
      .def_readonly("smallest_gap", &LevelResult::smallest_gap, "[m]; None without a contact model.")
      .def_readonly("contact_stiffness", &LevelResult::contact_stiffness,
                    "Barrier stiffness of each contact model at the end [Pa].")
      .def_property_readonly(
          "x", [](const std::shared_ptr<LevelResult>& r) { return view(r->x, r); },
          "n×3 positions [m], read-only.");
}

}  // namespace drape::python

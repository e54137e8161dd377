#include <pybind11/stl.h>

#include "core/app/python/arrays.h"
#include "core/app/python/config_value.h"
#include "core/app/python/module.h"
#include "core/app/python/prototype_energy.h"
#include "core/app/python/prototype_geometry.h"
#include "core/app/python/prototype_parameters.h"
#include "core/app/python/prototype_solver.h"
#include "core/app/python/registry.h"
#include "core/kernel/plugin/make.h"
#include "core/numerics/model/derivative_check.h"

namespace drape::python {

namespace {

/// Registers a class; `Implementation` is made of its objects.
template <class Interface, class Implementation>
void register_class(const std::string& name, const py::object& type) {
  auto entry = std::make_unique<RegistryEntry>();
  entry->kind = Interface::kind;
  entry->name = name;
  const py::object summary = type.attr("__doc__");
  if (!summary.is_none())
    entry->summary = py::str(py::module_::import("inspect").attr("cleandoc")(summary)).cast<std::string>();
  entry->summary = entry->summary.substr(0, entry->summary.find('\n'));
  entry->library = prototype_library;
  entry->schema = schema_of_class(type, name);
  entry->make_parameters = entry->schema.fresh;
  entry->make = [type = share(type), schema = entry->schema](const void* values,
                                                             const void*) -> std::shared_ptr<void> {
    return with_python([&]() -> std::shared_ptr<void> {
      const py::object object = (*type)(**keyword_arguments(schema, values));
      const std::shared_ptr<Interface> made = std::make_shared<Implementation>(object);
      return made;
    });
  };
  register_prototype(std::move(entry));
}

/// An energy bound to a level, which it keeps.
struct BoundEnergyHandle {
  LevelHandle level;
  std::shared_ptr<const BoundEnergy> energy;

  Positions state(const py::object& x) const { return positions_of(x, level.level->vertex_count(), "x"); }
};

BoundEnergyHandle bind_energy(const py::object& source, const LevelHandle& level, const Material& material) {
  std::shared_ptr<Energy> energy;
  if (py::isinstance<py::str>(source) || py::isinstance<py::dict>(source)) {
    ConfigErrors errors;
    energy = make_from<Energy>(registry(), node_of(source), errors);
    throw_errors(errors);
  } else {
    energy = std::make_shared<PythonEnergy>(source);
  }
  return {level, energy->bind(*level.level, material)};
}

BlockMatrix hessian_of(const BoundEnergyHandle& h, const Positions& x) {
  const Stencils stencils = h.energy->stencils();
  BlockMatrix matrix(BlockPattern::of(static_cast<int>(x.rows()), {stencils}));
  matrix.set_zero();
  if (stencils.rows() == 0) return matrix;
  const BlockSlots slots(*matrix.pattern, stencils);
  BlockSink sink = slots.sink(matrix);
  h.energy->add_hessian(x, Projection::none, sink);
  return matrix;
}

py::dict check(const BoundEnergyHandle& h, const py::object& state, double step) {
  const DerivativeCheck found = check_derivatives(*h.energy, h.state(state), step);
  py::dict all;
  all["gradient"] = found.gradient.error;
  all["gradient_at"] = py::make_tuple(found.gradient.row / 3, found.gradient.row % 3);
  all["hessian"] = found.hessian.error;
  all["hessian_at"] = py::make_tuple(found.hessian.row / 3, found.hessian.row % 3, found.hessian.column / 3,
                                     found.hessian.column % 3);
  all["asymmetry"] = found.asymmetry;
  all["worst"] = found.worst();
  all["text"] = found.text();
  return all;
}

void bind_bound_energy(py::module_& m) {
  py::class_<BoundEnergyHandle>(m, "BoundEnergy", "An energy on one level. x is n×3 [m].")
      .def(
          "value",
          [](const BoundEnergyHandle& h, const py::object& x) { return h.energy->value(h.state(x)); },
          py::arg("x"), "[J]")
      .def(
          "gradient",
          [](const BoundEnergyHandle& h, const py::object& values) {
            const Positions x = h.state(values);
            Positions g = Positions::Zero(x.rows(), 3);
            h.energy->add_gradient(x, g);
            return array_of(std::move(g));
          },
          py::arg("x"), "n×3 [N]")
      .def(
          "hessian",
          [](const BoundEnergyHandle& h, const py::object& x) {
            return bsr_matrix(hessian_of(h, h.state(x)));
          },
          py::arg("x"), "3n×3n scipy.sparse.bsr_matrix [N/m], without projection.")
      .def("check", &check, py::arg("x"), py::arg("step") = difference_step,
           "The largest relative errors of gradient and Hessian against finite differences with this step "
           "[m], "
           "and where they are.");
  m.def("_checked_level", [] { return LevelHandle{std::make_shared<const Level>(checked_level())}; });
  m.def("_checked_state", [](const LevelHandle& level) { return array_of(checked_state(*level.level)); });
  m.def(
      "bind_energy", &bind_energy, py::arg("energy"), py::arg("level"), py::arg("material") = Material(),
      "An energy on a level: of a plugin's name, of {\"type\": name, parameter: value}, or of a drape.Energy "
      "object. Raises ConfigError.");
}

void bind_solver_problem(py::module_& m) {
  py::class_<SolverProblem, std::shared_ptr<SolverProblem>>(
      m, "Problem", "What a solver in Python works on. Valid during its `solve`.")
      .def_property_readonly("level_count", &SolverProblem::level_count)
      .def("model", &SolverProblem::model, py::arg("level"), "The plain Model of a level.")
      .def(
          "start", [](const SolverProblem& p, int level) { return array_of(p.start(level)); },
          py::arg("level"), "The initial state of a level, n×3 [m].")
      .def(
          "prolong",
          [](const SolverProblem& p, int level, const py::object& values) {
            const Positions x = positions_of(values, p.model(level).vertex_count(), "x");
            return array_of(p.prolong(level, x));
          },
          py::arg("level"), py::arg("x"),
          "A level's state on the next finer one, Dirichlet vertices at their targets.")
      .def("begin", &SolverProblem::begin, py::arg("level"), "Begin a level, finer than the last.")
      .def(
          "iteration",
          [](SolverProblem& p, const py::object& values, std::optional<double> energy,
             std::optional<double> force_residual, double step_length) {
            return p.iteration(positions_of(values, p.vertex_count(), "x"), energy, force_residual,
                               step_length);
          },
          py::arg("x"), py::arg("energy") = py::none(), py::arg("force_residual") = py::none(),
          py::arg("step_length") = 1.0,
          "Report an iteration's state. Returns False after a request to stop: end the level as cancelled. "
          "Energy and residual are computed if they are not given.")
      .def(
          "end",
          [](SolverProblem& p, const py::object& x, const std::string& status, const std::string& message) {
            p.end(positions_of(x, p.vertex_count(), "x"), status, message);
          },
          py::arg("x"), py::arg("status") = "converged", py::arg("message") = "", "End the level.");
}

}  // namespace

void bind_prototypes(py::module_& m) {
  bind_bound_energy(m);
  bind_solver_problem(m);
  m.def("_register_energy", &register_class<Energy, PythonEnergy>);
  m.def("_register_metric", &register_class<Metric, PythonMetric>);
  m.def("_register_refiner", &register_class<Refiner, PythonRefiner>);
  m.def("_register_solver", &register_class<Solver, PythonSolver>);
}

}  // namespace drape::python

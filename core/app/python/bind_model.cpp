#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/app/python/module.h"
#include "core/app/python/values.h"
#include "core/kernel/plugin/bounds.h"
#include "core/numerics/model/objective.h"
#include "core/numerics/model/required.h"

namespace drape::python {

namespace {

Projection projection_of(const std::string& kind, double blend) {
  if (!(blend >= 0 && blend <= 1)) throw py::value_error("blend must be in [0, 1]");
  if (kind == "none") return Projection::none;
  if (kind == "clamp") return {Projection::clamp, blend};
  if (kind == "absolute") return {Projection::absolute, blend};
  throw py::value_error("projection must be none, clamp or absolute, not \"" + kind + "\"");
}

/// The positions of a state of the model. Throws ValueError for a wrong shape and, with contacts, for
/// coordinates that their search cannot sort.
const Positions& state_of_model(const ModelHandle& m, const State& state) {
  const Positions& x = state.of(m.vertex_count());
  if (!m.model().contacts().empty() && !(x.array().abs() <= bounds::largest_coordinate).all())
    throw py::value_error("positions must be finite and within 1e9 m, because the model has contacts");
  return x;
}

/// What the model's function gives at x, evaluated without the GIL.
template <class Result>
auto at_state(Result (LevelModel::*evaluate)(const Positions&) const) {
  return [evaluate](const ModelHandle& m, const State& state) {
    const Positions& x = state_of_model(m, state);
    return without_gil([&] { return (m.model().*evaluate)(x); });
  };
}

Positions gradient(const ModelHandle& m, const State& state) {
  const Positions& x = state_of_model(m, state);
  return without_gil([&] {
    Positions g;
    m.model().energy_gradient(x, g);
    return g;
  });
}

BlockMatrix hessian(const ModelHandle& m, const State& state, const Text& kind, double blend) {
  const Positions& x = state_of_model(m, state);
  const Projection projection = projection_of(kind, blend);
  return without_gil([&] { return m.model().energy_hessian(x, projection); });
}

py::dict energy_parts(const ModelHandle& m, const State& state) {
  py::dict named;
  for (const auto& [name, joules] : at_state (&LevelModel::energy_parts)(m, state))
    named[py::str(name)] = joules;
  return named;
}

/// The contacts at x, one dict for each contact model.
std::vector<py::dict> contacts(const ModelHandle& m, const State& state) {
  const Positions& x = state_of_model(m, state);
  std::vector<py::dict> all;
  for (const auto& contact : m.model().contacts()) {
    std::unique_ptr<Collisions> collisions;
    Positions g = Positions::Zero(x.rows(), 3);
    const double energy = without_gil([&] {
      collisions = collisions_at(*contact, x);
      return collisions->add_gradient(x, g);
    });
    py::dict& one = all.emplace_back();
    one["count"] = collisions->contact_count();
    one["smallest_gap"] = collisions->smallest_gap();
    one["energy"] = energy;
    one["vertices"] = collisions->stencils();
    std::vector<double> gaps;
    collisions->append_gaps(gaps);
    if (static_cast<Eigen::Index>(gaps.size()) == collisions->stencils().rows())
      one["gaps"] = py::array_t<double>(static_cast<py::ssize_t>(gaps.size()), gaps.data());
    one["forces"] = Positions(-g);
  }
  return all;
}

py::list intersections(const ModelHandle& m, const State& state) {
  const Positions& x = state_of_model(m, state);
  py::list all;
  for (const auto& contact : m.model().contacts())
    for (const Intersection& pair : without_gil([&] { return contact->intersections(x); }))
      all.append(py::make_tuple(pair.first, pair.second,
                                py::make_tuple(pair.where.x(), pair.where.y(), pair.where.z())));
  return all;
}

std::pair<double, std::string> max_step(const ModelHandle& m, const State& from, const State& to) {
  const Positions &x0 = state_of_model(m, from), &x1 = state_of_model(m, to);
  const StepLimit limit = without_gil([&] {
    PlainObjective objective(m.model());
    objective.contacts().begin_step(x0);
    return objective.max_step(x0, x1);
  });
  return {limit.fraction, limit.by};
}

Positions set_dirichlet(const ModelHandle& m, const State& state) {
  Positions x = state.of(m.vertex_count());
  m.model().set_dirichlet(x);
  return x;
}

py::array_t<bool> fixed(const ModelHandle& m) {
  const std::vector<char>& flags = m.model().fixed();
  py::array_t<bool> fixed(static_cast<py::ssize_t>(flags.size()));
  std::ranges::transform(flags, fixed.mutable_data(), [](char flag) { return flag != 0; });
  fixed.attr("setflags")(py::arg("write") = false);
  return fixed;
}

}  // namespace

void bind_model(py::module_& m) {
  py::class_<ModelHandle>(
      m, "Model",
      "The plain model of one level: the sum E of its energies, strain limits and contacts, without "
      "friction. Immutable. Every x is n×3 [m]; another shape raises ValueError, another dtype TypeError. "
      "With contacts, x must be finite.")
      .def_property_readonly("level", &ModelHandle::level)
      .def_property_readonly("material", [](const ModelHandle& h) { return h.model().material(); })
      .def_property_readonly(
          "masses", [](const ModelHandle& h) -> const Eigen::VectorXd& { return h.model().masses(); },
          "n lumped masses [kg], read-only.")
      .def_property_readonly("fixed", &fixed,
                             "Whether each of n vertices has a Dirichlet condition, read-only.")
      .def("set_dirichlet", &set_dirichlet, py::arg("x"),
           "A copy of x (n×3) [m] with the Dirichlet vertices at their targets.")
      .def("energy", at_state(&LevelModel::energy), py::arg("x"), "E(x) [J]; +inf outside its domain.")
      .def("gradient", &gradient, py::arg("x"), "∂E/∂x, n×3 [N], fixed vertices included.")
      .def("hessian", &hessian, py::arg("x"), py::arg("projection") = "none", py::arg("blend") = 1.0,
           "∂²E/∂x² as a 3n×3n scipy.sparse.bsr_matrix [N/m]. `projection` of each element's Hessian: none, "
           "clamp or absolute; `blend` in [0, 1] is its share.")
      .def("energy_parts", &energy_parts, py::arg("x"), "The parts of E(x) by name [J].")
      .def("force_residual", at_state(&LevelModel::force_residual), py::arg("x"),
           "‖∂E/∂x‖ over that of the load, on free vertices [1].")
      .def(
          "contacts", &contacts, py::arg("x"),
          "The contacts closer than d̂ at x, one dict for each contact model: count, smallest_gap [m], energy "
          "[J], vertices (c×k, -1 for an obstacle's), gaps (c, the smallest of each row of vertices) [m], "
          "forces (n×3) [N]. Contact models that do not tell their gaps lack that key.")
      .def("intersections", &intersections, py::arg("x"),
           "Pairs of primitives that intersect at x, as (first, second, (x, y, z)) [m].")
      .def("max_step", &max_step, py::arg("x0"), py::arg("x1"),
           "Largest step from x0 towards x1 without intersections and within the strain limits, and what "
           "limits it: (fraction in [0, 1], name).");
}

}  // namespace drape::python

#include <pybind11/stl.h>

#include "core/app/python/arrays.h"
#include "core/app/python/level_handle.h"
#include "core/app/python/module.h"
#include "core/kernel/plugin/bounds.h"
#include "core/numerics/model/objective.h"

namespace drape::python {

namespace {

using Released = py::gil_scoped_release;  // prototypes in Python take the GIL again

Projection projection_of(const std::string& kind, double blend) {
  if (!(blend >= 0 && blend <= 1)) throw py::value_error("blend must be in [0, 1]");
  if (kind == "none") return Projection::none;
  if (kind == "clamp") return {Projection::clamp, blend};
  if (kind == "absolute") return {Projection::absolute, blend};
  throw py::value_error("projection must be none, clamp or absolute, not \"" + kind + "\"");
}

/// A state of the model. Throws ValueError for a wrong shape and, with contacts, for coordinates that their
/// search cannot sort.
Positions state_of(const ModelHandle& m, const py::handle& values, const std::string& name) {
  Positions x = positions_of(values, m.vertex_count(), name);
  if (!m.model().contacts().empty() && !(x.array().abs() <= bounds::largest_coordinate).all())
    throw py::value_error(name + " must be finite and within 1e9 m, because the model has contacts");
  return x;
}

py::array gradient(const ModelHandle& m, const py::handle& values) {
  const Positions x = state_of(m, values, "x");
  Positions g;
  {
    const Released released;
    m.model().energy_gradient(x, g);
  }
  return array_of(std::move(g));
}

py::object hessian(const ModelHandle& m, const py::handle& values, const std::string& kind, double blend) {
  const Positions x = state_of(m, values, "x");
  const Projection projection = projection_of(kind, blend);
  BlockMatrix matrix;
  {
    const Released released;
    matrix = m.model().energy_hessian(x, projection);
  }
  return bsr_matrix(matrix);
}

/// The contacts at x, one dict for each contact model.
py::list contacts(const ModelHandle& m, const py::handle& values) {
  const Positions x = state_of(m, values, "x");
  py::list all;
  for (const auto& contact : m.model().contacts()) {
    std::unique_ptr<CollisionCandidates> candidates;
    std::unique_ptr<Collisions> collisions;
    Positions g = Positions::Zero(x.rows(), 3);
    double energy = 0;
    {
      const Released released;
      candidates = contact->build_candidates(x, x);
      collisions = candidates->build_collisions(x);
      energy = collisions->add_gradient(x, g);
    }
    py::dict one;
    one["count"] = collisions->contact_count();
    one["smallest_gap"] = collisions->smallest_gap();
    one["energy"] = energy;
    one["vertices"] = array_of(collisions->stencils());
    std::vector<double> gaps;
    collisions->append_gaps(gaps);
    if (static_cast<Eigen::Index>(gaps.size()) == collisions->stencils().rows())
      one["gaps"] = py::array_t<double>(static_cast<py::ssize_t>(gaps.size()), gaps.data());
    one["forces"] = array_of(Positions(-g));
    all.append(one);
  }
  return all;
}

py::list intersections(const ModelHandle& m, const py::handle& values) {
  const Positions x = state_of(m, values, "x");
  py::list all;
  for (const auto& contact : m.model().contacts()) {
    std::vector<Intersection> found;
    {
      const Released released;
      found = contact->intersections(x);
    }
    for (const Intersection& pair : found)
      all.append(py::make_tuple(pair.first, pair.second,
                                py::make_tuple(pair.where.x(), pair.where.y(), pair.where.z())));
  }
  return all;
}

py::tuple max_step(const ModelHandle& m, const py::handle& from, const py::handle& to) {
  const Positions x0 = state_of(m, from, "x0");
  const Positions x1 = state_of(m, to, "x1");
  StepLimit limit;
  {
    const Released released;
    PlainObjective objective(m.model());
    objective.contacts().begin_step(x0);
    limit = objective.max_step(x0, x1);
  }
  return py::make_tuple(limit.fraction, limit.by);
}

/// A number of the model at x.
template <class Evaluate>
double number(const ModelHandle& m, const py::handle& values, const Evaluate& evaluate) {
  const Positions x = state_of(m, values, "x");
  const Released released;
  return evaluate(m.model(), x);
}

void bind_structure(py::class_<ModelHandle>& type) {
  type.def_property_readonly("level", &ModelHandle::level)
      .def_property_readonly("material", [](const ModelHandle& m) { return m.model().material(); })
      .def_property_readonly(
          "masses", [](const ModelHandle& m) { return array_of(Eigen::VectorXd(m.model().masses())); },
          "n lumped masses [kg].")
      .def_property_readonly(
          "fixed",
          [](const ModelHandle& m) {
            const std::vector<char>& flags = m.model().fixed();
            py::array_t<bool> fixed(static_cast<py::ssize_t>(flags.size()));
            std::copy(flags.begin(), flags.end(), fixed.mutable_data());
            return fixed;
          },
          "n flags: whether the vertex has a Dirichlet condition.")
      .def(
          "set_dirichlet",
          [](const ModelHandle& m, const py::handle& values) {
            Positions x = positions_of(values, m.vertex_count(), "x");
            m.model().set_dirichlet(x);
            return array_of(std::move(x));
          },
          py::arg("x"), "A copy of x (n×3) [m] with the Dirichlet vertices at their targets.");
}

}  // namespace

void bind_model(py::module_& m) {
  py::class_<ModelHandle> type(
      m, "Model",
      "The plain model of one level: the sum E of its energies, strain limits and contacts, without "
      "friction. "
      "Immutable. Every x is n×3 [m]; another shape raises ValueError, another dtype TypeError. With "
      "contacts, x must be finite.");
  bind_structure(type);
  type.def(
          "energy",
          [](const ModelHandle& h, const py::object& x) {
            return number(h, x, [](const LevelModel& l, const Positions& p) { return l.energy(p); });
          },
          py::arg("x"), "E(x) [J]; +inf outside its domain.")
      .def("gradient", &gradient, py::arg("x"), "∂E/∂x, n×3 [N], fixed vertices included.")
      .def("hessian", &hessian, py::arg("x"), py::arg("projection") = "none", py::arg("blend") = 1.0,
           "∂²E/∂x² as a 3n×3n scipy.sparse.bsr_matrix [N/m]. `projection` of each element's Hessian: none, "
           "clamp or absolute; `blend` in [0, 1] is its share.")
      .def(
          "energy_parts",
          [](const ModelHandle& h, const py::object& values) {
            const Positions x = state_of(h, values, "x");
            std::vector<std::pair<std::string, double>> parts;
            {
              const Released released;
              parts = h.model().energy_parts(x);
            }
            py::dict named;
            for (const auto& [name, joules] : parts) named[py::str(name)] = joules;
            return named;
          },
          py::arg("x"), "The parts of E(x) by name [J].")
      .def(
          "force_residual",
          [](const ModelHandle& h, const py::object& x) {
            return number(h, x, [](const LevelModel& l, const Positions& p) { return l.force_residual(p); });
          },
          py::arg("x"), "‖∂E/∂x‖ over that of the load, on free vertices [1].")
      .def(
          "contacts", &contacts, py::arg("x"),
          "The contacts closer than d̂ at x, one dict for each contact model: count, smallest_gap [m], energy "
          "[J], vertices (c×k, -1 for an obstacle's), gaps (c, the smallest of each row of vertices) [m], "
          "forces (n×3) "
          "[N]. Contact models that do not tell their gaps lack that key.")
      .def("intersections", &intersections, py::arg("x"),
           "Pairs of primitives that intersect at x, as (first, second, (x, y, z)) [m].")
      .def("max_step", &max_step, py::arg("x0"), py::arg("x1"),
           "Largest step from x0 towards x1 without intersections and within the strain limits, and what "
           "limits "
           "it: (fraction in [0, 1], name).");
}

}  // namespace drape::python

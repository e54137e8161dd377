#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/app/experiment/material_parameters.h"
#include "core/app/python/module.h"
#include "core/app/python/values.h"
#include "core/app/report/report.h"
#include "core/kernel/plugin/parameters.h"
#include "core/numerics/mesh/check.h"

namespace drape::python {

namespace {

std::shared_ptr<Level> make_level(const State& rest, const py::object& triangles) {
  TriangleMesh mesh{rest.x, integer_rows(triangles, 3, "triangles")};
  std::string faults;
  for (const std::string& fault : check_mesh(mesh)) faults += (faults.empty() ? "" : "\n") + fault;
  if (!faults.empty()) throw py::value_error(faults);
  return std::make_shared<Level>(Level::of(0, std::move(mesh)));
}

/// A material that declares the keys of an experiment's `material`.
struct MaterialOfKeys : Material {
  static void declare(Declaration<MaterialOfKeys>& d) { declare_material(d); }
};

Material make_material(const py::kwargs& values) {
  MaterialOfKeys material;
  ConfigErrors errors;
  ConfigNode node = node_of(values);
  node.name_keys();
  schema_of<MaterialOfKeys>("material").read(&material, node, errors);
  throw_errors(errors);
  return material;
}

/// Matrices that Python cannot change, since they are copies.
py::tuple read_only(const std::vector<ProlongationMatrix>& matrices) {
  py::tuple all(matrices.size());
  for (std::size_t k = 0; k < matrices.size(); ++k) {
    const py::object matrix = py::cast(matrices[k]);
    for (const char* part : {"data", "indices", "indptr"})
      matrix.attr(part).attr("setflags")(py::arg("write") = false);
    all[k] = matrix;
  }
  return all;
}

void bind_level(py::module_& m) {
  py::class_<Material>(m, "Material",
                       "A cloth material. Moduli are Young's moduli of the bulk. It cannot be changed: a "
                       "scene's is that of its experiment, which `set` changes.")
      .def(py::init(&make_material),
           "Material(density=300.0): the keys of an experiment's `material`, but `fabric`. Raises "
           "ConfigError.")
      .def_readonly("density", &Material::density, "ρ [kg/m³]")
      .def_readonly("thickness", &Material::thickness, "d [m]")
      .def_readonly("membrane_modulus", &Material::membrane_modulus,
                    "E_mem [Pa]; not read beside warp_stiffness")
      .def_readonly("bending_modulus", &Material::bending_modulus,
                    "E_bend [Pa]; not read beside warp_bending")
      .def_readonly("poisson_ratio", &Material::poisson_ratio, "ν [1]")
      .def_readonly("warp_stiffness", &Material::warp_stiffness, "[N/m], or None")
      .def_readonly("weft_stiffness", &Material::weft_stiffness, "[N/m], or None")
      .def_readonly("shear_stiffness", &Material::shear_stiffness, "[N/m], or None")
      .def_readonly("warp_bending", &Material::warp_bending, "[N m], or None")
      .def_readonly("weft_bending", &Material::weft_bending, "[N m], or None")
      .def_readonly("bias_bending", &Material::bias_bending, "[N m], or None")
      .def_readonly("bending_hysteresis", &Material::bending_hysteresis, "2HB [N]")
      .def_property_readonly("mean_membrane_modulus", &Material::mean_membrane_modulus,
                             "Young's modulus of an isotropic membrane that stands for this material [Pa].")
      .def_property_readonly("mean_bending_modulus", &Material::mean_bending_modulus,
                             "The same of a plate [Pa].")
      .def_property_readonly("area_density", &Material::area_density, "Mass per area, ρ d [kg/m²].");

  py::class_<Level, std::shared_ptr<Level>>(
      m, "Level",
      "One resolution of the cloth: its rest shape and topology. Arrays are read-only views, which keep the "
      "level alive.")
      .def(py::init(&make_level), py::arg("rest"), py::arg("triangles"),
           "A level of n×3 rest positions [m] and m×3 vertex indices, counter-clockwise. Raises ValueError "
           "with every fault of the mesh.")
      .def_readonly("index", &Level::index, "0 is the coarsest.")
      .def_property_readonly("vertex_count", &Level::vertex_count)
      .def_property_readonly("triangle_count", &Level::triangle_count)
      .def_property_readonly(
          "rest", [](const Level& l) -> const Positions& { return l.rest.vertices; },
          "n×3 rest positions [m]; of a sewn cloth, where its pieces are placed in space.")
      .def_property_readonly(
          "rest_corners",
          [](const Level& l) {
            Eigen::Matrix<double, Eigen::Dynamic, 9, Eigen::RowMajor> corners(l.triangle_count(), 9);
            for (int t = 0; t < l.triangle_count(); ++t)
              corners.row(t) = rest_corners(l.rest, t).reshaped().transpose();
            return corners;
          },
          "m×9 corners of the triangles at rest, x, y, z of each [m]: in space or, of a sewn cloth, in its "
          "flat pieces, where z is 0. A copy.")
      .def_property_readonly(
          "triangles", [](const Level& l) -> const Triangles& { return l.rest.triangles; },
          "m×3 vertex indices.")
      .def_property_readonly(
          "edges", [](const Level& l) -> const auto& { return l.topology.edges; },
          "e×2 end vertices, the smaller index first.")
      .def_property_readonly(
          "triangle_edges", [](const Level& l) -> const Triangles& { return l.topology.triangle_edges; },
          "m×3 edge indices; column k is the edge opposite vertex k.")
      .def_property_readonly(
          "edge_triangles", [](const Level& l) -> const auto& { return l.topology.edge_triangles; },
          "e×2 triangles of each edge; -1 in column 1 on the border.")
      .def_readonly("hinges", &Level::hinges,
                    "h×4 stencils of the inner edges, their ends, then the vertices opposite.")
      .def_readonly("vertex_area", &Level::vertex_area, "n areas, a third of the adjacent rest areas [m²].");
}

py::dict evaluate_metric(const SceneHandle& s, const Text& name, int level, const State& state,
                         const std::optional<State>& other) {
  const LevelModel& model = *s.scene->models[s.checked(level)];
  const int n = model.level().vertex_count();
  const auto& all = s.experiment->metrics;
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& m) { return m.first == name; });
  if (found == all.end()) throw py::key_error("the experiment has no metric \"" + name + "\"");
  const MetricInput input{model.level(), model, state.of(n), other ? &other->of(n) : nullptr};
  MetricResult result = without_gil([&] { return found->second->evaluate(input); });
  py::dict values;
  for (const MetricValue& value : result.values) values[py::str(value.name)] = value.value;
  for (VertexField& field : result.fields) values[py::str(field.name)] = std::move(field.values);
  return values;
}

Positions prolonged(const SceneHandle& s, const Text& method, int level, const State& x) {
  const Hierarchy& all = s.scene->hierarchy;
  const int from = s.checked(level);
  return all.prolong(x.of(all.levels[from].vertex_count()), from, s.scene->finest(),
                     all.weights(s.experiment->solver_of(method).interpolation()));
}

std::string page(const SceneHandle& s, const State& state, int level) {
  const LevelModel& model = *s.scene->models[s.checked(level)];
  const Positions& x = state.of(model.level().vertex_count());
  return viewer_page(s.experiment->parameters.name, model.level(), x, model.obstacles(),
                     x.allFinite() ? model.contact_pressure(x) : Eigen::VectorXd());
}

}  // namespace

void bind_scene(py::module_& m) {
  bind_level(m);
  py::class_<SceneHandle>(m, "Scene",
                          "The levels, models and initial states of an experiment, at its start. scene[l] is "
                          "the model of level l; negative indices count from the finest.")
      .def("__len__", [](const SceneHandle& s) { return s.scene->models.size(); })
      .def("__getitem__", &SceneHandle::model, whole("level"))
      .def_property_readonly("levels",
                             [](const SceneHandle& s) {
                               std::vector<std::shared_ptr<Level>> all;
                               for (const Level& level : s.scene->hierarchy.levels)
                                 all.push_back(level_of(s.scene, level));
                               return all;
                             })
      .def(
          "start",
          [](const SceneHandle& s, int level) -> const Positions& {
            return s.scene->starts[s.checked(level)];
          },
          py::return_value_policy::reference_internal, whole("level"),
          "The initial state of a level, n×3 [m], read-only.")
      .def_property_readonly(
          "prolongations", [](const SceneHandle& s) { return read_only(s.scene->hierarchy.prolongations); },
          "n_{l+1}×n_l weights of the refiner from level l to the next, scipy.sparse.csr_matrix, read-only. "
          "Previews are measured by `prolong`.")
      .def_property_readonly(
          "midpoints", [](const SceneHandle& s) { return read_only(s.scene->hierarchy.midpoints); },
          "Likewise the weights of the midpoint split, which does not move the surface.")
      .def_property_readonly(
          "linear", [](const SceneHandle& s) { return read_only(s.scene->hierarchy.linear); },
          "Likewise linear interpolation over the coarse rest shape.")
      .def("prolong", &prolonged, py::arg("method"), whole("level"), py::arg("x"),
           "A method's state x (n×3) [m] of a level on the finest one, by the method's own interpolation: so "
           "its previews are measured and shown.")
      .def_property_readonly("metrics",
                             [](const SceneHandle& s) {
                               std::vector<std::string> names;
                               for (const auto& [name, metric] : s.experiment->metrics) names.push_back(name);
                               return names;
                             })
      .def("metric", &evaluate_metric, py::arg("name"), whole("level"), py::arg("x"),
           py::arg("other") = py::none(),
           "Values and fields of one of the experiment's metrics by name. x is n×3 [m]; `other`, the "
           "prolonged coarse state, is of pair metrics.")
      .def("_page", &page, py::arg("x"), whole("level"));
}

}  // namespace drape::python

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include "core/app/python/arrays.h"
#include "core/app/python/module.h"
#include "core/app/python/scene_handle.h"
#include "core/app/report/report.h"

namespace drape::python {

namespace {

py::dict evaluate_metric(const SceneHandle& s, const std::string& name, int level, const py::object& state,
                         const py::object& coarse) {
  const int l = s.checked(level), n = s.level(l).level->vertex_count();
  const auto& all = s.experiment->metrics;
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& m) { return m.first == name; });
  if (found == all.end()) throw py::key_error("the experiment has no metric \"" + name + "\"");
  const Positions x = positions_of(state, n, "x");
  Positions other;
  if (!coarse.is_none()) other = positions_of(coarse, n, "other");
  MetricResult result;
  {
    const py::gil_scoped_release released;
    result = found->second->evaluate(
        {s.scene->hierarchy.levels[l], *s.scene->models[l], x, coarse.is_none() ? nullptr : &other});
  }
  py::dict values;
  for (const MetricValue& value : result.values) values[py::str(value.name)] = value.value;
  for (MetricField& field : result.fields) values[py::str(field.name)] = array_of(std::move(field.values));
  return values;
}

std::string page(const SceneHandle& s, const py::object& state, int level) {
  const int l = s.checked(level);
  const Positions x = positions_of(state, s.level(l).level->vertex_count(), "x");
  return viewer_page(s.experiment->parameters.name, s.scene->hierarchy.levels[l], x,
                     obstacles_of(s.scene->models[l]->contacts()));
}

}  // namespace

void bind_scene(py::module_& m) {
  using Matrices = std::vector<ProlongationMatrix>;
  py::class_<SceneHandle>(m, "Scene",
                          "The levels, models and initial states of an experiment, at its start. scene[l] is "
                          "the model of level l; negative indices count from the finest.")
      .def("__len__", [](const SceneHandle& s) { return s.scene->models.size(); })
      .def("__getitem__", &SceneHandle::model, py::arg("level"))
      .def_property_readonly("levels",
                             [](const SceneHandle& s) {
                               std::vector<LevelHandle> all;
                               for (int l = 0; l < s.scene->hierarchy.level_count(); ++l)
                                 all.push_back(s.level(l));
                               return all;
                             })
      .def(
          "start",
          [](const SceneHandle& s, int level) { return view(s.scene->starts[s.checked(level)], s.scene); },
          py::arg("level"), "The initial state of a level, n×3 [m], read-only.")
      .def_property_readonly(
          "prolongations",
          [](const SceneHandle& s) -> const Matrices& { return s.scene->hierarchy.prolongations; },
          "[l]: n_{l+1}×n_l weights of the refiner, scipy.sparse.csr_matrix.")
      .def_property_readonly(
          "midpoints", [](const SceneHandle& s) -> const Matrices& { return s.scene->hierarchy.midpoints; },
          "[l]: weights of the midpoint split, which does not move the surface.")
      .def_property_readonly(
          "linear", [](const SceneHandle& s) -> const Matrices& { return s.scene->hierarchy.linear; },
          "[l]: linear interpolation over the coarse rest shape.")
      .def_property_readonly("metrics",
                             [](const SceneHandle& s) {
                               std::vector<std::string> names;
                               for (const auto& [name, metric] : s.experiment->metrics) names.push_back(name);
                               return names;
                             })
      .def("metric", &evaluate_metric, py::arg("name"), py::arg("level"), py::arg("x"),
           py::arg("other") = py::none(),
           "Values and fields of one of the experiment's metrics by name. x is n×3 [m]; `other`, the "
           "prolonged "
           "coarse state, is of pair metrics.")
      .def("page", &page, py::arg("x"), py::arg("level") = -1,
           "An HTML page with the 3D viewer of the state x (n×3) [m] and the obstacles.");
}

}  // namespace drape::python

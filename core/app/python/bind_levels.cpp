#include "core/app/python/arrays.h"
#include "core/app/python/level_handle.h"
#include "core/app/python/module.h"
#include "core/numerics/mesh/check.h"

namespace drape::python {

void bind_levels(py::module_& m) {
  py::class_<Material>(m, "Material", "An isotropic cloth material. Moduli are Young's moduli of the bulk.")
      .def(py::init<>())
      .def_readwrite("density", &Material::density, "ρ [kg/m³]")
      .def_readwrite("thickness", &Material::thickness, "d [m]")
      .def_readwrite("membrane_modulus", &Material::membrane_modulus, "E_mem [Pa]")
      .def_readwrite("bending_modulus", &Material::bending_modulus, "E_bend [Pa]")
      .def_readwrite("poisson_ratio", &Material::poisson_ratio, "ν [1]")
      .def_property_readonly("area_density", &Material::area_density, "Mass per area, ρ d [kg/m²].");

  py::class_<LevelHandle>(
      m, "Level",
      "One resolution of the cloth: its rest shape and topology. Arrays are read-only views, which keep the "
      "level alive.")
      .def(py::init([](const py::handle& rest, const py::handle& triangles) {
             TriangleMesh mesh{positions_of(rest, -1, "rest"), {}};
             const auto corners = integer_array(triangles, "triangles");
             if (corners.ndim() != 2 || corners.shape(1) != 3)
               throw py::value_error("triangles must have the shape (m, 3), not " + shape_text(corners));
             mesh.triangles = Eigen::Map<const Triangles>(corners.data(), corners.shape(0), 3);
             std::string faults;
             for (const std::string& fault : check_mesh(mesh)) faults += (faults.empty() ? "" : "\n") + fault;
             if (!faults.empty()) throw py::value_error(faults);
             return LevelHandle{std::make_shared<const Level>(Level::of(0, std::move(mesh)))};
           }),
           py::arg("rest"), py::arg("triangles"),
           "A level of n×3 rest positions [m] and m×3 vertex indices, counter-clockwise. Raises ValueError "
           "with every fault of the mesh.")
      .def_property_readonly(
          "index", [](const LevelHandle& l) { return l.level->index; }, "0 is the coarsest.")
      .def_property_readonly("vertex_count", [](const LevelHandle& l) { return l.level->vertex_count(); })
      .def_property_readonly("triangle_count", [](const LevelHandle& l) { return l.level->triangle_count(); })
      .def_property_readonly(
          "rest", [](const LevelHandle& l) { return view(l.level->rest.vertices, l.level); },
          "n×3 rest positions [m].")
      .def_property_readonly(
          "triangles", [](const LevelHandle& l) { return view(l.level->rest.triangles, l.level); },
          "m×3 vertex indices.")
      .def_property_readonly(
          "edges", [](const LevelHandle& l) { return view(l.level->topology.edges, l.level); },
          "e×2 end vertices, the smaller index first.")
      .def_property_readonly(
          "triangle_edges",
          [](const LevelHandle& l) { return view(l.level->topology.triangle_edges, l.level); },
          "m×3 edge indices; column k is the edge opposite vertex k.")
      .def_property_readonly(
          "edge_triangles",
          [](const LevelHandle& l) { return view(l.level->topology.edge_triangles, l.level); },
          "e×2 triangles of each edge; -1 in column 1 on the border.")
      .def_property_readonly(
          "hinges", [](const LevelHandle& l) { return view(l.level->hinges, l.level); },
          "h×4 stencils of the inner edges: edge ends, then the vertices opposite.")
      .def_property_readonly(
          "vertex_area", [](const LevelHandle& l) { return view(l.level->vertex_area, l.level); },
          "n areas, a third of the adjacent rest areas [m²].");
}

}  // namespace drape::python

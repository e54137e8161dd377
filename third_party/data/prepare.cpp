// Makes an obstacle of a scanned mesh: closed, few triangles, no self-intersections (exact predicates),
// metres.
//
//   drape_prepare_mesh IN OUT FACES HEIGHT UP_X UP_Y UP_Z ALPHA OFFSET
//
// IN any mesh that CGAL reads; OUT a binary PLY, standing on z = 0 with its bounding box's centre above the
// origin. FACES to leave; HEIGHT of the bounding box [m]; UP the direction in IN that becomes +z, IN's x axis
// staying in front; ALPHA, OFFSET of CGAL's alpha wrapping as fractions of IN's bounding-box diagonal, 0 0
// for none. Prints counts as the inside of a JSON object. CGAL's algorithms: Surface_mesh_simplification with
// probabilistic plane quadrics (Trettner and Kobbelt 2020), alpha_wrap_3 (Portaneri et al. 2022).
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/bbox.h>
#include <CGAL/Polygon_mesh_processing/connected_components.h>
#include <CGAL/Polygon_mesh_processing/orientation.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh/IO/PLY.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Bounded_normal_change_filter.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/Count_stop_predicate.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_probabilistic_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <CGAL/boost/graph/IO/polygon_mesh_io.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/numerics/mesh/repair.h"

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Vector = Kernel::Vector_3;
using Mesh = CGAL::Surface_mesh<Point>;
namespace pmp = CGAL::Polygon_mesh_processing;
namespace sms = CGAL::Surface_mesh_simplification;

double diagonal(const Mesh& mesh) {
  const CGAL::Bbox_3 box = pmp::bbox(mesh);
  return std::sqrt(std::pow(box.x_span(), 2) + std::pow(box.y_span(), 2) + std::pow(box.z_span(), 2));
}

std::size_t self_intersections(const Mesh& mesh) {
  std::vector<std::pair<Mesh::Face_index, Mesh::Face_index>> pairs;
  pmp::self_intersections(mesh, std::back_inserter(pairs));
  return pairs.size();
}

Mesh wrap(const Mesh& mesh, double alpha, double offset) {
  drape::TriangleMesh surface;
  surface.vertices.resize(static_cast<Eigen::Index>(mesh.number_of_vertices()), 3);
  for (const Mesh::Vertex_index v : mesh.vertices())
    surface.vertices.row(v.idx()) << mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z();
  surface.triangles.resize(static_cast<Eigen::Index>(mesh.number_of_faces()), 3);
  for (const Mesh::Face_index f : mesh.faces()) {
    const Mesh::Halfedge_index h = mesh.halfedge(f);
    surface.triangles.row(f.idx()) << static_cast<int>(mesh.source(h)), static_cast<int>(mesh.target(h)),
        static_cast<int>(mesh.target(mesh.next(h)));
  }
  const drape::TriangleMesh wrapped = drape::alpha_wrap(surface, alpha, offset);
  Mesh result;
  for (const auto& x : wrapped.vertices.rowwise()) result.add_vertex({x[0], x[1], x[2]});
  for (const auto& t : wrapped.triangles.rowwise())
    result.add_face(Mesh::Vertex_index(t[0]), Mesh::Vertex_index(t[1]), Mesh::Vertex_index(t[2]));
  return result;
}

void decimate(Mesh& mesh, int faces) {
  using Policies = sms::GarlandHeckbert_probabilistic_plane_policies<Mesh, Kernel>;
  const Policies policies(mesh);
  const sms::Bounded_normal_change_filter<> keeps_normals;
  const std::size_t edges = static_cast<std::size_t>(faces) * 3 / 2 + 1;  // collapses while there are as many
  sms::edge_collapse(mesh, sms::Count_stop_predicate<Mesh>(edges),
                     CGAL::parameters::get_cost(policies.get_cost())
                         .get_placement(policies.get_placement())
                         .filter(keeps_normals));
  mesh.collect_garbage();
}

void place(Mesh& mesh, Vector up, double height) {
  const auto unit = [](const Vector& v) { return v / std::sqrt(v.squared_length()); };
  up = unit(up);
  const Vector back = unit(CGAL::cross_product(up, Vector(1, 0, 0))), right = CGAL::cross_product(back, up);
  for (const Mesh::Vertex_index v : mesh.vertices()) {
    const Vector p = mesh.point(v) - CGAL::ORIGIN;
    mesh.point(v) = Point(right * p, back * p, up * p);
  }
  const CGAL::Bbox_3 box = pmp::bbox(mesh);
  const double scale = height / box.z_span();
  const Vector base((box.xmin() + box.xmax()) / 2, (box.ymin() + box.ymax()) / 2, box.zmin());
  for (const Mesh::Vertex_index v : mesh.vertices())
    mesh.point(v) = CGAL::ORIGIN + scale * (mesh.point(v) - CGAL::ORIGIN - base);
}

Mesh read(const std::string& path) {
  Mesh mesh;
  if (!CGAL::IO::read_polygon_mesh(path, mesh) || !CGAL::is_triangle_mesh(mesh))
    throw std::runtime_error("not a readable manifold triangle mesh");
  return mesh;
}

void require(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error(what);
}

void write(const std::string& path, const Mesh& mesh) {
  std::ofstream file(path, std::ios::binary);
  CGAL::IO::set_binary_mode(file);
  require(file && CGAL::IO::write_PLY(file, mesh) && file.flush(), "cannot be written: " + path);
}

void prepare(char** words) {
  const auto number = [&](int i) { return std::stod(words[i]); };
  require(std::stoi(words[3]) >= 4 && number(4) > 0, "needs FACES of at least 4 and a HEIGHT above 0");
  require(std::hypot(number(6), number(7)) > 1e-9 * std::abs(number(5)),
          "cannot stand on its x axis: UP needs a y or z");
  Mesh mesh = read(words[1]);
  std::cout << "\"input_vertices\": " << mesh.number_of_vertices()
            << ", \"input_faces\": " << mesh.number_of_faces();
  if (const double alpha = number(8); alpha > 0) {
    const double size = diagonal(mesh);
    mesh = wrap(mesh, alpha * size, number(9) * size);
    std::cout << ", \"wrapped_faces\": " << mesh.number_of_faces();
  }
  require(CGAL::is_closed(mesh), "has a border: give ALPHA and OFFSET, so that it is wrapped");
  decimate(mesh, std::stoi(words[3]));
  place(mesh, {number(5), number(6), number(7)}, number(4));

  require(CGAL::is_closed(mesh) && CGAL::is_valid_polygon_mesh(mesh), "is not closed after decimation");
  if (const std::size_t pairs = self_intersections(mesh))
    throw std::runtime_error(std::to_string(pairs) +
                             " pairs of triangles intersect after decimation: take other FACES, or wrap");
  require(pmp::is_outward_oriented(mesh), "is turned inside out");
  auto component = mesh.add_property_map<Mesh::Face_index, std::size_t>("f:component").first;
  const std::size_t components = pmp::connected_components(mesh, component);
  mesh.remove_property_map(component);
  const CGAL::Bbox_3 box = pmp::bbox(mesh);
  std::cout << ", \"vertices\": " << mesh.number_of_vertices() << ", \"faces\": " << mesh.number_of_faces()
            << ", \"components\": " << components << ", \"euler_characteristic\": "
            << static_cast<long>(mesh.number_of_vertices()) - static_cast<long>(mesh.number_of_edges()) +
                   static_cast<long>(mesh.number_of_faces())
            << ", \"self_intersections\": 0, \"size\": [" << box.x_span() << ", " << box.y_span() << ", "
            << box.z_span() << "]\n";
  write(words[2], mesh);
}

}  // namespace

int main(int count, char** words) {
  if (count != 10) {
    std::cerr << "usage: drape_prepare_mesh IN OUT FACES HEIGHT UP_X UP_Y UP_Z ALPHA OFFSET\n";
    return 2;
  }
  try {
    prepare(words);
  } catch (const std::exception& error) {
    std::cerr << words[1] << ": " << error.what() << '\n';
    return 1;
  }
  return 0;
}

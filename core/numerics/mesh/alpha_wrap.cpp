#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/alpha_wrap_3.h>

#include <array>
#include <cstddef>
#include <vector>

#include "core/numerics/mesh/repair.h"

namespace drape {

TriangleMesh alpha_wrap(const TriangleMesh& mesh, double alpha, double offset) {
  using Point3 = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  std::vector<Point3> points;
  for (const auto& x : mesh.vertices.rowwise()) points.emplace_back(x[0], x[1], x[2]);
  std::vector<std::array<std::size_t, 3>> triangles;
  for (const auto& t : mesh.triangles.rowwise())
    triangles.push_back(
        {static_cast<std::size_t>(t[0]), static_cast<std::size_t>(t[1]), static_cast<std::size_t>(t[2])});
  CGAL::Surface_mesh<Point3> surface;
  CGAL::alpha_wrap_3(points, triangles, alpha, offset, surface);
  surface.collect_garbage();  // elements that were removed on the way are still stored

  TriangleMesh wrap;
  wrap.vertices.resize(static_cast<Eigen::Index>(surface.number_of_vertices()), 3);
  for (const auto v : surface.vertices()) {
    const Point3& p = surface.point(v);
    wrap.vertices.row(static_cast<Eigen::Index>(v.idx())) << p.x(), p.y(), p.z();
  }
  wrap.triangles.resize(static_cast<Eigen::Index>(surface.number_of_faces()), 3);
  Eigen::Index row = 0;
  for (const auto f : surface.faces()) {
    int k = 0;
    for (const auto v : surface.vertices_around_face(surface.halfedge(f)))
      wrap.triangles(row, k++) = static_cast<int>(v.idx());
    ++row;
  }
  return wrap;
}

}  // namespace drape

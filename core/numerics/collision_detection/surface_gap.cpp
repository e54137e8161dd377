#include "core/numerics/collision_detection/surface_gap.h"

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>

#include <Eigen/Geometry>
#include <limits>
#include <vector>

namespace drape {
namespace {

using Plain = CGAL::Simple_cartesian<double>;
using PlainTriangles = std::vector<Plain::Triangle_3>;
using PlainTree = CGAL::AABB_tree<
    CGAL::AABB_traits<Plain, CGAL::AABB_triangle_primitive<Plain, PlainTriangles::const_iterator>>>;

/// The shortest vector to a vertex of `from` from the surface of `to`; `shortest` if none is shorter.
Eigen::Vector3d from_vertices(const TriangleMesh& from, const TriangleMesh& to, Eigen::Vector3d shortest) {
  const auto point = [](const Positions& x, Eigen::Index i) {
    return Plain::Point_3(x(i, 0), x(i, 1), x(i, 2));
  };
  PlainTriangles triangles;
  for (const auto& t : to.triangles.rowwise())
    triangles.emplace_back(point(to.vertices, t[0]), point(to.vertices, t[1]), point(to.vertices, t[2]));
  PlainTree tree(triangles.begin(), triangles.end());
  const Eigen::AlignedBox3d box(to.vertices.colwise().minCoeff().transpose(),
                                to.vertices.colwise().maxCoeff().transpose());
  for (Eigen::Index i = 0; i < from.vertices.rows(); ++i) {
    if (box.squaredExteriorDistance(from.vertices.row(i).transpose()) >= shortest.squaredNorm()) continue;
    const Plain::Point_3 p = point(from.vertices, i);
    const Plain::Vector_3 v = p - tree.closest_point(p);
    const Eigen::Vector3d connection(v.x(), v.y(), v.z());
    if (connection.squaredNorm() < shortest.squaredNorm()) shortest = connection;
  }
  return shortest;
}

}  // namespace

Eigen::Vector3d shortest_connection(const TriangleMesh& mesh, const TriangleMesh& other) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d there = from_vertices(mesh, other, Eigen::Vector3d::Constant(infinity));
  return -from_vertices(other, mesh, -there);
}

}  // namespace drape

#include "core/kernel/interfaces/level.h"

#include <Eigen/Geometry>
#include <utility>

namespace drape {

Level Level::of(int index, TriangleMesh rest) {
  Level level;
  level.index = index;
  level.rest = std::move(rest);
  level.topology = Topology::of(level.rest.triangles, level.vertex_count());

  level.vertex_area = Eigen::VectorXd::Zero(level.vertex_count());
  for (int t = 0; t < level.triangle_count(); ++t) {
    const auto v = level.rest.triangles.row(t);
    const Eigen::Vector3d a = level.rest.vertices.row(v[0]);
    const Eigen::Vector3d b = level.rest.vertices.row(v[1]);
    const Eigen::Vector3d c = level.rest.vertices.row(v[2]);
    const double third = (b - a).cross(c - a).norm() / 6;
    for (int k = 0; k < 3; ++k) level.vertex_area[v[k]] += third;
  }
  level.hinges = level.topology.hinges(level.rest.triangles);
  level.triangle_order = ElementOrder::of(level.rest.triangles, level.rest.vertices);
  level.hinge_order = ElementOrder::of(level.hinges, level.rest.vertices);
  return level;
}

}  // namespace drape

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
    const Eigen::Matrix3d c = rest_corners(level.rest, t);
    const double third = (c.col(1) - c.col(0)).cross(c.col(2) - c.col(0)).norm() / 6;
    for (int k = 0; k < 3; ++k) level.vertex_area[level.rest.triangles(t, k)] += third;
  }
  level.hinges = level.topology.hinges(level.rest.triangles);
  for (int e = 0; e < level.topology.edges.rows(); ++e)
    if (level.topology.edge_triangles(e, 1) != -1) level.hinge_edges.push_back(e);
  level.triangle_order = ElementOrder::of(level.rest.triangles, level.rest.vertices);
  level.hinge_order = ElementOrder::of(level.hinges, level.rest.vertices);
  return level;
}

}  // namespace drape

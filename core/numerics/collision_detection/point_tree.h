#pragma once

#include "core/kernel/interfaces/triangle_mesh.h"
#include "core/numerics/collision_detection/box_tree.h"

namespace drape {

/// Points to search, with a tree of boxes if many searches follow. The points must outlive it.
struct PointTree {
  const Positions& points;
  BoxTree boxes;  ///< without boxes if a tree does not pay

  PointTree(const Positions& all, std::size_t searches) : points(all) {
    constexpr std::size_t few = 16;
    if (searches <= few) return;
    std::vector<Box> around;
    for (const auto& p : points.rowwise()) around.push_back(Box::around(p, p, 0));
    boxes.build(around);
  }

  /// The row of the point nearest to p; of equally near ones the first.
  int nearest(const Eigen::Vector3d& p) const {
    std::pair<double, int> least(INFINITY, 0);
    const auto visit = [&](int v) {
      least = std::min(least, {(points.row(v) - p.transpose()).squaredNorm(), v});
      return least.first * (1 + 1e-6);  // over round-off
    };
    const auto distance = [at = Box::around(p, p, 0)](const Box& box) { return box.squared_distance(at); };
    if (boxes.size() > 0) boxes.visit_near(INFINITY, distance, visit);
    for (int v = 0; boxes.size() == 0 && v < points.rows(); ++v) visit(v);
    return least.second;
  }
};

}  // namespace drape

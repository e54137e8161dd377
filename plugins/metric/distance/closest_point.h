#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace drape {

/// Squared distance [m²] from a point to a triangle (a, b, c), which may be degenerate.
double squared_point_triangle_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                       const Eigen::Vector3d& b, const Eigen::Vector3d& c);

/// Distances to a triangle surface, by a tree of bounding boxes. Keeps references to `x` and `triangles`.
class SurfaceDistance {
 public:
  SurfaceDistance(const Positions& x, const Triangles& triangles);

  /// Squared distance [m²] from p to the surface if it is below `bound`, else `bound`. Thread-safe.
  double squared(const Eigen::Vector3d& p, double bound) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    int begin, end;  // of order_
    int right;       // the second child, 0 for a leaf; the first follows its parent
  };

  int build(int begin, int end, const Positions& centres);

  const Positions& x_;
  const Triangles& triangles_;
  std::vector<int> order_;
  std::vector<Node> nodes_;
};

}  // namespace drape

#pragma once

#include <Eigen/Core>

namespace drape {

/// The shortest connection of two primitives as a combination of their vertices: r = Σ c_k x_k, with
/// |r| the distance. `c` depends on the positions; how it would change along the parameters that are
/// not held at an end is what second derivatives need.
struct Closest {
  using Directions = Eigen::Matrix<double, 4, 2, Eigen::DontAlign>;  // aligned, padding would be a third
  Eigen::Vector4d c = Eigen::Vector4d::Zero();                       ///< of the stencil's vertices
  Directions direction = Directions::Zero();                         ///< ∂c/∂t of the free ones
  int free = 0;                                                      ///< 0, 1 or 2 free parameters
};

/// Point x0 against triangle (x1, x2, x3); c_0 = 1, the rest are minus barycentric coordinates.
/// A triangle without area is its longest edge.
Closest closest_point_triangle(const Eigen::Vector3d& x0, const Eigen::Vector3d& x1,
                               const Eigen::Vector3d& x2, const Eigen::Vector3d& x3);
/// Edge (x0, x1) against edge (x2, x3); c_0 + c_1 = 1, c_2 + c_3 = -1.
Closest closest_edge_edge(const Eigen::Vector3d& x0, const Eigen::Vector3d& x1, const Eigen::Vector3d& x2,
                          const Eigen::Vector3d& x3);
/// Point x0 against the whole plane of (x1, x2, x3).
Closest closest_point_plane(const Eigen::Vector3d& x0, const Eigen::Vector3d& x1, const Eigen::Vector3d& x2,
                            const Eigen::Vector3d& x3);

}  // namespace drape

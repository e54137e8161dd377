#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace drape {

/// The shortest vector between two primitives as a combination of their vertices: r = Σ c_k x_k, with |r| the
/// distance. Second derivatives also need how c changes along the parameters that are not clamped to an end.
struct Closest {
  using Directions = Eigen::Matrix<double, 4, 2, Eigen::DontAlign>;  // unaligned saves a third of the memory
  Eigen::Vector4d c = Eigen::Vector4d::Zero();  ///< coefficients of the stencil's vertices
  Directions direction = Directions::Zero();    ///< ∂c/∂t of the free parameters
  int free = 0;                                 ///< number of free parameters, 0 to 2
};

/// The parameter in [0, 1] of the point nearest to p on the segment from the origin to u; 0 for a segment
/// without length.
inline double nearest_on_segment(const Eigen::Vector3d& u, const Eigen::Vector3d& p) {
  const double square = u.squaredNorm();
  return square > 0 ? std::clamp(p.dot(u) / square, 0.0, 1.0) : 0.0;
}

/// Point x0 against triangle (x1, x2, x3): c_0 = 1, c_1 to c_3 are minus the barycentric coordinates. A
/// triangle without area counts as its longest edge.
Closest closest_point_triangle(const Eigen::Vector3d& x0, const Eigen::Vector3d& x1,
                               const Eigen::Vector3d& x2, const Eigen::Vector3d& x3);
/// Edge (x0, x1) against edge (x2, x3): c_0 + c_1 = 1, c_2 + c_3 = -1.
Closest closest_edge_edge(const Eigen::Vector3d& x0, const Eigen::Vector3d& x1, const Eigen::Vector3d& x2,
                          const Eigen::Vector3d& x3);
/// The end x0 of an edge (x0, x1) against edge (x2, x3): c_0 = 1, c_1 = 0, c_2 + c_3 = -1.
inline Closest closest_edge_end(const Eigen::Vector3d& x0, const Eigen::Vector3d& x2,
                                const Eigen::Vector3d& x3) {
  const double t = nearest_on_segment(x3 - x2, x0 - x2);
  Closest closest;
  closest.c << 1, 0, t - 1, -t;
  if (t > 0 && t < 1) {
    closest.direction.col(0) << 0, 0, 1, -1;
    closest.free = 1;
  }
  return closest;
}

}  // namespace drape

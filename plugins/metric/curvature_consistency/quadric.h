#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <cmath>
#include <vector>

namespace drape {

using Vector5d = Eigen::Matrix<double, 5, 1>;
using Matrix5d = Eigen::Matrix<double, 5, 5>;

/// Mean, Gaussian and principal curvatures at one point, κ1 ≥ κ2, in units of one over the length.
struct PointCurvatures {
  double mean, gaussian, kappa1, kappa2;
};

/// Least squares for (a, b, c, d, e) over offsets (u, v, z); the least-norm one where they leave it open.
inline Vector5d fit_quadric(const std::vector<Eigen::Vector3d>& offsets) {
  Matrix5d normal_matrix = Matrix5d::Zero();
  Vector5d right_side = Vector5d::Zero();
  for (const Eigen::Vector3d& p : offsets) {
    const Vector5d row(p.x() * p.x(), p.x() * p.y(), p.y() * p.y(), p.x(), p.y());
    normal_matrix += row * row.transpose();
    right_side += p.z() * row;
  }
  Eigen::CompleteOrthogonalDecomposition<Matrix5d> solver;
  solver.setThreshold(1e-12);
  return solver.compute(normal_matrix).solve(right_side);
}

/// Curvatures at the origin of the quadric's graph, positive where it bends away from +z.
inline PointCurvatures quadric_curvatures(const Vector5d& q) {
  // S = L⁻¹ II L⁻ᵀ with the first fundamental form I = L Lᵀ: symmetric, the eigenvalues of I⁻¹ II.
  const double d = q[3], e = q[4];
  const double stretch = std::sqrt(1 + d * d), normal_length = std::sqrt(1 + d * d + e * e);
  const double l11 = stretch, l21 = d * e / stretch, l22 = normal_length / stretch;
  const double ii11 = -2 * q[0] / normal_length, ii12 = -q[1] / normal_length,
               ii22 = -2 * q[2] / normal_length;
  const double s11 = ii11 / (l11 * l11);
  const double s12 = (ii12 / l11 - l21 * s11) / l22;
  const double s22 = (ii22 - 2 * l21 * ii12 / l11 + l21 * l21 * s11) / (l22 * l22);
  const double mean = 0.5 * (s11 + s22), radius = std::hypot(0.5 * (s11 - s22), s12);
  return {mean, s11 * s22 - s12 * s12, mean + radius, mean - radius};
}

}  // namespace drape

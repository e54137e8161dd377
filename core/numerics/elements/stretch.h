#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/kernel/interfaces/level.h"
#include "core/numerics/linear_algebra/pack.h"

namespace drape {

/// Principal stretches σ₁ ≥ σ₂ of a triangle's deformation gradient F (3×2), and their directions. T is
/// double or a Pack.
template <class T>
struct PrincipalStretch {
  using Vector = Eigen::Matrix<T, 3, 1>;
  T largest, smallest;  ///< σ₁, σ₂ to a few ulp, also if equal; σ₂ = 0 for a collapsed triangle
  T cosine, sine;       ///< v₁ = (cosine, sine), v₂ = (-sine, cosine); any v₁ if σ₁ = σ₂
  Vector w1, w2;        ///< F v₁ and F v₂, of length σ₁ and σ₂ and orthogonal

  /// From the columns of F.
  PrincipalStretch(const Vector& f1, const Vector& f2) {
    using std::abs, std::max, std::sqrt;
    constexpr double tiny = 1e-150;
    // σ₁ + σ₂ and σ₁ - σ₂ come without cancellation from σ₁σ₂ = |f₁ × f₂| and C = FᵀF.
    const T product = sqrt(f1.cross(f2).squaredNorm());
    const T c11 = f1.squaredNorm(), c22 = f2.squaredNorm(), twice_c12 = 2.0 * f1.dot(f2);
    const T split = c11 - c22, hypotenuse = sqrt(split * split + twice_c12 * twice_c12);  // σ₁² - σ₂²
    const T sum = sqrt(c11 + c22 + 2.0 * product);
    largest = 0.5 * (sum + hypotenuse / max(sum, T(tiny)));
    smallest = product / max(largest, T(tiny));
    // v₁ is at half the angle of (split, twice_c12).
    const auto round = hypotenuse < tiny;
    const T safe = select(round, T(1.0), hypotenuse);
    const T cosine2 = select(round, T(1.0), split / safe), sine2 = select(round, T(0.0), twice_c12 / safe);
    const T more = sqrt(0.5 * (1.0 + abs(cosine2))), less = 0.5 * sine2 / more;
    const auto flat = cosine2 >= 0.0;
    cosine = select(flat, more, less);
    sine = select(flat, less, more);
    w1 = f1 * cosine + f2 * sine;
    w2 = f2 * cosine - f1 * sine;
  }
};

/// Deformation gradient of a triangle: F = [a e₁, b e₁ + c e₂] (3×2), e₁ = x₁ - x₀, e₂ = x₂ - x₀.
struct RestTriangle {
  double a, b, c;  ///< inverse rest edges in the triangle's own plane [1/m]
  double area;     ///< [m²]; of a level's triangle, times its softening

  /// From the rest edge vectors [m]; not finite if they span no area.
  static RestTriangle of(const Eigen::Vector3d& e1, const Eigen::Vector3d& e2) {
    // Edges in the plane: e₁ = (p, 0), e₂ = (q, h).
    const double p = e1.norm(), q = e2.dot(e1) / p, h = e1.cross(e2).norm() / p;
    return {1 / p, -q / (p * h), 1 / h, p * h / 2};
  }
  /// Triangle t of the level. Throws std::runtime_error if it has no area.
  static RestTriangle of(const Level& level, int t);

  /// Stretches of the triangle with these edge vectors [m].
  PrincipalStretch<double> stretch(const Eigen::Vector3d& e1, const Eigen::Vector3d& e2) const {
    return {a * e1, b * e1 + c * e2};
  }
};

}  // namespace drape

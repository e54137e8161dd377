#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <vector>

#include "core/kernel/interfaces/level.h"
#include "core/numerics/elements/jet_functions.h"

namespace drape {

/// A triangle at rest, in the material's frame: F = [m₀ e₁ + m₁ e₂, m₂ e₁ + m₃ e₂], with m [1/m], the area
/// [m²] and the rest position of the centroid [m], in its piece where the cloth is sewn.
using MaterialTriangle = Eigen::Matrix<double, 8, 1>;

/// The triangles of the level; the material's first axis is warp (warp_directions). Throws std::runtime_error
/// for one without area.
std::vector<MaterialTriangle> material_triangles(const Level& level);

/// Columns of the deformation gradient F, and the Green strains G = (FᵀF - I)/2. T is double or a Pack.
template <class T>
struct GreenStrain {
  using Vector = Eigen::Matrix<T, 3, 1>;
  Vector f1, f2;
  T g11, g22, g12;  ///< these keep the digits of small strains

  /// From the edges and MaterialTriangle's numbers.
  GreenStrain(const Vector* e, const T* m) {
    for (int c = 0; c < 3; ++c) {
      f1[c] = e[0][c] * m[0] + e[1][c] * m[1];
      f2[c] = e[0][c] * m[2] + e[1][c] * m[3];
    }
    g11 = 0.5 * (f1.squaredNorm() - 1.0);
    g22 = 0.5 * (f2.squaredNorm() - 1.0);
    g12 = 0.5 * f1.dot(f2);
  }
  /// det FᵀF.
  T det() const { return f1.cross(f2).squaredNorm(); }
};

/// J = √det C of a formula. Its log() has the digits of the strains, of which J itself has lost those of
/// small ones. S is a Jet.
template <class S>
struct AreaRatio : S {
  S logarithm;
  friend S log(const AreaRatio& j) { return j.logarithm; }
  friend S square(const AreaRatio& j) { return static_cast<const S&>(j) * static_cast<const S&>(j); }
};

/// From the strains, which are the first three of the N variables (none, for a value, if there are fewer),
/// and det C.
template <int N, class T>
AreaRatio<Jet<N, T>> area_ratio(const T& g11, const T& g22, const T& g12, const T& det_c) {
  using std::log, std::min;
  Jet<N, T> det(det_c);
  if constexpr (N >= 3) {
    det.first[0] = 2.0 * (1.0 + 2.0 * g22);
    det.first[1] = 2.0 * (1.0 + 2.0 * g11);
    det.first[2] = -8.0 * g12;
    det.second[det.index(0, 1)] = 4.0;
    det.second[det.index(2, 2)] = -8.0;
  }
  // det C - 1 to first order near 1, where det C itself has lost digits.
  const T inverse = 1.0 / det_c, minus_1 = 2.0 * (g11 + g22) + 4.0 * (g11 * g22 - g12 * g12),
          lost = minus_1 - (det_c - 1.0);
  const T logarithm = 0.5 * (log(det_c) + lost * min(det_c, inverse));
  return {sqrt(det), chain(det, logarithm, 0.5 * inverse, -0.5 * (inverse * inverse))};
}

/// Derivatives by a triangle's edges of an energy W of its Green strains. With W_a = ∂W/∂g_a and the columns
/// f₁, f₂ of F, the stress by them is p₁ = W₁₁ f₁ + ½ W₁₂ f₂, p₂ = W₂₂ f₂ + ½ W₁₂ f₁.
template <class T>
struct StrainDerivatives {
  using Vector = Eigen::Matrix<T, 3, 1>;

  /// g receives the derivatives by e₁ and e₂. `first` are by g11, g22, g12; m is as in GreenStrain.
  static void gradient(const Vector& f1, const Vector& f2, const T* first, const T* m, Vector* g) {
    const T shear = 0.5 * first[2];
    const Vector p1 = f1 * first[0] + f2 * shear, p2 = f1 * shear + f2 * first[1];
    g[0] = p1 * m[0] + p2 * m[2];
    g[1] = p1 * m[1] + p2 * m[3];
  }

  /// The upper blocks of the 6×6 Hessian by (e₁, e₂). `second` is ordered as in Jet.
  static void hessian(const Vector& f1, const Vector& f2, const T* first, const T* second, const T* m,
                      Eigen::Matrix<T, 6, 6>& h) {
    using Block = Eigen::Matrix<T, 3, 3>;
    const auto by = [&](int i, int j) { return second[Jet<3, T>::index(i, j)]; };
    const T shear = 0.5 * first[2], c1 = 0.5 * by(0, 2), c2 = 0.5 * by(1, 2), cc = 0.25 * by(2, 2);
    // The matrix by (f₁, f₂): rows are f₁ or f₂ times what each column takes of f₁ and f₂.
    const Vector u1 = f1 * by(0, 0) + f2 * c1, u2 = f1 * c1 + f2 * cc;
    const Vector v1 = f2 * by(0, 1) + f1 * c1, v2 = f2 * c2 + f1 * cc;
    const Vector w1 = f2 * by(1, 1) + f1 * c2;
    Block h11 = f1 * u1.transpose() + f2 * u2.transpose();
    Block h12 = f1 * v1.transpose() + f2 * v2.transpose();
    Block h22 = f2 * w1.transpose() + f1 * v2.transpose();
    for (int c = 0; c < 3; ++c) h11(c, c) += first[0], h22(c, c) += first[1], h12(c, c) += shear;
    const Block symmetric = h12 + h12.transpose();
    h.template block<3, 3>(0, 0) = h11 * (m[0] * m[0]) + symmetric * (m[0] * m[2]) + h22 * (m[2] * m[2]);
    h.template block<3, 3>(0, 3) =
        h11 * (m[0] * m[1]) + h12 * (m[0] * m[3]) + h12.transpose() * (m[2] * m[1]) + h22 * (m[2] * m[3]);
    h.template block<3, 3>(3, 3) = h11 * (m[1] * m[1]) + symmetric * (m[1] * m[3]) + h22 * (m[3] * m[3]);
  }
};

}  // namespace drape

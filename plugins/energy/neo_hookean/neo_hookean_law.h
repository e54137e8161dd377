#pragma once

#include <algorithm>
#include <cmath>

#include "core/kernel/elements/membrane_kernel.h"

namespace drape {

/// ψ = μ/2 (tr C - 2 - 2 ln J) + λ/2 (ln J)², J = √det C.
template <class T>
struct NeoHookeanLaw : MembraneStrain<T> {
  using Strain = MembraneStrain<T>;
  using Strain::f1, Strain::f2, Strain::g11, Strain::g12, Strain::g22, Strain::lambda, Strain::mu;
  using typename Strain::Block, typename Strain::Vector;
  Vector normal;                 // F₁ × F₂
  T inverse_det, a11, a12, a22;  // of C, and A = C⁻¹
  T log_j;                       // ln J

  NeoHookeanLaw(const Vector& f1, const Vector& f2, const T& mu, const T& lambda)
      : Strain(f1, f2, mu, lambda) {
    using std::log, std::min;
    normal = f1.cross(f2);
    const T det = normal.squaredNorm();
    inverse_det = 1.0 / det;
    a11 = f2.squaredNorm() * inverse_det;
    a22 = f1.squaredNorm() * inverse_det;
    a12 = -2.0 * g12 * inverse_det;
    // det C - 1 to first order near 1, where `det` loses digits.
    const T det_minus_1 = 2.0 * (g11 + g22) + 4.0 * (g11 * g22 - g12 * g12);
    log_j = 0.5 * (log(det) + (det_minus_1 - (det - 1.0)) * min(det, inverse_det));
  }

  T energy() const { return mu * (g11 + g22 - log_j) + 0.5 * lambda * log_j * log_j; }

  /// P = F S, S = 2 ∂ψ/∂C = C⁻¹ (2 μ G + λ ln J I).
  void stress(Vector& p1, Vector& p2) const {
    const T k11 = 2.0 * mu * g11 + lambda * log_j, k22 = 2.0 * mu * g22 + lambda * log_j,
            k12 = 2.0 * mu * g12;
    const T s11 = a11 * k11 + a12 * k12, s12 = a11 * k12 + a12 * k22, s22 = a12 * k12 + a22 * k22;
    p1 = f1 * s11 + f2 * s12;
    p2 = f1 * s12 + f2 * s22;
  }

  /// ∂P_i/∂F_j = μ δ_ij I - m A_ij n nᵀ + m f^j (f^i)ᵀ + λ f^i (f^j)ᵀ, with f^i = Σ_k A_ik F_k the dual
  /// basis, n the unit normal, m = μ - λ ln J.
  void stiffness(Block& h11, Block& h12, Block& h22) const {
    const T m = mu - lambda * log_j;
    const Vector d1 = f1 * a11 + f2 * a12, d2 = f1 * a12 + f2 * a22;
    const Block nn = (normal * (m * inverse_det)) * normal.transpose();
    h11 = (d1 * (m + lambda)) * d1.transpose() - nn * a11;
    h22 = (d2 * (m + lambda)) * d2.transpose() - nn * a22;
    h12 = (d2 * m) * d1.transpose() + (d1 * lambda) * d2.transpose() - nn * a12;
    for (int i = 0; i < 3; ++i) h11(i, i) += mu, h22(i, i) += mu;
  }
};

using NeoHookeanKernel = MembraneKernel<NeoHookeanLaw>;

}  // namespace drape

#pragma once

#include "core/kernel/elements/membrane_kernel.h"

namespace drape {

/// ψ = μ tr(G²) + λ/2 (tr G)².
template <class T>
struct StvkLaw : MembraneStrain<T> {
  using Strain = MembraneStrain<T>;
  using Strain::f1, Strain::f2, Strain::g11, Strain::g12, Strain::g22, Strain::lambda, Strain::mu;
  using typename Strain::Block, typename Strain::Vector;
  T s11, s12, s22;  // S = 2 μ G + λ tr G I

  StvkLaw(const Vector& f1, const Vector& f2, const T& mu, const T& lambda) : Strain(f1, f2, mu, lambda) {
    const T pressure = lambda * (g11 + g22);
    s11 = 2.0 * mu * g11 + pressure;
    s22 = 2.0 * mu * g22 + pressure;
    s12 = 2.0 * mu * g12;
  }

  T energy() const {
    const T trace = g11 + g22;
    return mu * (g11 * g11 + g22 * g22 + 2.0 * g12 * g12) + 0.5 * lambda * trace * trace;
  }

  /// P = F S.
  void stress(Vector& p1, Vector& p2) const {
    p1 = f1 * s11 + f2 * s12;
    p2 = f1 * s12 + f2 * s22;
  }

  /// ∂P_i/∂F_j = S_ij I + μ (F_j F_iᵀ + δ_ij F Fᵀ) + λ F_i F_jᵀ.
  void stiffness(Block& h11, Block& h12, Block& h22) const {
    const Block f11 = f1 * f1.transpose(), f22 = f2 * f2.transpose(), f12 = f1 * f2.transpose();
    const Block ff = (f11 + f22) * mu;
    h11 = f11 * (mu + lambda) + ff;
    h22 = f22 * (mu + lambda) + ff;
    h12 = f12.transpose() * mu + f12 * lambda;
    for (int i = 0; i < 3; ++i) h11(i, i) += s11, h22(i, i) += s22, h12(i, i) += s12;
  }
};

using StvkKernel = MembraneKernel<StvkLaw>;

}  // namespace drape

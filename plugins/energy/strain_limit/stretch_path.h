#pragma once

#include <Eigen/Core>

#include "core/numerics/elements/stretch.h"

namespace drape {

/// Deformation gradient F(t) = F + t δF of one triangle along a step, by its columns.
struct StretchPath {
  Eigen::Vector3d f1, f2, d1, d2;

  PrincipalStretch<double> at(double t) const { return {f1 + t * d1, f2 + t * d2}; }

  /// Largest t in [0, 1] with σ₁ ≤ bound up to t, accurate to 1e-6 from below. Requires σ₁ < bound at 0.
  ///
  /// σ₁ is convex in t, so it crosses the bound once. Newton's method approaches the crossing from outside,
  /// the secant method from inside.
  double reach(double bound) const {
    const auto excess = [bound](const PrincipalStretch<double>& s) { return s.largest - bound; };
    double inside = 0, inside_excess = excess(at(0)), outside = 1;
    auto s = at(outside);
    if (excess(s) <= 0) return 1;
    constexpr int rounds = 100;  // far more than needed: both ends converge superlinearly
    for (int round = 0; round < rounds && outside - inside > 1e-6 * outside; ++round) {
      const double over = excess(s);
      const double slope = s.w1.dot(d1 * s.cosine + d2 * s.sine) / s.largest;
      double chord = inside - inside_excess * (outside - inside) / (over - inside_excess);
      if (!(chord > inside && chord < outside)) chord = 0.5 * (inside + outside);
      const double chord_excess = excess(at(chord));
      const double newton = outside - over / slope;
      if (chord_excess <= 0) {
        inside = chord;
        inside_excess = chord_excess;
      } else {
        outside = chord;  // round-off or NaN
      }
      if (newton > inside && newton < outside) outside = newton;
      s = at(outside);
      if (excess(s) <= 0) {  // rounding
        inside = outside;
        break;
      }
    }
    return inside;
  }
};

}  // namespace drape

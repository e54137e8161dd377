#pragma once

#include <cmath>
#include <limits>

namespace drape {

/// Barrier and friction parameters that all collisions of a contact model share (docs/theory/method.md,
/// section 6).
struct BarrierParameters {
  double dhat = 1e-3;                         ///< d̂ [m]
  double stiffness = 1;                       ///< κ [Pa]
  double friction_smoothing_distance = 1e-4;  ///< ε_v h, below which friction is smoothed [m]
  bool stiffness_is_fixed = true;             ///< false if κ may be raised for larger forces
};

/// A function's value and first two derivatives.
struct Derivatives {
  double value = 0, first = 0, second = 0;
};

/// b(s) = -(s - 1)² ln s with s = gap / d̂ (Li et al. 2020, eq. 6, made dimensionless). +∞ for s ≤ 0, 0 for
/// s ≥ 1, and C² there.
inline Derivatives barrier(double s) {
  if (s >= 1) return {};
  if (!(s > 0)) return {std::numeric_limits<double>::infinity(), 0, 0};
  const double e = s - 1, log = std::log(s), q = e / s;
  return {-e * e * log, -2 * e * log - e * q, -2 * log - 4 * q + q * q};
}

/// ε of the mollifier over |e|²|e'|² of the edges' rest lengths (Li et al. 2020, section 5).
inline constexpr double mollifier_threshold = 1e-3;

/// m(z) = 2 z/ε - (z/ε)² below ε, 1 above (Li et al. 2020, eq. 18), with z = |u × v|² [m⁴]. Fades an
/// edge-edge contact as the edges become parallel, where their distance is not smooth.
inline Derivatives mollifier(double z, double epsilon) {
  if (z >= epsilon) return {1, 0, 0};
  const double y = z / epsilon;
  return {y * (2 - y), 2 * (1 - y) / epsilon, -2 / (epsilon * epsilon)};
}

}  // namespace drape

#pragma once

#include <cmath>
#include <limits>

namespace drape {

/// A function's value and first two derivatives at one place.
struct Derivatives {
  double value = 0, first = 0, second = 0;
};

/// b(s) = -(s - 1)² ln s of a gap of s ranges (Li et al. 2020, eq. 6, by s): +∞ for s ≤ 0, 0 from s = 1 on,
/// twice differentiable there.
inline Derivatives barrier(double s) {
  if (s >= 1) return {};
  if (!(s > 0)) return {std::numeric_limits<double>::infinity(), 0, 0};
  const double e = s - 1, log = std::log(s), q = e / s;
  return {-e * e * log, -2 * e * log - e * q, -2 * log - 4 * q + q * q};
}

/// m(z) = 2 z/ε - (z/ε)² below ε, 1 from there on (Li et al. 2020, eq. 18): takes out an edge-edge contact,
/// whose distance is not smooth, as the edges become parallel; z = |u × v|² [m⁴].
inline Derivatives mollifier(double z, double epsilon) {
  if (z >= epsilon) return {1, 0, 0};
  const double y = z / epsilon;
  return {y * (2 - y), 2 * (1 - y) / epsilon, -2 / (epsilon * epsilon)};
}

}  // namespace drape

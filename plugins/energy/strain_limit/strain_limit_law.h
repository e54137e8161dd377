#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/numerics/elements/stretch_kernel.h"
#include "core/numerics/linear_algebra/pack_functions.h"

namespace drape {

/// φ(σ) = -κV y² ln(1 - y), y = (σ - 1)/(s - 1), for σ > 1; 0 below; NaN or +∞ for σ ≥ s (Li et al.
/// 2021, section 5). φ is κV y³ to leading order: twice continuously differentiable at σ = 1, where φ'''
/// jumps. All its derivatives are positive for 1 < σ < s, so the energy of a triangle is convex in x.
struct StrainLimitLaw {
  static constexpr int constants = 2;  ///< κV [J] and 1/(s - 1)
  static constexpr bool convex = true;

  template <class T>
  static T value(const T& s1, const T& s2, const T* constants) {
    const T y1 = over(s1, constants), y2 = over(s2, constants);
    return constants[0] * (y1 * y1 * minus_log_rest(y1) + y2 * y2 * minus_log_rest(y2));
  }

  template <class T>
  static StretchSlopes<T> slopes(const T& s1, const T& s2, const T* constants) {
    using std::max;
    const T scale1 = constants[0] * constants[1], scale2 = scale1 * constants[1];
    const T y1 = over(s1, constants), y2 = over(s2, constants);
    const T room1 = 1.0 - y1, room2 = 1.0 - y2, log1 = minus_log_rest(y1), log2 = minus_log_rest(y2);
    StretchSlopes<T> slopes;
    slopes.first1 = scale1 * y1 * (2.0 * log1 + y1 / room1);
    slopes.first2 = scale1 * y2 * (2.0 * log2 + y2 / room2);
    slopes.second1 = scale2 * (2.0 * log1 + y1 / room1 * (2.0 + (2.0 - y1) / room1));
    slopes.second2 = scale2 * (2.0 * log2 + y2 / room2 * (2.0 + (2.0 - y2) / room2));
    // Term by term: nothing cancels if y₁ = y₂. If σ₂ < 1, only the part above 1 counts.
    const T divided =
        2.0 * (log1 + y2 / room2 * log_ratio(room1 / room2)) + (y1 + y2 - y1 * y2) / (room1 * room2);
    const T whole = max((s1 - s2) * constants[1], T(std::numeric_limits<double>::min()));
    slopes.divided = scale2 * divided * select(s2 < 1.0, y1 / whole, T(1.0));
    return slopes;
  }

 private:
  template <class T>
  static T over(const T& stretch, const T* constants) {
    using std::max;
    return max(stretch - 1.0, T(0.0)) * constants[1];
  }

  /// ln(u) / (u - 1), insensitive to round-off in u (Kahan).
  template <class T>
  static T log_ratio(const T& u) {
    using std::log;
    const T away = u - 1.0;
    return select(away == 0.0, T(1.0), log(u) / select(away == 0.0, T(1.0), away));
  }

  /// -ln(1 - y) to the last digits, also for small y.
  template <class T>
  static T minus_log_rest(const T& y) {
    return y * log_ratio(1.0 - y);
  }
};

}  // namespace drape

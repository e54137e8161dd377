#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace drape {

/// A closed axis-aligned box [m], in single precision and rounded outwards, which halves what a broad phase
/// has to move. The default is empty and overlaps nothing.
struct Box {
  static constexpr float infinity = std::numeric_limits<float>::infinity();
  float lower[3] = {infinity, infinity, infinity};
  float upper[3] = {-infinity, -infinity, -infinity};

  bool operator==(const Box&) const = default;
  bool is_empty() const { return !(lower[0] <= upper[0]); }

  void include(const Box& b) {
    for (int k = 0; k < 3; ++k) {
      lower[k] = std::min(lower[k], b.lower[k]);
      upper[k] = std::max(upper[k], b.upper[k]);
    }
  }
  bool overlaps(const Box& b) const {
    // All six comparisons, since branches between them are hard to predict.
    return static_cast<bool>((lower[0] <= b.upper[0]) & (b.lower[0] <= upper[0]) & (lower[1] <= b.upper[1]) &
                             (b.lower[1] <= upper[1]) & (lower[2] <= b.upper[2]) & (b.lower[2] <= upper[2]));
  }
  /// Half the surface [m²]; 0 if empty.
  double half_area() const {
    if (is_empty()) return 0;
    const double a = upper[0] - lower[0], b = upper[1] - lower[1], c = upper[2] - lower[2];
    return a * b + b * c + c * a;
  }

  /// Around the points a and b and everything within `margin` of the segment between them.
  static Box around(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double margin) {
    constexpr double rounding = 1.2e-7;  // above the 2^-23 of the conversion
    // A float holds no more. A quarter, so that differences are finite too; what lies beyond is cut off alike
    // in every box, so that boxes that overlap still do.
    constexpr double most = std::numeric_limits<float>::max() / 4;
    Box box;
    for (int k = 0; k < 3; ++k) {
      const double low = std::min(a[k], b[k]) - margin, high = std::max(a[k], b[k]) + margin;
      box.lower[k] = static_cast<float>(std::clamp(low - rounding * std::abs(low), -most, most));
      box.upper[k] = static_cast<float>(std::clamp(high + rounding * std::abs(high), -most, most));
    }
    return box;
  }
};

}  // namespace drape

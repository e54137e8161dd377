#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

namespace drape {

/// A closed axis-aligned bounding box [m], rounded outwards to single precision, which halves the broad
/// phase's memory traffic. The default box is empty and overlaps nothing.
struct Box {
  static constexpr float infinity = std::numeric_limits<float>::infinity();
  float lower[3] = {infinity, infinity, infinity};
  float upper[3] = {-infinity, -infinity, -infinity};

  bool is_empty() const { return !(lower[0] <= upper[0]); }

  void include(const Box& b) {
    for (int k = 0; k < 3; ++k) {
      lower[k] = std::min(lower[k], b.lower[k]);
      upper[k] = std::max(upper[k], b.upper[k]);
    }
  }
  bool overlaps(const Box& b) const {
    // Without short-circuit: the branches would be hard to predict.
    return static_cast<bool>((lower[0] <= b.upper[0]) & (b.lower[0] <= upper[0]) & (lower[1] <= b.upper[1]) &
                             (b.lower[1] <= upper[1]) & (lower[2] <= b.upper[2]) & (b.lower[2] <= upper[2]));
  }
  Eigen::Vector3d centre() const { return 0.5 * (corner(lower) + corner(upper)); }
  /// Radius of the ball about the centre that contains the box [m].
  double radius() const { return 0.5 * (corner(upper) - corner(lower)).norm(); }
  /// To the nearest points of both boxes [m²]; 0 where they overlap.
  double squared_distance(const Box& b) const {
    return (corner(b.lower) - corner(upper))
        .cwiseMax(corner(lower) - corner(b.upper))
        .cwiseMax(0)
        .squaredNorm();
  }
  /// Half the surface area [m²]; 0 if empty.
  double half_area() const {
    if (is_empty()) return 0;
    const double a = upper[0] - lower[0], b = upper[1] - lower[1], c = upper[2] - lower[2];
    return a * b + b * c + c * a;
  }

  /// Bounds all points within `margin` of the segment from a to b.
  static Box around(const Eigen::Vector3d& a, const Eigen::Vector3d& b, double margin) {
    constexpr double rounding = 1.2e-7;  // above the conversion's 2^-23
    // A quarter of the largest float keeps differences finite. Clamping all boxes alike preserves overlaps.
    constexpr double largest = std::numeric_limits<float>::max() / 4;
    Box box;
    for (int k = 0; k < 3; ++k) {
      const double low = std::min(a[k], b[k]) - margin, high = std::max(a[k], b[k]) + margin;
      box.lower[k] = static_cast<float>(std::clamp(low - rounding * std::abs(low), -largest, largest));
      box.upper[k] = static_cast<float>(std::clamp(high + rounding * std::abs(high), -largest, largest));
    }
    return box;
  }

 private:
  static Eigen::Vector3d corner(const float* c) { return {c[0], c[1], c[2]}; }
};

}  // namespace drape

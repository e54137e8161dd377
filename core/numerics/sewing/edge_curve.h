#pragma once

#include <Eigen/Core>
#include <vector>

namespace drape {

/// An edge of a panel in its plane: a line, a Bézier curve of degree two or three, or an arc of a circle,
/// over the parameter t from 0 to 1 [m].
class EdgeCurve {
 public:
  /// A Bézier curve of two (a line), three or four control points, the first and last of which are its ends.
  static EdgeCurve bezier(std::vector<Eigen::Vector2d> points);

  /// The arc from one point to another whose angle grows from its start, seen along +z, if it is
  /// `counter_clockwise`; `large` takes that of more than half a turn. A radius below half the distance,
  /// which no arc has, counts as that.
  static EdgeCurve arc(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double radius, bool large,
                       bool counter_clockwise);

  Eigen::Vector2d at(double t) const;
  double length() const { return lengths_.back(); }
  /// The point after a length along the curve, from 0 to length().
  Eigen::Vector2d at_length(double s) const { return at(parameter(s)); }
  /// The curve between two lengths along it.
  EdgeCurve between(double from, double to) const;
  bool is_line() const { return points_.size() == 2; }

 private:
  EdgeCurve() = default;
  Eigen::Vector2d derivative(double t) const;
  void measure();
  double parameter(double s) const;

  std::vector<Eigen::Vector2d> points_;       // control points; of an arc only its centre
  double radius_ = 0, start_ = 0, turn_ = 0;  // of an arc; angles in radians
  std::vector<double> lengths_;               // from the start to t = k / (size - 1)
};

}  // namespace drape

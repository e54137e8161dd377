#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/numerics/sewing/pattern.h"

namespace drape {

namespace {

/// De Casteljau's construction up to `keep` points: one is the curve's point, two span its tangent.
std::vector<Eigen::Vector2d> reduced(std::vector<Eigen::Vector2d> points, double t, std::size_t keep) {
  for (; points.size() > keep; points.pop_back())
    for (std::size_t i = 0; i + 1 < points.size(); ++i) points[i] += t * (points[i + 1] - points[i]);
  return points;
}

/// The control points from t = 0 to `t`.
std::vector<Eigen::Vector2d> first_part(std::vector<Eigen::Vector2d> points, double t) {
  std::vector<Eigen::Vector2d> part;
  for (; !points.empty(); points = reduced(points, t, points.size() - 1)) part.push_back(points[0]);
  return part;
}

}  // namespace

EdgeCurve EdgeCurve::bezier(std::vector<Eigen::Vector2d> points) {
  EdgeCurve curve;
  curve.points_ = std::move(points);
  curve.measure();
  return curve;
}

EdgeCurve EdgeCurve::arc(const Eigen::Vector2d& from, const Eigen::Vector2d& to, double radius, bool large,
                         bool counter_clockwise) {
  EdgeCurve curve;
  const Eigen::Vector2d chord = to - from, left(-chord.y(), chord.x());
  curve.radius_ = std::max(radius, chord.norm() / 2);
  const double height = std::sqrt(std::max(0.0, curve.radius_ * curve.radius_ - chord.squaredNorm() / 4));
  const double side = large == counter_clockwise ? -1 : 1;  // a short arc has its centre on its inner side
  const Eigen::Vector2d centre = (from + to) / 2 + side * height / chord.norm() * left;
  const auto angle = [&](const Eigen::Vector2d& p) {
    return std::atan2(p.y() - centre.y(), p.x() - centre.x());
  };
  curve.points_ = {centre};
  curve.start_ = angle(from);
  curve.turn_ = angle(to) - curve.start_;
  constexpr double whole = 2 * std::numbers::pi;
  if (counter_clockwise && curve.turn_ < 0) curve.turn_ += whole;
  if (!counter_clockwise && curve.turn_ > 0) curve.turn_ -= whole;
  curve.measure();
  return curve;
}

Eigen::Vector2d EdgeCurve::at(double t) const {
  if (points_.size() > 1) return t == 1 ? points_.back() : reduced(points_, t, 1)[0];
  const double angle = start_ + t * turn_;
  return points_[0] + radius_ * Eigen::Vector2d(std::cos(angle), std::sin(angle));
}

Eigen::Vector2d EdgeCurve::derivative(double t) const {
  const std::vector<Eigen::Vector2d> tangent = reduced(points_, t, 2);
  return static_cast<double>(points_.size() - 1) * (tangent[1] - tangent[0]);
}

void EdgeCurve::measure() {
  if (points_.size() == 1) lengths_ = {0, radius_ * std::abs(turn_)};
  if (points_.size() == 2) lengths_ = {0, (points_[1] - points_[0]).norm()};
  if (points_.size() <= 2) return;
  constexpr int intervals = 256;
  constexpr double nodes[] = {0.5 - 0.3872983346207417, 0.5, 0.5 + 0.3872983346207417};  // Gauss–Legendre
  constexpr double weights[] = {5.0 / 18, 4.0 / 9, 5.0 / 18};
  lengths_ = {0};
  for (int i = 0; i < intervals; ++i) {
    double speed = 0;
    for (int k = 0; k < 3; ++k) speed += weights[k] * derivative((i + nodes[k]) / intervals).norm();
    lengths_.push_back(lengths_.back() + speed / intervals);
  }
}

double EdgeCurve::parameter(double s) const {
  const auto last = std::ssize(lengths_) - 1;
  const auto after = std::upper_bound(lengths_.begin(), lengths_.end() - 1, s);
  const auto i = std::clamp<std::ptrdiff_t>(after - lengths_.begin() - 1, 0, last - 1);
  const double step = lengths_[i + 1] - lengths_[i];
  const double within = step > 0 ? (s - lengths_[i]) / step : 0;
  return std::clamp((static_cast<double>(i) + within) / static_cast<double>(last), 0.0, 1.0);
}

EdgeCurve EdgeCurve::between(double from, double to) const {
  const double a = parameter(from), b = parameter(to);
  EdgeCurve part = *this;
  if (points_.size() == 1) {
    part.start_ += a * turn_, part.turn_ *= b - a;
  } else {
    part.points_ = first_part(points_, b);
    std::ranges::reverse(part.points_);
    part.points_ = first_part(part.points_, b > 0 ? 1 - a / b : 1);
    std::ranges::reverse(part.points_);
  }
  part.measure();
  return part;
}

}  // namespace drape

#include "plugins/contact/shapes/solid_trajectory.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/numerics/collision_detection/nonlinear_ccd.h"
#include "core/numerics/linear_algebra/interpolate.h"

namespace drape::shapes {

namespace {

using Eigen::Vector3d;

/// The largest distance from the centre of a point that rotates with the axes. The rounding does not rotate.
double lever_arm(const Solid& s) {
  const auto of_core = [&] { return s.half.norm(); };
  return by_form(
      s.kind, of_core, [&] { return std::hypot(s.radius, s.half.z()); }, of_core);
}

/// A lower bound of a triangle's distance: that of its bounding ball.
double ball_distance(const Solid& solid, const Corners& triangle) {
  const Vector3d centroid = (triangle[0] + triangle[1] + triangle[2]) / 3;
  double radius = 0;
  for (const Vector3d& corner : triangle) radius = std::max(radius, (corner - centroid).norm());
  return solid.distance(centroid) - radius;
}

bool are_same(const Solid& a, const Solid& b) {
  return a.centre == b.centre && a.half == b.half && a.radius == b.radius &&
         (a.kind == SolidKind::half_space ? a.plane == b.plane : a.rotate == b.rotate);
}

/// The first t in [0, 1] with a + b t + c t² ≤ 0, 1 if there is none.
double first_root(double a, double b, double c) {
  if (!(a > 0)) return 0;
  const double discriminant = b * b - 4 * a * c;
  if (discriminant < 0 || (b >= 0 && c >= 0)) return 1;
  // a > 0: the smallest positive root, without cancellation.
  const double root = std::sqrt(discriminant);
  const double t = b < 0 ? 2 * a / (root - b) : (-b - root) / (2 * c);
  return t > 0 ? std::min(t, 1.0) : 1;
}

}  // namespace

// p = c + R q with q and the angles of R linear in t: |R'| ≤ ω, |R''| ≤ ω², ω the sum of the angles' changes.
SolidTrajectory::SolidTrajectory(const Solid& from, const Solid& to) : from_(from), to_(to) {
  const double omega = (to.rotate - from.rotate).cwiseAbs().sum() * (M_PI / 180);
  const double size = std::max(lever_arm(from), lever_arm(to));
  const double growth = (to.half - from.half).norm() + std::abs(to.radius - from.radius);
  acceleration_bound_ = omega * omega * size + 2 * omega * growth;
  displacement_bound_ = (to.centre - from.centre).norm() + omega * size + growth;
}

Solid SolidTrajectory::at(double t) const {
  Solid s;
  s.kind = from_.kind;
  s.centre = interpolate(from_.centre, to_.centre, t);
  s.half = interpolate(from_.half, to_.half, t);
  s.radius = interpolate(from_.radius, to_.radius, t);
  s.rotate = interpolate(from_.rotate, to_.rotate, t);
  s.update_axes();
  return s;
}

double SolidTrajectory::gap(const Corners& triangle, double dhat) const {
  const double lower_bound = ball_distance(from_, triangle);
  return lower_bound > dhat ? lower_bound : separate(from_, triangle).separation;
}

double SolidTrajectory::advance(const Corners& triangle, double min_gap, int max_iterations) const {
  if (!(min_gap > 0)) return 0;
  if (from_.kind == SolidKind::half_space) return advance_plane(triangle, min_gap);
  if (ball_distance(from_, triangle) > displacement_bound_ + 2 * min_gap) return 1;
  const auto widest = [&](double t) { return separate(at(t), triangle); };
  const auto separation = [&](const Vector3d& n, double t) { return separation_along(at(t), triangle, n); };
  return nonlinear_ccd(widest, separation, min_gap, acceleration_bound_, max_iterations);
}

// |N| is convex in t, and its linear interpolant an upper bound: (gap - min_gap) |N| ≥ N · (p - c) - min_gap
// |N| is bounded below by a quadratic polynomial.
double SolidTrajectory::advance_plane(const Corners& triangle, double min_gap) const {
  const double length = from_.plane.norm(), longer = to_.plane.norm() - length;
  const Vector3d normal_change = to_.plane - from_.plane, displacement = to_.centre - from_.centre;
  double fraction = 1;
  for (const Vector3d& corner : triangle) {
    const Vector3d p = corner - from_.centre;
    fraction =
        std::min(fraction, first_root(from_.plane.dot(p) - min_gap * length,
                                      normal_change.dot(p) - from_.plane.dot(displacement) - min_gap * longer,
                                      -normal_change.dot(displacement)));
  }
  return fraction;
}

std::vector<SolidTrajectory> moving_solids(const std::vector<Solid>& from, const std::vector<Solid>& to) {
  std::vector<SolidTrajectory> trajectories;
  for (std::size_t i = 0; i < to.size(); ++i) {
    if (from[i].kind != to[i].kind)
      throw std::runtime_error(to[i].name + " cannot replace " + from[i].name + " during a run");
    if (!are_same(from[i], to[i])) trajectories.emplace_back(from[i], to[i]);
  }
  return trajectories;
}

Vector3d displacement_with(const Solid& from, const Solid& to, const Vector3d& p) {
  if (from.kind != SolidKind::half_space) return to.to_world(from.to_local(p)) - p;
  // Axes from the normal alone would turn about it, without end where it points down.
  const Vector3d a = from.axes.col(2), b = to.axes.col(2), arm = p - from.centre, v = a.cross(b);
  const double cosine = a.dot(b);
  if (cosine < -1 + 1e-12) return to.centre - from.centre;  // turned over: there is no smallest angle
  const Vector3d turned = arm + v.cross(arm) + v.cross(v.cross(arm)) / (1 + cosine);
  return to.centre + turned - p;
}

}  // namespace drape::shapes

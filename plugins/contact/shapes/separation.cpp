#include "plugins/contact/shapes/separation.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace drape::shapes {

namespace {

using Eigen::Vector3d;

constexpr double unreliable_gap = 1e-7;  // below it a nearest point's direction is mostly round-off [m]
/// Gaps below tiny_gap [m] keep this larger fraction: steps that shrink a gap tenfold each soon reach
/// round-off.
constexpr double tiny_gap = 1e-9, tiny_gap_fraction = 0.9;

Corners corners_between(const Corners& a, const Corners& b, double t) {
  Corners c;
  for (int k = 0; k < 3; ++k) c[k] = a[k] + t * (b[k] - a[k]);
  return c;
}

Vector3d centroid(const Corners& c) { return (c[0] + c[1] + c[2]) / 3; }

/// The time until which the separation along `normal`, sufficient at t, stays at least `width`.
double separation_end(const Solid& solid, const Corners& from, const Corners& to, double t,
                      const Vector3d& normal, double width) {
  const double support = solid.support(normal);
  const Corners now = corners_between(from, to, t);
  double part = 1;
  for (int k = 0; k < 3; ++k) {
    const double here = normal.dot(now[k]) - support - width, end = normal.dot(to[k]) - support - width;
    if (end < 0) part = std::min(part, std::max(0.0, here / (here - end)));
  }
  return t + part * (1 - t);
}

}  // namespace

double separation_along(const Solid& solid, const Corners& triangle, const Vector3d& normal) {
  return std::min({normal.dot(triangle[0]), normal.dot(triangle[1]), normal.dot(triangle[2])}) -
         solid.support(normal);
}

SeparatingPlane separate(const Solid& solid, const Corners& triangle) {
  const auto with = [&](const Vector3d& n) {
    return SeparatingPlane{n, separation_along(solid, triangle, n)};
  };
  if (solid.kind == SolidKind::half_space) return with(solid.axes.col(2));
  SeparatingPlane best = with(solid.nearest(triangle[0]).normal);
  const auto take = [&](const Vector3d& n) {
    const SeparatingPlane s = with(n);
    if (s.separation > best.separation) best = s;
  };
  Vector3d across[3];  // normals of each edge and the solid's edge or rim next to it
  for (int k = 0; k < 3; ++k) {
    const Vector3d &a = triangle[k], &b = triangle[(k + 1) % 3];
    const SignedDistance nearest = solid.nearest(a + solid.nearest_on_edge(a, b) * (b - a));
    take(nearest.normal);
    across[k] = (b - a).cross(nearest.tangent);
  }
  const Vector3d up = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double length = up.norm();
  if (length > 0) {
    take(up / length);
    take(-up / length);
  }
  // Close to an edge or a rim, the direction to its nearest point is mostly round-off; the normal of both
  // edges is accurate.
  if (best.separation < unreliable_gap)
    for (const Vector3d& n : across)
      if (const double size = n.norm(); size > 0) {
        take(n / size);
        take(-n / size);
      }
  return best;
}

bool intersects(const Solid& solid, const Corners& triangle) {
  return !(separation_along(solid, triangle, solid.nearest(centroid(triangle)).normal) > 0) &&
         !(separate(solid, triangle).separation > 0);
}

double advance(const Solid& solid, const Corners& from, const Corners& to, double min_gap_fraction) {
  // Early exit for most pairs: one normal keeps the fraction of an upper bound of the distance.
  const SignedDistance at_centroid = solid.nearest(centroid(from));
  const double sufficient = min_gap_fraction * at_centroid.distance;
  if (sufficient > 0 && separation_along(solid, from, at_centroid.normal) >= sufficient &&
      separation_along(solid, to, at_centroid.normal) >= sufficient)
    return 1;

  SeparatingPlane s = separate(solid, from);
  if (!(s.separation > 0)) return 0;
  const double min_gap =
      std::max(min_gap_fraction * s.separation, std::min(tiny_gap_fraction * s.separation, tiny_gap));
  double t = 0;
  for (int iteration = 0; iteration < 128 && s.separation > 1.01 * min_gap; ++iteration) {
    t = separation_end(solid, from, to, t, s.normal, min_gap);
    if (t >= 1) return 1;
    s = separate(solid, corners_between(from, to, t));
  }
  return t;
}

}  // namespace drape::shapes

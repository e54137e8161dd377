#include "plugins/contact/shapes/separation.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace drape {

namespace {

using Eigen::Vector3d;

constexpr double hard_to_tell = 1e-7;  // [m]
/// Steps that shrink the gap tenfold each soon come to where doubles end: from here on [m] they leave most of
/// it.
constexpr double hardly_any = 1e-9, most = 0.9;

Corners between(const Corners& a, const Corners& b, double t) {
  Corners c;
  for (int k = 0; k < 3; ++k) c[k] = a[k] + t * (b[k] - a[k]);
  return c;
}

Vector3d middle_of(const Corners& c) { return (c[0] + c[1] + c[2]) / 3; }

/// The end of the time from t on in which the slab of `normal`, wide enough at t, stays at least `width`
/// wide.
double reach(const Solid& solid, const Corners& from, const Corners& to, double t, const Vector3d& normal,
             double width) {
  const double support = solid.support(normal);
  const Corners now = between(from, to, t);
  double part = 1;
  for (int k = 0; k < 3; ++k) {
    const double here = normal.dot(now[k]) - support - width, end = normal.dot(to[k]) - support - width;
    if (end < 0) part = std::min(part, std::max(0.0, here / (here - end)));
  }
  return t + part * (1 - t);
}

}  // namespace

double slab(const Solid& solid, const Corners& triangle, const Vector3d& normal) {
  return std::min({normal.dot(triangle[0]), normal.dot(triangle[1]), normal.dot(triangle[2])}) -
         solid.support(normal);
}

Separation separate(const Solid& solid, const Corners& triangle) {
  const auto with = [&](const Vector3d& n) { return Separation{n, slab(solid, triangle, n)}; };
  if (solid.kind == SolidKind::half_space) return with(solid.axes.col(2));
  Separation best = with(solid.nearest(triangle[0]).normal);
  const auto take = [&](const Vector3d& n) {
    const Separation s = with(n);
    if (s.gap > best.gap) best = s;
  };
  Vector3d across[3];  // edges and what they cross of the solid
  for (int k = 0; k < 3; ++k) {
    const Vector3d &a = triangle[k], &b = triangle[(k + 1) % 3];
    const Nearest nearest = solid.nearest(a + solid.nearest_on_edge(a, b) * (b - a));
    take(nearest.normal);
    across[k] = (b - a).cross(nearest.tangent);
  }
  const Vector3d up = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  const double length = up.norm();
  if (length > 0) {
    take(up / length);
    take(-up / length);
  }
  // So near an edge or a rim, the direction to its nearest point is mostly rounding; that across both is not.
  if (best.gap < hard_to_tell)
    for (const Vector3d& n : across)
      if (const double size = n.norm(); size > 0) {
        take(n / size);
        take(-n / size);
      }
  return best;
}

bool touches(const Solid& solid, const Corners& triangle) {
  return !(slab(solid, triangle, solid.nearest(middle_of(triangle)).normal) > 0) &&
         !(separate(solid, triangle).gap > 0);
}

double advance(const Solid& solid, const Corners& from, const Corners& to, double keep) {
  // Cheap and enough for most: one normal, and no less than `keep` of an upper bound of the distance.
  const Nearest at_middle = solid.nearest(middle_of(from));
  const double enough = keep * at_middle.distance;
  if (enough > 0 && slab(solid, from, at_middle.normal) >= enough &&
      slab(solid, to, at_middle.normal) >= enough)
    return 1;

  Separation s = separate(solid, from);
  if (!(s.gap > 0)) return 0;
  const double kept = std::max(keep * s.gap, std::min(most * s.gap, hardly_any));
  double t = 0;
  for (int round = 0; round < 128 && s.gap > 1.01 * kept; ++round) {
    t = reach(solid, from, to, t, s.normal, kept);
    if (t >= 1) return 1;
    s = separate(solid, between(from, to, t));
  }
  return t;
}

}  // namespace drape

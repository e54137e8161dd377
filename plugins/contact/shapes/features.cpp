#include "plugins/contact/shapes/features.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/collision_detection/closest.h"
#include "core/numerics/patterns/generate.h"

namespace drape::shapes {

namespace {

using Eigen::Vector2d, Eigen::Vector3d;

// Insets of a rim's polygons, and the d̂ of the one with many sides, over d̂. With few sides the gap is thus
// overestimated by at most a tenth where it is not small.
constexpr double few_sides_inset = 5e-3, many_sides_inset = 5e-5, small_gap = 0.05;

/// Corners of the core in local coordinates: 8 of a box, 2 of a capsule, 1 of a sphere.
std::vector<Vector3d> core_corners(const Vector3d& half) {
  std::vector<Vector3d> corners{Vector3d::Zero()};
  for (int k = 0; k < 3; ++k) {
    if (half[k] == 0) continue;
    const std::size_t count = corners.size();
    for (std::size_t i = 0; i < count; ++i) corners.push_back(corners[i]);
    for (std::size_t i = 0; i < 2 * count; ++i) corners[i][k] = i < count ? -half[k] : half[k];
  }
  return corners;
}

Vector3d on_circle(double radius, int k, int sides, double z) {
  const double angle = 2 * M_PI * k / sides;
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// Sides of a rim's polygon that is nowhere more than `max_inset` [m] inside its circle.
int sides_of(const Solid& solid, double max_inset) {
  const double step = std::acos(1 - std::min(0.5, max_inset / solid.radius));
  return std::max(16, static_cast<int>(std::ceil(M_PI / step)));
}

/// The rims of a cylinder as polygons nowhere more than `max_inset` [m] inside their circles.
Features rims(const Solid& solid, double dhat, double max_inset) {
  Features f;
  f.dhat = dhat;
  f.sides = sides_of(solid, max_inset);
  f.side = 2 * solid.radius * std::sin(M_PI / f.sides);
  f.points.reserve(2 * f.sides);
  f.edges.reserve(2 * f.sides);
  for (const int ring : {0, f.sides})
    for (int k = 0; k < f.sides; ++k) {
      f.points.push_back(on_circle(solid.radius, k, f.sides, ring ? solid.half.z() : -solid.half.z()));
      f.edges.push_back({ring + k, ring + (k + 1) % f.sides});
    }
  return f;
}

/// Calls visit(i) for the points or edges that may be within `radius` of `centre`. Those of rims are ordered
/// in rings, bottom and top; element k of each ring begins at angle 2πk / sides.
template <class Visit>
void visit_candidates(const Features& f, std::size_t size, const Solid& solid, const Vector3d& centre,
                      double radius, const Visit& visit) {
  const int sides = f.sides, count = static_cast<int>(size);
  if (sides == 0) {
    for (int i = 0; i < count; ++i) visit(i);
    return;
  }
  const Vector3d q = solid.to_local(centre);
  const double rho = q.head<2>().norm(), angle = std::atan2(q.y(), q.x()), unit = 2 * M_PI / sides;
  if (rho + radius < solid.radius * std::cos(unit / 2)) return;
  const double spread =
      radius < rho ? std::asin(radius / rho) : M_PI;  // half angle of the ball seen from the axis
  const int first = static_cast<int>(std::floor((angle - spread) / unit)) - 1;
  const int last = std::min(static_cast<int>(std::ceil((angle + spread) / unit)), first + sides - 1);
  for (int ring = 0; ring < count; ring += sides) {
    const double up = q.z() - (ring ? solid.half.z() : -solid.half.z());
    if (std::hypot(std::max(0.0, std::abs(rho - solid.radius) - f.side), up) > radius) continue;
    for (int k = first; k <= last; ++k) visit(ring + ((k % sides) + sides) % sides);
  }
}

double distance_to_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d e = b - a;
  return (p - a - nearest_on_segment(e, p - a) * e).norm();
}

/// The surface of revolution of a profile of (radius, z), ordered from top to bottom, with poles at ±top.
TriangleMesh revolve(const Solid& solid, const std::vector<Vector2d>& profile, double top, int sides) {
  const int rings = static_cast<int>(profile.size());
  TriangleMesh mesh;
  mesh.vertices.resize(rings * sides + 2, 3);
  mesh.triangles.resize(2 * rings * sides, 3);
  int row = 0;
  for (int i = 0; i < rings; ++i)
    for (int k = 0; k < sides; ++k) {
      mesh.vertices.row(i * sides + k) = solid.to_world(on_circle(profile[i].x(), k, sides, profile[i].y()));
      const int next = (k + 1) % sides, a = i * sides;
      if (i + 1 < rings) {
        mesh.triangles.row(row++) << a + k, a + sides + k, a + next;
        mesh.triangles.row(row++) << a + next, a + sides + k, a + sides + next;
      }
    }
  for (const double side : {1.0, -1.0}) {
    const int pole = rings * sides + (side > 0 ? 0 : 1), ring = side > 0 ? 0 : (rings - 1) * sides;
    mesh.vertices.row(pole) = solid.to_world({0, 0, side * top});
    for (int k = 0; k < sides; ++k) {
      const int next = (k + 1) % sides;
      mesh.triangles.row(row++) << pole, ring + (side > 0 ? k : next), ring + (side > 0 ? next : k);
    }
  }
  return mesh;
}

TriangleMesh box_surface(const Solid& solid) {
  TriangleMesh mesh = unit_box();
  for (auto vertex : mesh.vertices.rowwise())
    vertex = solid.to_world(2 * solid.half.cwiseProduct(vertex.transpose())).transpose();
  return mesh;
}

/// Two quarter circles, separated by the core of a capsule, revolved.
TriangleMesh capsule_surface(const Solid& solid, int sides) {
  std::vector<Vector2d> profile;
  const int steps = sides / 4;
  for (int i = 1; i < 2 * steps; ++i) {
    const double angle = 0.5 * M_PI * i / steps;
    const double shift = i < steps ? solid.half.z() : -solid.half.z();
    if (i == steps) profile.push_back({solid.radius, solid.half.z()});
    if (i != steps || solid.half.z() > 0)
      profile.push_back({solid.radius * std::sin(angle), solid.radius * std::cos(angle) + shift});
  }
  return revolve(solid, profile, solid.half.z() + solid.radius, sides);
}

}  // namespace

std::vector<Features> Features::of(const Solid& solid, double dhat) {
  Features core;
  core.dhat = dhat;
  core.points = core_corners(solid.half);
  core.offset = solid.radius;
  const int corners = static_cast<int>(core.points.size());
  for (int i = 0; i < corners; ++i)
    for (int bit = 1; bit < corners; bit *= 2)
      if (!(i & bit)) core.edges.push_back({i, i | bit});
  std::vector<Features> all;
  by_form(
      solid.kind, [&] { all = {core}; },
      [&] {
        core.is_axis = true;
        all.push_back(std::move(core));
        all.push_back(rims(solid, dhat, few_sides_inset * dhat));
        all.push_back(rims(solid, small_gap * dhat, many_sides_inset * dhat));
      },
      [] {});
  for (Features& f : all)
    for (Vector3d& point : f.points) point = solid.to_world(point);
  return all;
}

long rim_points(const Solid& cylinder, double dhat) {
  return 2L * (sides_of(cylinder, few_sides_inset * dhat) + sides_of(cylinder, many_sides_inset * dhat));
}

SolidFeatures SolidFeatures::of(const std::vector<Solid>& solids, double dhat) {
  SolidFeatures all;
  for (const Solid& solid : solids) all.of_solid.push_back(Features::of(solid, dhat));
  // Rims come last: a larger one has more points, and contacts are identified by point indices.
  std::vector<Features*> ordered;
  for (const bool rims : {false, true})
    for (std::vector<Features>& own : all.of_solid)
      for (Features& features : own)
        if ((features.sides > 0) == rims) ordered.push_back(&features);
  int count = 0;
  for (Features* features : ordered) {
    features->first_point = count;
    count += static_cast<int>(features->points.size());
  }
  all.points.resize(count, 3);
  for (const Features* features : ordered)
    for (std::size_t i = 0; i < features->points.size(); ++i)
      all.points.row(features->first_point + i) = features->points[i];
  return all;
}

double Features::distance_bound(const Solid& solid, const Vector3d& p) const {
  const Vector3d q = solid.to_local(p);
  const double out = std::abs(q.head<2>().norm() - solid.radius), up = std::abs(q.z()) - solid.half.z();
  return std::hypot(std::max(0.0, out - side), up);
}

void Features::points_near(const Solid& solid, const Vector3d& centre, double radius,
                           std::vector<int>& found) const {
  visit_candidates(*this, points.size(), solid, centre, radius, [&](int i) {
    if ((points[i] - centre).norm() <= radius) found.push_back(i);
  });
}

void Features::edges_near(const Solid& solid, const Vector3d& centre, double radius,
                          std::vector<int>& found) const {
  visit_candidates(*this, edges.size(), solid, centre, radius, [&](int i) {
    if (distance_to_segment(centre, points[edges[i][0]], points[edges[i][1]]) <= radius) found.push_back(i);
  });
}

int drawn_sides(std::size_t solids) {
  constexpr double most_triangles = 4e6;  // of all together, at 24 bytes and a vertex for each two
  constexpr int most = 64, fewest = 12;   // a sphere of n sides has about n² triangles
  const double each = std::sqrt(most_triangles / static_cast<double>(solids));
  return each >= most ? most : std::max(fewest, 4 * static_cast<int>(each / 4));
}

TriangleMesh tessellate(const Solid& solid, double half_side, int sides) {
  const double r = solid.radius, top = solid.half.z();
  const auto square = [&] {
    TriangleMesh mesh;
    mesh.vertices.resize(4, 3);
    for (int i = 0; i < 4; ++i)
      mesh.vertices.row(i) = solid.to_world(half_side * Vector3d(i % 2 ? 1 : -1, i / 2 ? 1 : -1, 0));
    mesh.triangles.resize(2, 3);
    mesh.triangles << 0, 1, 2, 1, 3, 2;
    return mesh;
  };
  return by_form(
      solid.kind, [&] { return r > 0 ? capsule_surface(solid, sides) : box_surface(solid); },
      [&] {
        return revolve(solid, {{r, top}, {r, -top}}, top, sides);
      },
      square);
}

}  // namespace drape::shapes

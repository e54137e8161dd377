#include "plugins/contact/ipc/nearest_features.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <tuple>

#include "core/contact/pair_geometry.h"

namespace drape {

using Eigen::Vector3d;

namespace {

constexpr double cancelled = 1e-12;

/// The parameter in [0, 1] of the segment's point that is nearest to p.
double nearest(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d u = b - a;
  return std::clamp((p - a).dot(u) / u.squaredNorm(), 0.0, 1.0);
}

}  // namespace

void FeatureSearch::add_triangle(const Vector3d& p, int t) {
  const auto v = obstacles_.surface.triangles.row(t);
  PairPositions x;
  x << p, place(v[0]), place(v[1]), place(v[2]);
  if (box_distance(PairKind::point_triangle, x) >= range_) return;
  const Closest found = closest(PairKind::point_triangle, x);
  if (connection(x, found).squaredNorm() >= range_ * range_) return;
  near_.push_back(t);
  const auto is_in = [&](int k) { return found.c[1 + k] != 0; };
  if (found.free == 2) {
    cells_.push_back({Kind::face, t, 1});
  } else if (found.free == 1) {
    const int opposite = !is_in(0) ? 0 : !is_in(1) ? 1 : 2;
    cells_.push_back({Kind::edge, obstacles_.surface.triangle_edges(t, opposite), 1});
  } else {
    cells_.push_back({Kind::vertex, v[is_in(0) ? 0 : is_in(1) ? 1 : 2], 1});
  }
}

void FeatureSearch::add_edge(const Vector3d& p, int e) {
  const double coefficient = coefficients_.edge[e];
  if (coefficient == 0) return;
  const auto v = obstacles_.surface.edges.row(e);
  const Vector3d a = place(v[0]), b = place(v[1]);
  const double t = nearest(p, a, b);
  if ((p - a - t * (b - a)).squaredNorm() >= range_ * range_) return;
  if (t > 0 && t < 1)
    cells_.push_back({Kind::edge, e, -coefficient});
  else
    cells_.push_back({Kind::vertex, v[t > 0], -coefficient});
}

void FeatureSearch::add_vertex(const Vector3d& p, int v) {
  if (coefficients_.vertex[v] > 0 && (p - place(v)).squaredNorm() < range_ * range_)
    cells_.push_back({Kind::vertex, v, coefficients_.vertex[v]});
}

void FeatureSearch::append(const Vector3d& p, const NearTriangle* begin, const NearTriangle* end,
                           std::vector<NearestFeature>& features) {
  cells_.clear();
  near_.clear();
  for (const NearTriangle* at = begin; at != end; ++at) add_triangle(p, at->triangle);
  // An edge or vertex within range has all of its triangles within range, the one that owns it too.
  if (near_.size() > 1)
    for (const int t : near_)
      for (int k = 0; k < 3; ++k) {
        if (obstacles_.surface.owns_edge(t, k)) add_edge(p, obstacles_.surface.triangle_edges(t, k));
        if (obstacles_.surface.owns_vertex(t, k)) add_vertex(p, obstacles_.surface.triangles(t, k));
      }
  std::ranges::sort(cells_, {}, [](const Cell& cell) { return std::tuple(cell.kind, cell.number); });
  for (std::size_t i = 0; i < cells_.size();) {
    Cell sum = cells_[i];
    for (++i; i < cells_.size() && cells_[i].kind == sum.kind && cells_[i].number == sum.number; ++i)
      sum.coefficient += cells_[i].coefficient;
    if (std::abs(sum.coefficient) > cancelled) features.push_back(feature(p, sum));
  }
}

NearestFeature FeatureSearch::feature(const Vector3d& p, const Cell& cell) const {
  const Surface& surface = obstacles_.surface;
  NearestFeature f{{-1, -1, -1}, Vector3d::UnitX(), {}, Vector3d::Zero(), 0, cell.coefficient, 0};
  if (cell.kind == Kind::face) {
    for (int k = 0; k < 3; ++k) f.vertices[k] = surface.triangles(cell.number, k);
    const Vector3d a = place(f.vertices[0]), b = place(f.vertices[1]), c = place(f.vertices[2]);
    f.weights = -closest_point_triangle(p, a, b, c).c.tail<3>();
    // By the plane's normal: of a gap that is small against the triangle, the connection has few digits left.
    f.normal = (b - a).cross(c - a).normalized();
    f.distance = f.normal.dot(p - a);
    if (f.distance < 0) {
      f.distance = -f.distance;
      f.normal = -f.normal;
    }
  } else if (cell.kind == Kind::edge) {
    for (int k = 0; k < 2; ++k) f.vertices[k] = surface.edges(cell.number, k);
    const Vector3d a = place(f.vertices[0]), b = place(f.vertices[1]);
    const double t = nearest(p, a, b);
    f.weights = {1 - t, t, 0};
    f.along = (b - a).normalized();
    Vector3d r = p - a;
    r -= f.along.dot(r) * f.along;
    r -= f.along.dot(r) * f.along;
    f.distance = r.norm();
    f.normal = r / f.distance;
  } else {
    f.vertices[0] = cell.number;
    const Vector3d r = p - place(cell.number);
    f.distance = r.norm();
    f.normal = r / f.distance;
  }
  f.friction = obstacles_.bodies[obstacles_.body_of(f.vertices[0])].friction.value_or(friction_);
  return f;
}

}  // namespace drape

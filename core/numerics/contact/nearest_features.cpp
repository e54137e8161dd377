#include "core/numerics/contact/nearest_features.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <tuple>

#include "core/numerics/contact/pair_geometry.h"

namespace drape {

using Eigen::Vector3d;

namespace {

/// Sums of coefficients below this are round-off of terms that cancel.
constexpr double zero_coefficient = 1e-12;

}  // namespace

void FeatureSearch::add_triangle(const Vector3d& p, int t) {
  const auto v = obstacles_.surface.triangles.row(t);
  PairPositions x;
  x << p, position(v[0]), position(v[1]), position(v[2]);
  if (box_distance(PairKind::point_triangle, x) >= dhat_) return;
  const Closest found = closest(PairKind::point_triangle, x);
  if (connection(x, found).squaredNorm() >= dhat_ * dhat_) return;
  near_.push_back(t);
  const auto is_in = [&](int k) { return found.c[1 + k] != 0; };
  if (found.free == 2) {
    terms_.push_back({Kind::face, t, 1});
  } else if (found.free == 1) {
    const int opposite = !is_in(0) ? 0 : !is_in(1) ? 1 : 2;
    terms_.push_back({Kind::edge, obstacles_.surface.triangle_edges(t, opposite), 1});
  } else {
    terms_.push_back({Kind::vertex, v[is_in(0) ? 0 : is_in(1) ? 1 : 2], 1});
  }
}

void FeatureSearch::add_edge(const Vector3d& p, int e) {
  const double coefficient = coefficients_.edge[e];
  if (coefficient == 0) return;
  const auto v = obstacles_.surface.edges.row(e);
  const Vector3d a = position(v[0]), b = position(v[1]);
  const double t = nearest_on_segment(b - a, p - a);
  if ((p - a - t * (b - a)).squaredNorm() >= dhat_ * dhat_) return;
  if (t > 0 && t < 1)
    terms_.push_back({Kind::edge, e, -coefficient});
  else
    terms_.push_back({Kind::vertex, v[t > 0], -coefficient});
}

void FeatureSearch::add_vertex(const Vector3d& p, int v) {
  if (coefficients_.vertex[v] != 0 && (p - position(v)).squaredNorm() < dhat_ * dhat_)
    terms_.push_back({Kind::vertex, v, coefficients_.vertex[v]});
}

void FeatureSearch::append(const Vector3d& p, const VertexTriangleCandidate* begin,
                           const VertexTriangleCandidate* end, std::vector<NearestFeature>& features) {
  terms_.clear();
  near_.clear();
  for (const VertexTriangleCandidate* at = begin; at != end; ++at) add_triangle(p, at->triangle);
  // If an edge or vertex is within d̂, so are all of its triangles, including its representative.
  if (near_.size() > 1)
    for (const int t : near_)
      for (int k = 0; k < 3; ++k) {
        if (obstacles_.surface.represents_edge(t, k)) add_edge(p, obstacles_.surface.triangle_edges(t, k));
        if (obstacles_.surface.represents_vertex(t, k)) add_vertex(p, obstacles_.surface.triangles(t, k));
      }
  std::ranges::sort(terms_, {}, [](const Term& term) { return std::tuple(term.kind, term.index); });
  for (std::size_t i = 0; i < terms_.size();) {
    Term sum = terms_[i];
    for (++i; i < terms_.size() && terms_[i].kind == sum.kind && terms_[i].index == sum.index; ++i)
      sum.coefficient += terms_[i].coefficient;
    if (std::abs(sum.coefficient) > zero_coefficient) features.push_back(feature(p, sum));
  }
}

NearestFeature FeatureSearch::feature(const Vector3d& p, const Term& term) const {
  const Surface& surface = obstacles_.surface;
  NearestFeature f{{-1, -1, -1}, Vector3d::UnitX(), {}, Vector3d::Zero(), 0, term.coefficient, 0, 0};
  if (term.kind == Kind::face) {
    for (int k = 0; k < 3; ++k) f.vertices[k] = surface.triangles(term.index, k);
    const Vector3d a = position(f.vertices[0]), b = position(f.vertices[1]), c = position(f.vertices[2]);
    f.weights = -closest_point_triangle(p, a, b, c).c.tail<3>();
    // The plane's normal is accurate even if the gap is small compared with the triangle; p minus the nearest
    // point is not.
    f.normal = (b - a).cross(c - a).normalized();
    f.distance = f.normal.dot(p - a);
    if (f.distance < 0) {
      f.distance = -f.distance;
      f.normal = -f.normal;
    }
  } else if (term.kind == Kind::edge) {
    for (int k = 0; k < 2; ++k) f.vertices[k] = surface.edges(term.index, k);
    const Vector3d a = position(f.vertices[0]), b = position(f.vertices[1]);
    const double t = nearest_on_segment(b - a, p - a);
    f.weights = {1 - t, t, 0};
    f.along = (b - a).normalized();
    Vector3d r = p - a;
    r -= f.along.dot(r) * f.along;
    r -= f.along.dot(r) * f.along;
    f.distance = r.norm();
    f.normal = r / f.distance;
  } else {
    f.vertices[0] = term.index;
    const Vector3d r = p - position(term.index);
    f.distance = r.norm();
    f.normal = r / f.distance;
  }
  f.body = obstacles_.body_of(f.vertices[0]);
  f.friction = obstacles_.friction_of(f.body, friction_);
  return f;
}

}  // namespace drape

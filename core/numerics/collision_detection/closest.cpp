#include "core/numerics/collision_detection/closest.h"

#include <Eigen/Geometry>
#include <limits>

namespace drape {
namespace {

using Eigen::Vector3d, Eigen::Vector4d;

/// Squared sine below which two directions count as parallel: parameters along both are then round-off.
constexpr double parallel_squared_sine = 1e-22;

void add_direction(Closest& result, const Vector4d& direction) {
  result.direction.col(result.free++) = direction;
}

/// Coordinates of p's projection onto the plane of e1 and e2. Products with the normal n have an error that
/// grows with 1 / sine, normal equations with its square. Refinement iterations, which only slivers need,
/// remove the rest.
Eigen::Vector2d project(const Vector3d& e1, const Vector3d& e2, const Vector3d& n, const Vector3d& p) {
  constexpr int max_iterations = 6;
  const double scale = 1 / n.squaredNorm();
  Eigen::Vector2d result = Eigen::Vector2d::Zero();
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const Vector3d rest = p - result[0] * e1 - result[1] * e2;
    const Eigen::Vector2d change(rest.cross(e2).dot(n) * scale, e1.cross(rest).dot(n) * scale);
    result += change;
    if (iteration > 0 && change.cwiseAbs().maxCoeff() <= 1e-14) break;
  }
  return result;
}

Closest inside_triangle(const Eigen::Vector2d& b) {
  Closest result;
  result.c = {1, -(1 - b[0] - b[1]), -b[0], -b[1]};
  add_direction(result, {0, 1, -1, 0});
  add_direction(result, {0, 1, 0, -1});
  return result;
}

}  // namespace

Closest closest_point_triangle(const Vector3d& x0, const Vector3d& x1, const Vector3d& x2,
                               const Vector3d& x3) {
  const Vector3d corners[3] = {Vector3d::Zero(), x2 - x1, x3 - x1}, p = x0 - x1;
  const Vector3d n = corners[1].cross(corners[2]);
  Vector3d inside = Vector3d::Constant(-1);  // barycentric coordinates
  if (n.squaredNorm() > parallel_squared_sine * corners[1].squaredNorm() * corners[2].squaredNorm()) {
    const Eigen::Vector2d b = project(corners[1], corners[2], n, p);
    inside = {1 - b.sum(), b[0], b[1]};
    if (inside.minCoeff() > 0) return inside_triangle(b);
  }
  // Otherwise the nearest point is on an edge that p is outside of.
  Closest result;
  double smallest = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    if (inside[k] > 0) continue;
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Vector3d edge = corners[j] - corners[i], from = p - corners[i];
    const double t = nearest_on_segment(edge, from), square = (from - t * edge).squaredNorm();
    if (square >= smallest) continue;
    smallest = square;
    result = Closest();
    result.c[0] = 1;
    result.c[1 + i] = -(1 - t);
    result.c[1 + j] = -t;
    if (t > 0 && t < 1) add_direction(result, Vector4d::Unit(1 + i) - Vector4d::Unit(1 + j));
  }
  return result;
}

Closest closest_edge_edge(const Vector3d& x0, const Vector3d& x1, const Vector3d& x2, const Vector3d& x3) {
  const Vector3d u = x1 - x0, v = x3 - x2, w = x2 - x0, n = u.cross(v);
  const double square = n.squaredNorm();
  // Parallel lines allow any s. t is the nearest to it; if t is clamped, s is the nearest to that end.
  double s = square > 0 ? std::clamp(w.cross(v).dot(n) / square, 0.0, 1.0) : 0.0;
  const double t = nearest_on_segment(v, s * u - w);
  if (t == 0 || t == 1) s = nearest_on_segment(u, t * v + w);
  Closest result;
  result.c = {1 - s, s, -(1 - t), -t};
  const bool s_free = s > 0 && s<1, t_free = t> 0 && t < 1;
  const bool parallel = square <= parallel_squared_sine * u.squaredNorm() * v.squaredNorm();
  if (t_free) add_direction(result, {0, 0, 1, -1});
  if (s_free && !(t_free && parallel)) add_direction(result, {-1, 1, 0, 0});
  return result;
}

}  // namespace drape

#include "core/numerics/hierarchy/normal_offsets.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace drape {
namespace {

using Eigen::Vector3d;

struct Sides {
  Vector3d b, c;  ///< from the first corner to the others
  Vector3d twice_area() const { return b.cross(c); }
};

Sides sides_of(const Triangles& triangles, int t, const Positions& x) {
  const Vector3d a = x.row(triangles(t, 0));
  return {x.row(triangles(t, 1)).transpose() - a, x.row(triangles(t, 2)).transpose() - a};
}

/// A triangle that has all vertices of a row, or -1.
int triangle_of_row(const Level& coarse, const ProlongationMatrix& weights, Eigen::Index row) {
  std::vector<int> vertices;
  for (ProlongationMatrix::InnerIterator entry(weights, row); entry; ++entry)
    vertices.push_back(static_cast<int>(entry.col()));
  for (const int t : coarse.topology.vertex_triangles.row(vertices.front())) {
    const auto corners = coarse.rest.triangles.row(t);
    if (std::ranges::all_of(vertices, [&](int v) { return (corners.array() == v).any(); })) return t;
  }
  return -1;
}

}  // namespace

NormalOffsets NormalOffsets::of(const Level& coarse, const ProlongationMatrix& weights, const Level& fine) {
  constexpr double rounding = 1e-9;  // of an edge
  if (fine.rest.sewing) return {};
  const Positions missed = fine.rest.vertices - weights * coarse.rest.vertices;
  const double edge = std::sqrt(2 * coarse.vertex_area.sum() / coarse.triangle_count());
  if (missed.rowwise().norm().maxCoeff() <= rounding * edge) return {};
  NormalOffsets offsets{std::vector<int>(fine.vertex_count()), Eigen::VectorXd(fine.vertex_count())};
  for (int v = 0; v < fine.vertex_count(); ++v) {
    const int t = triangle_of_row(coarse, weights, v);
    const Vector3d own = missed.row(v);
    const Vector3d n =
        t < 0 ? Vector3d::Zero()
              : sides_of(coarse.rest.triangles, t, coarse.rest.vertices).twice_area().normalized();
    offsets.triangle[v] = std::max(t, 0);
    offsets.height[v] = own.dot(n);
    if ((own - offsets.height[v] * n).norm() > rounding * edge) return {};
  }
  return offsets;
}

void NormalOffsets::add(const Triangles& coarse, const Positions& x, Positions& fine) const {
  if (triangle.empty()) return;
  Positions normals(coarse.rows(), 3);
  for (int t = 0; t < coarse.rows(); ++t)
    normals.row(t) = sides_of(coarse, t, x).twice_area().normalized().transpose();
  for (Eigen::Index v = 0; v < fine.rows(); ++v) fine.row(v) += height[v] * normals.row(triangle[v]);
}

void NormalOffsets::add_forces(const Triangles& coarse, const Positions& x, const Positions& fine_forces,
                               Positions& forces) const {
  if (triangle.empty()) return;
  Positions sums = Positions::Zero(coarse.rows(), 3);
  for (Eigen::Index v = 0; v < fine_forces.rows(); ++v)
    sums.row(triangle[v]) += height[v] * fine_forces.row(v);
  for (int t = 0; t < coarse.rows(); ++t) {
    const Sides s = sides_of(coarse, t, x);
    const Vector3d n = s.twice_area().normalized(), f = sums.row(t);
    const Vector3d across = (f - f.dot(n) * n) / s.twice_area().norm();
    const Vector3d b = s.c.cross(across), c = across.cross(s.b);
    forces.row(coarse(t, 1)) += b.transpose();
    forces.row(coarse(t, 2)) += c.transpose();
    forces.row(coarse(t, 0)) -= (b + c).transpose();
  }
}

}  // namespace drape

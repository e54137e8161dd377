#include "core/numerics/hierarchy/rest_interpolation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace drape {
namespace {

double longest_side(const TriangleMesh& rest, int triangle) {
  const auto v = rest.triangles.row(triangle);
  double longest = 0;
  for (int k = 0; k < 3; ++k)
    longest = std::max(longest, (rest.vertices.row(v[k]) - rest.vertices.row(v[(k + 1) % 3])).norm());
  return longest;
}

}  // namespace

EmbeddedPoint EmbeddedPoint::of(const Eigen::Vector3d& point, const Positions& vertices,
                                const Triangles& triangles, int triangle) {
  const auto v = triangles.row(triangle);
  const Eigen::Vector3d a = vertices.row(v[0]), b = vertices.row(v[1]), c = vertices.row(v[2]);
  const Eigen::Vector3d normal = (b - a).cross(c - a), sides((c - b).norm(), (a - c).norm(), (b - a).norm());
  const double double_area = normal.norm();
  EmbeddedPoint embedded;
  embedded.triangle = triangle;
  embedded.weights[1] = (point - a).cross(c - a).dot(normal) / (double_area * double_area);
  embedded.weights[2] = (b - a).cross(point - a).dot(normal) / (double_area * double_area);
  embedded.weights[0] = 1 - embedded.weights[1] - embedded.weights[2];
  const Eigen::Array3d inside = embedded.weights.array() * double_area / sides.array();  // from each side
  embedded.distance = std::hypot(std::max(0.0, -inside.minCoeff()), (point - a).dot(normal) / double_area);
  return embedded;
}

ProlongationMatrix rest_interpolation(const Level& coarse, const Positions& fine_rest) {
  // Relative to the longest side of an adjacent triangle: round-off of the refiner's sums.
  constexpr double unmoved = 1e-6;
  const TriangleMesh& rest = coarse.rest;
  const int n = coarse.vertex_count();
  const auto fine_count = static_cast<int>(fine_rest.rows());
  std::vector<Eigen::Triplet<double>> weights;
  weights.reserve(3 * static_cast<std::size_t>(fine_count));
  for (int v = 0; v < fine_count; ++v) {
    const Eigen::Vector3d point = fine_rest.row(v);
    const int a = v < n ? v : coarse.topology.edges(v - n, 0);
    const int b = v < n ? v : coarse.topology.edges(v - n, 1);
    const Eigen::Vector3d midpoint = 0.5 * (rest.vertices.row(a) + rest.vertices.row(b));
    const AdjacencyList& around = coarse.topology.vertex_triangles;
    if ((point - midpoint).norm() <= unmoved * longest_side(rest, around.row(a).front())) {
      weights.emplace_back(v, a, a == b ? 1 : 0.5);
      if (b != a) weights.emplace_back(v, b, 0.5);
      continue;
    }
    EmbeddedPoint nearest;
    for (const int parent : {a, b})
      for (const int t : around.row(parent))
        if (const auto embedded = EmbeddedPoint::of(point, rest.vertices, rest.triangles, t);
            embedded.distance < nearest.distance)
          nearest = embedded;
    for (int k = 0; k < 3; ++k)
      weights.emplace_back(v, rest.triangles(nearest.triangle, k), nearest.weights[k]);
  }
  ProlongationMatrix matrix(fine_count, n);
  matrix.setFromTriplets(weights.begin(), weights.end());
  return matrix;
}

}  // namespace drape

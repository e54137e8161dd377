#include "core/hierarchy/rest_interpolation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace drape {
namespace {

/// A point beside a triangle.
struct Place {
  int triangle = -1;
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();          ///< barycentric, of its projection to the plane
  double distance = std::numeric_limits<double>::infinity();  ///< from the triangle's lines and plane [m]
  double longest_side = 0;                                    ///< of the triangle [m]
};

Place place_in(const TriangleMesh& rest, int triangle, const Eigen::Vector3d& point) {
  const auto v = rest.triangles.row(triangle);
  const Eigen::Vector3d a = rest.vertices.row(v[0]), b = rest.vertices.row(v[1]), c = rest.vertices.row(v[2]);
  const Eigen::Vector3d normal = (b - a).cross(c - a), sides((c - b).norm(), (a - c).norm(), (b - a).norm());
  const double double_area = normal.norm();
  Place place;
  place.triangle = triangle;
  place.weights[1] = (point - a).cross(c - a).dot(normal) / (double_area * double_area);
  place.weights[2] = (b - a).cross(point - a).dot(normal) / (double_area * double_area);
  place.weights[0] = 1 - place.weights[1] - place.weights[2];
  const Eigen::Array3d inside = place.weights.array() * double_area / sides.array();  // from each side
  place.distance = std::hypot(std::max(0.0, -inside.minCoeff()), (point - a).dot(normal) / double_area);
  place.longest_side = sides.maxCoeff();
  return place;
}

}  // namespace

ProlongationMatrix rest_interpolation(const Level& coarse, const Positions& fine_rest) {
  constexpr double unmoved = 1e-6;  // of the longest side of the triangle: rounding of the refiner's sums
  const TriangleMesh& rest = coarse.rest;
  const int n = coarse.vertex_count();
  const auto fine_count = static_cast<int>(fine_rest.rows());
  std::vector<Eigen::Triplet<double>> weights;
  weights.reserve(3 * static_cast<std::size_t>(fine_count));
  for (int v = 0; v < fine_count; ++v) {
    const Eigen::Vector3d point = fine_rest.row(v);
    const int a = v < n ? v : coarse.topology.edges(v - n, 0);
    const int b = v < n ? v : coarse.topology.edges(v - n, 1);
    Place nearest;
    for (const int parent : {a, b}) {
      const AdjacencyList& around = coarse.topology.vertex_triangles;
      for (const int* t = around.begin(parent); t != around.end(parent); ++t)
        if (const Place place = place_in(rest, *t, point); place.distance < nearest.distance) nearest = place;
    }
    const Eigen::Vector3d midpoint = 0.5 * (rest.vertices.row(a) + rest.vertices.row(b));
    if ((point - midpoint).norm() <= unmoved * nearest.longest_side) {
      weights.emplace_back(v, a, a == b ? 1 : 0.5);
      if (b != a) weights.emplace_back(v, b, 0.5);
    } else {
      for (int k = 0; k < 3; ++k)
        weights.emplace_back(v, rest.triangles(nearest.triangle, k), nearest.weights[k]);
    }
  }
  ProlongationMatrix matrix(fine_count, n);
  matrix.setFromTriplets(weights.begin(), weights.end());
  return matrix;
}

}  // namespace drape

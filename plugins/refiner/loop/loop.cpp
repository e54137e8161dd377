#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/kernel/interfaces/refiner.h"
#include "core/kernel/plugin/parameters.h"
#include "core/kernel/plugin/plugin.h"

namespace drape {

/// Loop subdivision (C. Loop, Smooth Subdivision Surfaces Based on Triangles, 1987) with J. Warren's weights
/// inside (Subdivision Methods for Geometric Design, 1995), cubic B-splines along the border and
/// interpolated corners.
class LoopRefiner : public Refiner {
 public:
  double corner_angle = 30;

  static void declare(Declaration<LoopRefiner>& d) {
    d.add("corner_angle", &LoopRefiner::corner_angle,
          "border vertices whose interior rest angle differs from 180 degrees by more than this are "
          "corners and are interpolated; others are smoothed")
        .unit("degree")
        .between(0, 360)
        .source("docs/theory/method.md, section 4");
  }

  ProlongationMatrix weights(const Level& coarse) const override {
    const Topology& topology = coarse.topology;
    const int n = coarse.vertex_count();
    const auto edge_count = static_cast<int>(topology.edges.rows());
    Weights weights;
    weights.reserve(7 * static_cast<std::size_t>(n) + 4 * static_cast<std::size_t>(edge_count));
    const auto corner = corners(coarse);
    for (int v = 0; v < n; ++v) {
      if (topology.on_border[v])
        weights.emplace_back(v, v, corner[v] ? 1 : 0.75);
      else
        add_inner_vertex(v, topology, weights);
    }
    for (int e = 0; e < edge_count; ++e) {
      add_edge(e, coarse, weights);
      if (topology.edge_triangles(e, 1) != -1) continue;
      for (int end = 0; end < 2; ++end)  // a vertex of the border has two of its edges
        if (const int v = topology.edges(e, end); !corner[v])
          weights.emplace_back(v, topology.edges(e, 1 - end), 0.125);
    }

    ProlongationMatrix matrix(n + edge_count, n);
    matrix.setFromTriplets(weights.begin(), weights.end());
    return matrix;
  }

  /// n flags, 1 for interpolated border vertices. A flat rest shape keeps its corners on every finer level:
  /// the new neighbours of a corner lie on the old border edges and keep its angle.
  std::vector<char> corners(const Level& level) const {
    Eigen::VectorXd angle = Eigen::VectorXd::Zero(level.vertex_count());  // [rad]
    for (int t = 0; t < level.triangle_count(); ++t) {
      const Eigen::Matrix3d x = rest_corners(level.rest, t);
      for (int k = 0; k < 3; ++k) {
        const Eigen::Vector3d a = x.col((k + 1) % 3) - x.col(k), b = x.col((k + 2) % 3) - x.col(k);
        angle[level.rest.triangles(t, k)] += std::atan2(a.cross(b).norm(), a.dot(b));
      }
    }
    const double allowed = corner_angle * std::numbers::pi / 180;
    std::vector<char> corner(level.vertex_count());
    for (int v = 0; v < level.vertex_count(); ++v)
      corner[v] = level.topology.on_border[v] && std::abs(angle[v] - std::numbers::pi) > allowed;
    return corner;
  }

 private:
  using Weights = std::vector<Eigen::Triplet<double>>;

  static void add_inner_vertex(int v, const Topology& topology, Weights& weights) {
    const AdjacencyList& neighbours = topology.vertex_vertices;
    const int valence = neighbours.size(v);
    const double beta = valence == 3 ? 3.0 / 16 : 3.0 / (8.0 * valence);  // Warren 1995
    weights.emplace_back(v, v, 1 - valence * beta);
    for (const int u : neighbours.row(v)) weights.emplace_back(v, u, beta);
  }

  static void add_edge(int e, const Level& coarse, Weights& weights) {
    const Topology& topology = coarse.topology;
    const int row = coarse.vertex_count() + e;
    const bool border = topology.edge_triangles(e, 1) == -1;
    for (int end = 0; end < 2; ++end) weights.emplace_back(row, topology.edges(e, end), border ? 0.5 : 0.375);
    if (border) return;
    for (const int t : topology.edge_triangles.row(e))
      weights.emplace_back(row, coarse.rest.triangles(t, topology.corner_opposite(e, t)), 0.125);
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Refiner, drape::LoopRefiner>(
      "loop", "Loop subdivision with B-spline borders and interpolated corners: smooth; the surface moves.");
}

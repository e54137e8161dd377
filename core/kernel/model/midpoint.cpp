#include "core/kernel/model/midpoint.h"

#include <vector>

namespace drape {

Triangles split_triangles(const Level& coarse) {
  const int n = coarse.vertex_count();
  Triangles children(4 * static_cast<Eigen::Index>(coarse.triangle_count()), 3);
  for (int t = 0; t < coarse.triangle_count(); ++t) {
    const auto v = coarse.rest.triangles.row(t);
    const auto e = coarse.topology.triangle_edges.row(t);  // e[k] is opposite v[k]
    children.row(4 * t + 0) << v[0], n + e[2], n + e[1];
    children.row(4 * t + 1) << n + e[2], v[1], n + e[0];
    children.row(4 * t + 2) << n + e[1], n + e[0], v[2];
    children.row(4 * t + 3) << n + e[0], n + e[1], n + e[2];
  }
  return children;
}

Refinement midpoint_refinement(const Level& coarse) {
  const int n = coarse.vertex_count();
  const auto edge_count = static_cast<int>(coarse.topology.edges.rows());
  std::vector<Eigen::Triplet<double>> weights;
  weights.reserve(n + 2 * static_cast<std::size_t>(edge_count));
  for (int v = 0; v < n; ++v) weights.emplace_back(v, v, 1);
  for (int e = 0; e < edge_count; ++e)
    for (int end = 0; end < 2; ++end) weights.emplace_back(n + e, coarse.topology.edges(e, end), 0.5);

  Refinement refinement{split_triangles(coarse), ProlongationMatrix(n + edge_count, n)};
  refinement.weights.setFromTriplets(weights.begin(), weights.end());
  return refinement;
}

}  // namespace drape

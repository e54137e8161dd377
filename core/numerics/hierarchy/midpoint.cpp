#include "core/numerics/hierarchy/midpoint.h"

#include <vector>

#include "core/numerics/mesh/grain.h"
#include "core/numerics/mesh/split_triangles.h"
#include "core/numerics/mesh/texture_coordinates.h"

namespace drape {

ProlongationMatrix midpoint_weights(const Level& coarse) {
  const int n = coarse.vertex_count();
  const auto edge_count = static_cast<int>(coarse.topology.edges.rows());
  std::vector<Eigen::Triplet<double>> weights;
  weights.reserve(n + 2 * static_cast<std::size_t>(edge_count));
  for (int v = 0; v < n; ++v) weights.emplace_back(v, v, 1);
  for (int e = 0; e < edge_count; ++e)
    for (int end = 0; end < 2; ++end) weights.emplace_back(n + e, coarse.topology.edges(e, end), 0.5);
  ProlongationMatrix matrix(n + edge_count, n);
  matrix.setFromTriplets(weights.begin(), weights.end());
  return matrix;
}

TriangleMesh refined_rest(const Level& coarse, const ProlongationMatrix& weights) {
  TriangleMesh fine{weights * coarse.rest.vertices, split_triangles(coarse.rest.triangles, coarse.topology),
                    split_uv(coarse.rest.uv)};
  fine.sewing = coarse.rest.sewing;
  fine.piece_names = coarse.rest.piece_names;
  for (const int piece : coarse.rest.piece) fine.piece.insert(fine.piece.end(), 4, piece);
  fine.warp = split_warp(coarse.rest.warp, fine);
  return fine;
}

}  // namespace drape

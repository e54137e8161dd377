#include "core/kernel/plugin/plugin.h"
#include "core/numerics/hierarchy/midpoint.h"

namespace {

/// Old vertices stay; an edge's new one is pulled from its middle towards the two vertices opposite it.
struct SmoothMidpoint : drape::Refiner {
  double pull = 0.0625;

  static void declare(drape::Declaration<SmoothMidpoint>& d) {
    d.add("pull", &SmoothMidpoint::pull)
        .at_least(0)
        .at_most(0.25)
        .description("weight of each opposite vertex; 1/8 is Loop's");
  }

  drape::Refinement refine(const drape::Level& coarse) const override {
    drape::Refinement refinement = drape::midpoint_refinement(coarse);
    std::vector<Eigen::Triplet<double>> change;
    const drape::Topology& topology = coarse.topology;
    for (int t = 0; t < coarse.triangle_count(); ++t)
      for (int k = 0; k < 3; ++k) {
        const int edge = topology.triangle_edges(t, k);  // opposite vertex k
        if (topology.edge_triangles(edge, 1) < 0) continue;
        const int row = coarse.vertex_count() + edge;
        change.emplace_back(row, coarse.rest.triangles(t, k), pull);
        for (int end = 0; end < 2; ++end) change.emplace_back(row, topology.edges(edge, end), -pull / 2);
      }
    drape::ProlongationMatrix pulled(refinement.weights.rows(), refinement.weights.cols());
    pulled.setFromTriplets(change.begin(), change.end());
    refinement.weights += pulled;
    return refinement;
  }
};

}  // namespace

DRAPE_PLUGIN(registry) {
  registry.add<drape::Refiner, SmoothMidpoint>("smooth_midpoint",
                                               "Midpoints pulled towards a smooth surface.");
}

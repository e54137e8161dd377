#include "core/kernel/plugin/plugin.h"
#include "core/numerics/hierarchy/midpoint.h"

DRAPE_PARAMETERS(Pull, (pull, 0.0625, "1", 0, 0.25, "weight of each opposite vertex; 1/8 is Loop's"));

/// Old vertices stay; an edge's new one is pulled from its middle towards the two vertices opposite it.
struct SmoothMidpoint : drape::Refiner, Pull {
  drape::ProlongationMatrix weights(const drape::Level& coarse) const override {
    drape::ProlongationMatrix weights = drape::midpoint_weights(coarse);
    const drape::Topology& topology = coarse.topology;
    for (int t = 0; t < coarse.triangle_count(); ++t)
      for (int k = 0; k < 3; ++k) {
        const int edge = topology.triangle_edges(t, k);  // opposite vertex k
        if (topology.edge_triangles(edge, 1) < 0) continue;
        const int row = coarse.vertex_count() + edge;
        weights.coeffRef(row, coarse.rest.triangles(t, k)) += pull;
        for (int end = 0; end < 2; ++end) weights.coeffRef(row, topology.edges(edge, end)) -= pull / 2;
      }
    return weights;
  }
};

DRAPE_PLUGIN(registry) {
  registry.add<drape::Refiner, SmoothMidpoint>("smooth_midpoint",
                                               "Midpoints pulled towards a smooth surface.");
}

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/kernel/interfaces/metric.h"
#include "core/kernel/plugin/plugin.h"
#include "core/kernel/threads/parallel.h"
#include "core/numerics/collision_detection/surface_search.h"

namespace drape {
namespace {

/// The largest distance of a vertex of `from` to the surface of `to`. The vertex of the same number bounds
/// each; those with the largest bounds come first, until no bound exceeds a distance that was found.
double largest_distance(const Positions& from, const Positions& to, const Triangles& triangles) {
  const Eigen::VectorXd bounds = (from - to).rowwise().norm();
  std::vector<int> order(from.rows());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) { return bounds[i] > bounds[j]; });

  const TriangleMesh mesh{to, triangles};
  const SurfaceSearch surface(mesh);
  constexpr int at_once = 256;
  double largest = 0;
  std::array<double, at_once> found;
  for (std::size_t first = 0; first < order.size() && bounds[order[first]] > largest; first += at_once) {
    const int count = static_cast<int>(std::min<std::size_t>(at_once, order.size() - first));
    parallel_for(count, 16, [&](int begin, int end) {
      for (int k = begin; k < end; ++k) {
        const int i = order[first + k];
        const NearestPoint nearest = surface.nearest(from.row(i), bounds[i]);
        found[k] = nearest.triangle < 0 ? bounds[i] : nearest.offset.norm();
      }
    });
    largest = std::max(largest, *std::max_element(found.begin(), found.begin() + count));
  }
  return largest;
}

}  // namespace

/// Distances between two states, in units of the rest shape's bounding-box diagonal: distance_rms,
/// distance_max over corresponding vertices, distance_hausdorff between the surfaces.
class Distance : public Metric {
 public:
  MetricScope scope() const override { return MetricScope::pair; }
  MetricDeclaration declaration() const override {
    return {.columns = {{.name = "distance_rms",
                         .label = "distance, RMS",
                         .unit = "diagonal",
                         .error = "rms",
                         .error_use = ErrorUse::ranking},
                        {.name = "distance_max",
                         .label = "distance, largest",
                         .unit = "diagonal",
                         .shown = Shown::stored},
                        {.name = "distance_hausdorff",
                         .label = "Hausdorff distance",
                         .unit = "diagonal",
                         .shown = Shown::stored,
                         .error = "hausdorff"}},
            .text = "The distance is that of corresponding points, in units of the rest shape's diagonal."};
  }

 private:
  MetricResult measure(const MetricInput& input) const override {
    const Positions& x = input.x;
    const Positions& other = *input.other;
    const double diagonal = bounding_box_diagonal(input.level.rest.vertices);

    const Eigen::VectorXd squared = (x - other).rowwise().squaredNorm();
    const Triangles& triangles = input.level.rest.triangles;
    const double there = largest_distance(x, other, triangles), back = largest_distance(other, x, triangles);
    const Eigen::VectorXd& area = input.level.vertex_area;

    MetricResult result;
    const auto add = [&](const char* name, double distance) {
      result.values.push_back({name, distance / diagonal});
    };
    add("distance_rms", std::sqrt(area.dot(squared) / area.sum()));
    add("distance_max", std::sqrt(squared.maxCoeff()));
    add("distance_hausdorff",
        std::min(std::max(there, back), std::sqrt(squared.maxCoeff())));  // but for rounding it is
    return result;
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Metric, drape::Distance>(
      "distance", "Distance between two states in units of the rest shape's diagonal.");
}

#pragma once

#include <array>

#include "core/kernel/interfaces/metric.h"
#include "core/kernel/plugin/parameters.h"

namespace drape {

/// How far the outlines of two states cover each other: silhouette_overlap, the mean over fixed views, and
/// silhouette_lowest, that of the worst view [1].
class Silhouette : public Metric {
 public:
  int resolution = 256;

  static void declare(Declaration<Silhouette>& d) {
    d.add("resolution", &Silhouette::resolution)
        .at_least(16)
        .at_most(4096)
        .description("pixels along the diagonal of the rest shape");
  }

  MetricScope scope() const override { return MetricScope::pair; }
  MetricDeclaration declaration() const override;

  /// The directions of view, as unit vectors: the twelve axes through the vertices of a rhombicuboctahedron.
  static std::array<Eigen::Vector3d, 12> directions();

 private:
  MetricResult measure(const MetricInput& input) const override;
};

}  // namespace drape

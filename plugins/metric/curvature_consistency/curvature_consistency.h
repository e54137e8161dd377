#pragma once

#include <deque>
#include <memory>
#include <mutex>

#include "core/kernel/interfaces/metric.h"
#include "core/kernel/plugin/parameters.h"
#include "plugins/metric/curvature_consistency/curvature.h"

namespace drape {

/// The curvatures of the states that were asked for last, since a run compares each of its states with the
/// same two. Safe from several threads.
class RecentCurvatures {
 public:
  struct Curvatures {
    VertexCurvatures fit, ddg;
  };

  /// Fits reach so many edges away from a vertex.
  explicit RecentCurvatures(int rings) : rings_(rings) {}

  /// Of a state of a level. Throws as fit_curvatures and ddg_curvatures.
  std::shared_ptr<const Curvatures> of(const Positions& x, const Level& level) const;

 private:
  struct State {
    Positions x;
    Triangles triangles;
    std::shared_ptr<const Curvatures> curvatures;
  };
  /// The least by which neither of the two is dropped: they, a state and the one before it.
  static constexpr std::size_t most = 4;

  int rings_;
  mutable std::mutex mutex_;
  mutable std::deque<State> states_;  // the one that was used last comes first
};

/// Consistency of two states from the integrated squared difference of their curvatures (supplement of
/// Zhang et al. 2022, section 1): d_H_fit, d_H_ddg [1], d_K_fit, d_K_ddg [1/m²].
class CurvatureConsistency : public Metric {
 public:
  struct Parameters {
    int rings = 5;
    static void declare(Declaration<Parameters>& d);
  };

  explicit CurvatureConsistency(const Parameters& parameters) : curvatures_(parameters.rings) {}
  MetricScope scope() const override { return MetricScope::pair; }
  MetricDeclaration declaration() const override;

 private:
  MetricResult measure(const MetricInput& input) const override;

  RecentCurvatures curvatures_;
};

}  // namespace drape

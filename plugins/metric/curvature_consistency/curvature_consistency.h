#pragma once

#include <deque>
#include <memory>
#include <mutex>

#include "core/kernel/model/metric.h"
#include "core/kernel/plugin/parameters.h"
#include "plugins/metric/curvature_consistency/curvature.h"

namespace drape {

/// The curvatures of the states that were asked for last. A run measures each of its states against two
/// others, over and over the same ones. Safe from several threads.
class RecentCurvatures {
 public:
  struct Curvatures {
    VertexCurvatures fit, ddg;
  };

  /// Of a state of a level: kept ones, or new ones by fits of so many rings.
  std::shared_ptr<const Curvatures> of(const Positions& x, const Level& level, int rings) const;

 private:
  struct State {
    Positions x;
    Triangles triangles;
    std::shared_ptr<const Curvatures> curvatures;
  };
  /// Both of the others, this state and, as it is used in between, the one before.
  static constexpr std::size_t most = 4;

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

  explicit CurvatureConsistency(const Parameters& parameters) : parameters_(parameters) {}
  MetricScope scope() const override { return MetricScope::pair; }
  MetricDeclaration declaration() const override;

 private:
  MetricResult measure(const MetricInput& input) const override;

  Parameters parameters_;
  RecentCurvatures curvatures_;
};

}  // namespace drape

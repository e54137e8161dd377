#include <algorithm>
#include <deque>
#include <memory>
#include <mutex>

#include "core/kernel/interfaces/metric.h"
#include "core/kernel/plugin/parameters.h"
#include "core/kernel/plugin/plugin.h"
#include "core/numerics/mesh/same_entries.h"
#include "plugins/metric/curvature_consistency/curvature.h"

namespace drape {

/// The curvatures of the states that were asked for last, since a run compares each of its states with the
/// same two. Safe from several threads.
class RecentCurvatures {
 public:
  struct Curvatures {
    VertexCurvatures fit, ddg;
  };

  /// Fits reach `rings` edges away from a vertex.
  explicit RecentCurvatures(int rings) : rings_(rings) {}

  /// The curvatures of a state of a level. Throws as fit_curvatures and ddg_curvatures.
  std::shared_ptr<const Curvatures> of(const Positions& x, const Level& level) const {
    const Triangles& triangles = level.rest.triangles;
    const std::lock_guard lock(mutex_);
    const auto known = std::find_if(states_.begin(), states_.end(), [&](const State& state) {
      return same_entries(state.x, x) && same_entries(state.triangles, triangles);
    });
    if (known != states_.end()) {
      std::rotate(states_.begin(), known, known + 1);
    } else {
      states_.push_front({x, triangles,
                          std::make_shared<Curvatures>(fit_curvatures(x, triangles, level.topology, rings_),
                                                       ddg_curvatures(x, triangles, level.topology))});
      if (states_.size() > most) states_.pop_back();
    }
    return states_.front().curvatures;
  }

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

    static void declare(Declaration<Parameters>& d) {
      d.add("rings", &Parameters::rings,
            "how many edges away from a vertex the quadric fit of its curvature reaches")
          .between(1, 50)
          .source("Panozzo et al. 2010; libigl's default is 5");
    }
  };

  explicit CurvatureConsistency(const Parameters& parameters) : curvatures_(parameters.rings) {}
  MetricScope scope() const override { return MetricScope::pair; }
  MetricDeclaration declaration() const override {
    MetricDeclaration d;
    d.columns = {{.name = "d_H_fit",
                  .label = "d_H^fit",
                  .unit = "1",
                  .shown = Shown::summary,
                  .error = "d_H_fit",
                  .error_use = ErrorUse::summary},
                 {.name = "d_H_ddg", .label = "d_H^ddg", .unit = "1"},
                 {.name = "d_K_fit", .label = "d_K^fit", .unit = "1/m²"},
                 {.name = "d_K_ddg", .label = "d_K^ddg", .unit = "1/m²"}};
    d.colours = {{.field = "H_difference", .unit = "1/m", .label = "difference in mean curvature"},
                 {.field = "principal_curvature",
                  .other_field = "principal_curvature_other",
                  .unit = "1/m",
                  .label = "folds"}};
    d.text =
        "The squared difference of curvatures is integrated over the rest shape: d_H of mean curvature H "
        "[1/m], dimensionless; d_K of Gaussian curvature K [1/m²], in 1/m². “fit” takes curvatures from "
        "fitted quadrics, “ddg” from dihedral angles (H) and angle defects (K).";
    return d;
  }

 private:
  MetricResult measure(const MetricInput& input) const override {
    const auto of_x = curvatures_.of(input.x, input.level);
    const auto of_other = curvatures_.of(*input.other, input.level);
    const auto& [fit, ddg] = *of_x;
    const auto& [other_fit, other_ddg] = *of_other;

    // The supplement's integral over the parametric domain.
    const auto integral = [&](const Eigen::VectorXd& coarse, const Eigen::VectorXd& fine) {
      return (input.level.vertex_area.array() * (coarse - fine).array().square()).sum();
    };
    return {{{"d_H_fit", integral(other_fit.mean, fit.mean)},
             {"d_H_ddg", integral(other_ddg.mean, ddg.mean)},
             {"d_K_fit", integral(other_fit.gaussian, fit.gaussian)},
             {"d_K_ddg", integral(other_ddg.gaussian, ddg.gaussian)}},
            {{"H_difference", other_fit.mean - fit.mean},
             {"principal_curvature", fit.strongest},
             {"principal_curvature_other", other_fit.strongest}}};
  }

  RecentCurvatures curvatures_;
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Metric, drape::CurvatureConsistency>(
      "curvature_consistency",
      "Integrated squared difference of mean and Gaussian curvature between two states.");
}

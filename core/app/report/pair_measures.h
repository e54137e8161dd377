#pragma once

#include <cmath>

#include "core/app/report/run_data.h"
#include "core/kernel/model/metric.h"

namespace drape {

/// A measure of pairs of levels.
struct PairMeasure {
  const char* name;  ///< in results.json
  const char* html;
  const char* unit;
  OptionalNumber PairValues::*value;
  Better better;

  /// An energy difference may be negative if the final state is no equilibrium: closer to zero is better.
  bool beats(double a, double b) const {
    return better == Better::higher ? a > b : std::abs(a) < std::abs(b);
  }
};

/// In the order of tables; the first four are those of the supplement's Table 1.
inline constexpr PairMeasure pair_measures[] = {
    {"d_H_fit", "d<sub>H</sub><sup>fit</sup>", "1", &PairValues::d_H_fit, Better::lower},
    {"d_H_ddg", "d<sub>H</sub><sup>ddg</sup>", "1", &PairValues::d_H_ddg, Better::lower},
    {"d_K_fit", "d<sub>K</sub><sup>fit</sup>", "1/m²", &PairValues::d_K_fit, Better::lower},
    {"d_K_ddg", "d<sub>K</sub><sup>ddg</sup>", "1/m²", &PairValues::d_K_ddg, Better::lower},
    {"distance_rms", "distance, RMS", "diagonal", &PairValues::distance_rms, Better::lower},
    {"silhouette_overlap", "silhouette overlap", "1", &PairValues::silhouette_overlap, Better::higher},
    {"energy_above_end", "energy above the end", "J", &PairValues::energy_above_end, Better::lower}};
inline constexpr int published_measures = 4;

/// The best value of a measure among methods for one pair of levels. Absent unless at least two values are
/// known and the best one beats that of the scene's initial state: a flat cloth must not win.
OptionalNumber best_of(const PairMeasure& measure, const std::vector<const ConsistencyRecord*>& records);

}  // namespace drape

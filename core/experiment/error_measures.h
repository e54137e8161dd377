#pragma once

#include <array>

namespace drape {

/// The measures of a state's error (docs/errors.md), in the order of errors.csv.
inline constexpr std::array error_measures = {"rms", "hausdorff", "d_H_fit", "silhouette_mismatch",
                                              "energy_gap"};
/// What it is measured against: the finest state of the same method, and the run's reference.
inline constexpr std::array error_targets = {"own", "reference"};
/// What a state's cost is counted in.
inline constexpr std::array error_costs = {"seconds", "iterations", "flops"};

}  // namespace drape

#pragma once

#include <array>

namespace drape {

/// The measures of a state's error (docs/theory/errors.md), in the order of errors.csv.
inline constexpr std::array error_measures = {"rms", "hausdorff", "d_H_fit", "silhouette_mismatch",
                                              "energy_gap"};
/// The states that errors are measured against: the method's own finest one, and the run's reference.
inline constexpr std::array error_targets = {"own", "reference"};
/// The measures of a state's cost.
inline constexpr std::array error_costs = {"seconds", "iterations", "flops"};

}  // namespace drape

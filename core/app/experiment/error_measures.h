#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/app/experiment/declared_metrics.h"

namespace drape {

/// A measure of a state's error (docs/theory/errors.md); errors.csv has a column of it for every target.
struct ErrorMeasure {
  std::string name;   ///< in errors.csv, after the target's
  std::string label;  ///< as MetricColumn::label, with the unit
  ErrorUse use = ErrorUse::plots;
  std::string value;              ///< the metrics' value that it is of; empty for energy_gap
  Better better = Better::lower;  ///< of that value: if higher, the error is 1 − value
};

/// The energy above the target's, over what the cloth releases from the start to the target; the run itself
/// measures it.
inline constexpr const char* energy_gap = "energy_gap";

/// The measures that metrics declare, those that rank first, and the energy gap, last.
std::vector<ErrorMeasure> error_measures(const std::vector<DeclaredMetric>& metrics);

/// The states that errors are measured against: the method's own finest one, and the run's reference.
inline constexpr std::array error_targets = {"own", "reference"};

}  // namespace drape

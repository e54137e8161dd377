#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/app/report/run_data.h"

namespace drape {

/// A quantity of a run's method, by the name that tables and comparisons use.
struct RowQuantity {
  std::string name;  ///< "seconds"
  std::function<OptionalNumber(const RunData& run, const MethodRecord& method)> of;
};

/// Cost and quality of a method's final state and of its preview, the last state of its coarsest level: those
/// that every run has, then the errors that are measured. A final state that is the reference itself has no
/// error against it.
std::vector<RowQuantity> row_quantities(const std::vector<ErrorMeasure>& measures);

}  // namespace drape

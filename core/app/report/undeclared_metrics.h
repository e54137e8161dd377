#pragma once

#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "core/app/experiment/error_measures.h"
#include "core/app/files/csv.h"

namespace drape {

// Results of earlier versions declare no metrics: reports show the values under their plain names, without a
// unit, and call none the best.

/// One metric for each scope, whose columns are the numbers in "methods" that the run itself does not write.
std::vector<DeclaredMetric> undeclared_metrics(const nlohmann::ordered_json& methods);

/// The measures in the header of errors.csv.
std::vector<ErrorMeasure> undeclared_errors(const Csv& errors);

}  // namespace drape

#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/app/report/run_data.h"

namespace drape {

/// The data of a run's charts, as JSON that is safe inside a <script> element: series per method and level
/// (iteration, seconds, force residual, energy above the best; cost and errors), seconds by phase, energy
/// released by part.
std::string chart_data(const RunData& run);

/// A method's name and look (solver_style).
nlohmann::ordered_json method_json(const std::string& name, const std::string& solver);

/// Names and labels of measures of errors.
nlohmann::ordered_json measures_json(const std::vector<ErrorMeasure>& measures);

/// Six digits, enough for drawing; null if absent.
nlohmann::ordered_json rounded(const OptionalNumber& value);

}  // namespace drape

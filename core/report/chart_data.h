#pragma once

#include <string>

#include "core/report/run_data.h"

namespace drape {

/// What the page's script draws, as JSON that is safe inside a <script> element: series per method and
/// level (iteration, seconds, force residual, energy above the best), seconds by phase, energy by part.
std::string chart_data(const RunData& run);

}  // namespace drape

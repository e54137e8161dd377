#pragma once

#include <string>
#include <vector>

#include "core/app/report/run_data.h"
#include "core/kernel/interfaces/level.h"

namespace drape {

/// A page with nothing but the 3D viewer of a run's states; it needs no other file and no network. Throws
/// std::runtime_error with the reason if the run has nothing to show.
std::string viewer_page(const RunData& run);

/// The same of one state x (n×3) [m] of a level, with obstacles.
std::string viewer_page(const std::string& title, const Level& level, const Positions& x,
                        const std::vector<TriangleMesh>& obstacles);

}  // namespace drape

#pragma once

#include <string>
#include <vector>

#include "core/report/run_data.h"

namespace drape {

/// The report's 3D viewer: what goes into the page where it is shown, and the data and scripts at the page's
/// end.
struct ReportView {
  std::string section, scripts;    ///< HTML; both empty where the run has nothing to show
  std::vector<std::string> notes;  ///< what cannot be shown and why, one line each
};

/// Made of the meshes in the run's folder: every level's last state, and recorded snapshots, spread evenly,
/// as far as a few megabytes go.
ReportView report_view(const RunData& run);

/// three.js and the viewer's own scripts, as <script> elements.
std::string viewer_scripts();

}  // namespace drape

#pragma once

#include <string>
#include <vector>

#include "core/app/report/run_data.h"

namespace drape {

/// The report's 3D viewer: its section of the page, and the data and scripts at the page's end.
struct ReportView {
  std::string section, scripts;    ///< HTML; both empty if there is nothing to show
  std::vector<std::string> notes;  ///< what cannot be shown, with reasons, one line each
};

/// The viewer of the meshes in the run's folder: every level's last state and, up to a few megabytes, evenly
/// chosen snapshots.
ReportView report_view(const RunData& run);

}  // namespace drape

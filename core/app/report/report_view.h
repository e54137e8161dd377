#pragma once

#include <string>
#include <vector>

#include "core/app/files/json_file.h"
#include "core/app/report/run_data.h"

namespace drape {

/// What the page's 3D view shows of a run.
struct ReportView {
  Json document;                   ///< as ViewDocument makes it; null if there is nothing to show
  std::string blocks;              ///< elements of block_element
  std::vector<std::string> notes;  ///< what cannot be shown, with reasons, one line each
};

/// The meshes in the run's folder: every level's last state and, up to a few megabytes, evenly chosen
/// snapshots.
ReportView report_view(const RunData& run);

}  // namespace drape

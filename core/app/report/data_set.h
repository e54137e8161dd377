#pragma once

#include "core/app/report/run_export.h"
#include "core/app/report/run_table.h"

namespace drape {

/// Writes the ends of all runs of a sweep that pass as a data set into a folder: NAME.obj as export_run does,
/// with NAME.json, which has the run's row of the table, the experiment, and the fields at the vertices of
/// the OBJ; obstacles as OBJ, each once; index.csv, the table with the names of the files; and index.html,
/// the sweep's page. Returns the table. Throws std::runtime_error with one line as export_run does.
RunTable export_data_set(const std::filesystem::path& sweep, const std::filesystem::path& folder,
                         const ExportOptions& options);

}  // namespace drape

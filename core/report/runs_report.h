#pragma once

#include <filesystem>
#include <vector>

namespace drape {

/// Writes one page about several runs, or the runs of sweeps, that needs no other file; it links to the runs'
/// own reports where they are. Throws std::runtime_error with one line for a folder that is neither a run nor
/// a sweep, and when `page` cannot be written.
void write_runs_report(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& page);

}  // namespace drape

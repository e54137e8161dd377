#pragma once

#include <filesystem>
#include <vector>

namespace drape {

/// Writes one self-contained page about several runs, or the runs of sweeps; it links to the runs' own
/// reports. Throws std::runtime_error with one line for a folder that is neither a run nor a sweep, when
/// `page` is a file already that is none of drape's pages, and when it cannot be written.
void write_runs_report(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& page);

}  // namespace drape

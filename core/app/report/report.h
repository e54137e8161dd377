#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/app/report/run_data.h"
#include "core/kernel/interfaces/level.h"

namespace drape {

/// Writes DIR/report.html, one page that needs no other file and no network, and DIR/pictures/*.png from
/// what a finished or interrupted run has left in DIR (results.json, iterations.csv, errors.csv, config.yaml,
/// levels/, fields/, rest/). Pictures are `picture_width` (default: 900) pixels wide, and skipped once
/// `cancelled` (may be empty) returns true. Returns what could not be drawn, one line each. Throws
/// std::runtime_error with one line if DIR has no readable results.json or is not writable.
std::vector<std::string> write_report(const std::filesystem::path& run_directory,
                                      const std::function<bool()>& cancelled = {},
                                      std::optional<int> picture_width = {});

/// Throws std::runtime_error, which ends in the remedy, for a page that is there and not one of drape's: its
/// title says so.
void refuse_other_file(const std::filesystem::path& page, const std::string& remedy);

/// Writes a page about several runs and sweeps. Throws std::runtime_error with one line for a folder that is
/// neither, and for a page that is there and not one of drape's.
void write_runs_report(const std::vector<std::filesystem::path>& folders, const std::filesystem::path& page);

/// Whether a page is there that is not older than these results.
bool is_current(const std::filesystem::path& page, const std::filesystem::path& results);

/// The 3D view of a run.
struct ReportView {
  Json document;       ///< as ViewDocument makes it; null if there is nothing to show
  std::string blocks;  ///< those of embedded_in
};

/// The meshes in the run's folder: every level's last state and, up to a few megabytes, evenly chosen
/// snapshots. Adds to the notes what cannot be shown, with reasons, one line each.
ReportView report_view(const RunData& run, std::vector<std::string>& notes);

/// A page with nothing but the 3D view of a run's states. Throws std::runtime_error with the reason if the
/// run has nothing to show.
std::string viewer_page(const RunData& run);

/// A page with nothing but the 3D view of one state x (n×3) [m] of a level, with obstacles. `pressure` is
/// LevelModel::contact_pressure; empty, the page has no colours of contact.
std::string viewer_page(const std::string& title, const Level& level, const Positions& x,
                        const std::vector<TriangleMesh>& obstacles, const Eigen::VectorXd& pressure = {});

}  // namespace drape

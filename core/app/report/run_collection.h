#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/app/files/json_file.h"
#include "core/app/report/run_data.h"

namespace drape {

/// One of several runs: a variation with a seed.
struct RunRecord {
  std::string sweep;      ///< its name; empty for a run by itself
  std::string name;       ///< of its variation
  std::string variation;  ///< the same, preceded by the sweep where there are several
  Json settings;          ///< the values of a sweep's varied keys, by path
  OptionalNumber seed;
  std::string status;  ///< as sweep.json has it: "converged", "not_converged", "failed", …
  std::string error;   ///< message of a failed run
  int exit_code = 0;   ///< exit code of its process
  std::string expected = "converged", expected_message;  ///< expected outcome, and a part of the message
  std::filesystem::path folder;                          ///< relative to the current folder
  std::optional<RunData> data;                           ///< empty without results

  /// Whether a method has results; otherwise the run has one row in tables, without a method.
  bool has_methods() const { return data && !data->methods.empty(); }
};

/// Runs that are reported together: those of a sweep, or of several folders.
struct RunCollection {
  std::string name, description;
  bool complete = true;
  std::vector<RunRecord> runs;

  /// What the metrics of all runs declare, in order of appearance.
  std::vector<DeclaredMetric> metrics() const;
  /// The measures of errors of all runs; without any results, the energy gap.
  std::vector<ErrorMeasure> error_measures() const { return drape::error_measures(metrics()); }
};

/// Whether it is a sweep's folder.
bool is_sweep(const std::filesystem::path& folder);

/// Throws std::runtime_error with one line for a folder that is neither a run's nor a sweep's.
void require_run_or_sweep(const std::filesystem::path& folder);

/// Reads runs and sweeps, each by its folder or by the folder that has theirs in it. Runs whose configs
/// differ only by the seed form a variation, which is named after the experiment or, where variations share
/// that, after its first folder. Throws std::runtime_error with one line for a folder that is neither a run
/// nor a sweep and has none in it.
RunCollection read_runs(const std::vector<std::filesystem::path>& given);

}  // namespace drape

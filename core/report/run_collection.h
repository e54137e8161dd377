#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/report/run_data.h"

namespace drape {

/// One of several runs: a variation with one seed.
struct RunRecord {
  std::string sweep;  ///< its name; empty for a run by itself
  std::string variation;
  OptionalNumber seed;
  std::string status;  ///< as sweep.json has it: "converged", "ended", "failed", …
  std::string error;   ///< of a failed one
  int exit_code = 0;   ///< of its process
  std::string expected = "converged", expected_message;  ///< how it is to end, and a part of what it says
  std::filesystem::path folder;                          ///< as it is found from here
  std::optional<RunData> data;                           ///< of a run that has written results

  bool refused() const;  ///< before anything was computed
};

/// Runs that are looked at together: those of a sweep, or some folders.
struct RunCollection {
  std::string name;
  bool complete = true;
  std::vector<RunRecord> runs;

  std::vector<std::string> variations() const;  ///< in order of appearance
  std::vector<std::string> methods() const;     ///< likewise
  std::vector<const RunRecord*> of(const std::string& variation) const;
};

/// Whether the folder is a sweep's.
bool is_sweep(const std::filesystem::path& folder);

/// Reads sweeps and runs together. Runs that are of one experiment but for the seed are one variation, named
/// by the experiment; where others have that name too, by the folder. Throws std::runtime_error with one line
/// for a folder that is neither a run nor a sweep.
RunCollection read_runs(const std::vector<std::filesystem::path>& folders);

}  // namespace drape

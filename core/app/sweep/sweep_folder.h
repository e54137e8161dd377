#pragma once

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "core/app/files/file_lock.h"
#include "core/app/sweep/run_status.h"
#include "core/app/sweep/sweep.h"

namespace drape {

/// A sweep's results folder: sweep.json, and under runs/ each run's folder and files. sweep.json is derived
/// from the runs' own status files.
class SweepFolder {
 public:
  explicit SweepFolder(std::filesystem::path path) : path_(std::move(path)) {}

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path slurm() const { return path_ / "slurm"; }
  std::filesystem::path jobs() const { return slurm() / "jobs.json"; }  ///< the submitted ones
  RunFiles files(const std::string& folder) const { return {path_ / folder}; }

  /// Locks the folder, which is made if necessary, for this process and its runs. Throws std::runtime_error,
  /// naming the process, if another one holds it.
  std::unique_ptr<FileLock> lock() const;
  /// Throws std::runtime_error for a folder that holds something, and no sweep.
  void refuse_foreign() const;
  /// The runs' statuses by their results. Throws for other contents, as prepare does, and writes nothing.
  std::vector<RunStatus> checked_statuses(const Sweep& sweep, int threads) const;
  /// Prepares the folder for a sweep: updates the statuses of interrupted runs and writes every run's config
  /// and sweep.json. Returns the indices of the runs without results; failed ones only with `retry_failed`,
  /// expected refusals never. Throws std::runtime_error for a folder with other contents, with runs of a
  /// different experiment or number of threads. Only under its lock.
  std::vector<std::size_t> prepare(const Sweep& sweep, int threads, bool retry_failed) const;
  /// Writes sweep.json again.
  void refresh() const;
  /// As `refresh`, when no run is active: also resolves runs that are still marked as running.
  void finalize() const;
  /// sweep.json; null if there is none. Throws std::runtime_error, with file, key and remedy, if it has
  /// another form.
  Json find() const;
  Json read() const;  ///< as find; refuses a folder without

 private:
  /// Writes this sweep.json with every run's status.
  void write(Json json) const;
  std::filesystem::path path_;
};

/// Whether a run was refused before any computation, for the reason that its sweep expects.
inline bool refused_as_expected(const Expectation& expect, const RunStatus& status) {
  return status.refused() && expect.status == "refused" &&
         status.error.find(expect.message) != std::string::npos;
}

/// Estimates the peak memory of runs: that of the largest finished run with as many vertices and levels, or
/// estimated_memory without one.
class MemoryEstimate {
 public:
  /// Learns from every run of the sweep that has finished.
  MemoryEstimate(const Sweep& sweep, const SweepFolder& folder);
  void learn(const SweepRun& run, const RunFiles& files);  ///< from a finished run's results
  double bytes(const SweepRun& run) const;
  /// Throws std::runtime_error if one of the sweep's runs without results may need more than the machine's
  /// bytes.
  void require(const Sweep& sweep, const SweepFolder& folder, double machine) const;

 private:
  std::map<std::pair<double, int>, double> peaks_;  // by vertices of the finest level, levels
};

/// Executes the missing runs of a sweep, several at a time, each in its own process. Keeps sweep.json up to
/// date and reports progress on standard error. A failed run does not stop the others. On `stop`, running
/// ones save their state and exit, and no further ones start.
void run_locally(const Sweep& sweep, const SweepFolder& folder, const std::vector<std::size_t>& missing,
                 const SweepOptions& options);

/// "3.2 s", "4 min", "1.5 h"
std::string duration_text(double seconds);

/// The runs of a folder's sweep for the terminal: variation, seed, status, seconds, and the messages of
/// failed ones.
std::string list_of_runs(const SweepFolder& folder);

}  // namespace drape

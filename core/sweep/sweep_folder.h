#pragma once

#include "core/experiment/file_lock.h"
#include "core/sweep/run_status.h"
#include "core/sweep/sweep.h"

namespace drape {

/// A sweep's results folder: sweep.json, and under runs/ each run's folder and files. What is true of a run
/// stands in its own status; sweep.json is made of those.
class SweepFolder {
 public:
  explicit SweepFolder(std::filesystem::path path) : path_(std::move(path)) {}

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path slurm() const { return path_ / "slurm"; }
  std::filesystem::path jobs() const { return slurm() / "jobs.json"; }  ///< those in Slurm's queue
  RunFiles files(const std::string& folder) const { return {path_ / folder}; }

  /// Makes the folder ready for a sweep: refuses, by std::runtime_error, one that holds something else, runs
  /// of an experiment that the sweep no longer has, or with other threads; settles what was running;
  /// writes every run's config and sweep.json. Only under a FolderLock.
  void prepare(const Sweep& sweep, int threads) const;
  /// Which of the sweep's runs have no results; a failed one only if it is to be tried again.
  std::vector<std::size_t> missing(const Sweep& sweep, bool retry_failed) const;
  /// Writes sweep.json again with every run's status, and returns it.
  nlohmann::ordered_json refresh() const;
  /// As `refresh`, once nothing of the sweep runs any more: what is still marked as running is settled.
  nlohmann::ordered_json settle() const;
  /// sweep.json; null if there is none. Throws std::runtime_error where it lacks what names a run.
  nlohmann::ordered_json read() const;

 private:
  void refuse_other_runs(const Sweep& sweep, int threads) const;
  std::filesystem::path path_;
};

/// Holds a sweep's folder for one process and the runs it starts.
class FolderLock {
 public:
  /// Makes the folder if need be. Throws std::runtime_error, naming the process, if another one holds it.
  explicit FolderLock(const std::filesystem::path& folder);

 private:
  FileLock lock_;
};

/// The runs of sweep.json for the terminal: variation, seed, status, seconds, and what failed ones said.
std::string list_of_runs(const nlohmann::ordered_json& sweep);

}  // namespace drape

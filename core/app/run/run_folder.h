#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/app/files/file_lock.h"

namespace drape {

/// Makes the folder of a run or a sweep and its parents. Throws std::runtime_error, which names --out.
void make_results_folder(const std::filesystem::path& folder);

/// Throws std::runtime_error if paths of a run of these methods would be too long for the system.
void refuse_long_paths(const std::filesystem::path& folder, const std::vector<std::string>& methods);

/// A run's results folder. Files are written under a temporary name and renamed: a final name never has an
/// incomplete file.
class RunFolder {
 public:
  /// Creates the folder and removes the results of an earlier run. Throws std::runtime_error, without a
  /// change, if the folder is not writable, is a sweep's, has results and `overwrite` is false, has foreign
  /// files with names of a run, or if one of the `inputs`, which the new run reads, is among the results.
  /// Throws WriteError if a later write fails.
  RunFolder(std::filesystem::path path, bool overwrite, const std::vector<std::filesystem::path>& inputs);
  /// The folder of a run to be resumed. Throws std::runtime_error if it has no run, or one that is still
  /// running.
  static RunFolder of_run(std::filesystem::path path);

  /// Removes what a process that was killed has not written to its end. Throws WriteError.
  void remove_unfinished() const;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path file(const std::string& name) const { return path_ / name; }

 private:
  explicit RunFolder(std::filesystem::path path) : path_(std::move(path)) {}
  void lock();

  std::filesystem::path path_;
  std::unique_ptr<FileLock> lock_;  // locked while the run proceeds
};

}  // namespace drape

#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/experiment/file_lock.h"

namespace drape {

/// Throws std::runtime_error where a run of these methods would have files there whose names or paths are
/// longer than the file system takes.
void refuse_long_names(const std::filesystem::path& folder, const std::vector<std::string>& methods);

/// A run's results folder. Whole files are written under another name and renamed, so that nothing
/// half-written stands under a final name.
class RunFolder {
 public:
  /// Makes the folder, and takes away what an earlier run has left in it. Throws std::runtime_error, with
  /// everything as it was, when it cannot be written to, when there is something left and `overwrite` is
  /// false, or when it holds files of others under the names that a run uses. Throws WriteError when it can
  /// no longer be written to after that.
  RunFolder(std::filesystem::path path, bool overwrite);
  /// The folder of a run that is to go on. Throws std::runtime_error when it holds none, or one that a
  /// process is still at.
  static RunFolder of_run(std::filesystem::path path);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path file(const std::string& name) const { return path_ / name; }
  void write_text(const std::string& name, const std::string& text) const;

 private:
  explicit RunFolder(std::filesystem::path path) : path_(std::move(path)) {}
  void lock();

  std::filesystem::path path_;
  std::unique_ptr<FileLock> lock_;  // held as long as the run is under way
};

}  // namespace drape

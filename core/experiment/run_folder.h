#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/experiment/file_lock.h"

namespace drape {

/// Writes a whole file under another name and renames it. Throws std::runtime_error where that cannot be.
void write_atomically(const std::filesystem::path& file, const std::string& text);

/// A run's results folder. Whole files are written under another name and renamed, so that nothing
/// half-written stands under a final name.
class RunFolder {
 public:
  /// Makes the folder, and takes away what an earlier run has left in it. Throws std::runtime_error when it
  /// cannot be written to, when there is something left and `overwrite` is false, or when it holds files of
  /// others under the names that a run uses.
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

#pragma once

#include <filesystem>
#include <string>

namespace drape {

/// A file that one process at a time locks. Its child processes inherit the lock, which is released when the
/// last of them has exited.
class FileLock {
 public:
  /// Creates the file if necessary. Throws std::runtime_error if that fails.
  explicit FileLock(const std::filesystem::path& file);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  bool acquire(double patience);  ///< waits up to this many seconds; whether it succeeded
  std::string holder() const;     ///< "process 17 on host"

 private:
  std::filesystem::path name_;
  int file_ = -1;
};

}  // namespace drape

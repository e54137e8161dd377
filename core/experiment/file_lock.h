#pragma once

#include <filesystem>
#include <string>

namespace drape {

/// A file that one process at a time holds. The processes it starts hold it too, so that it is free only when
/// the last of them has ended, however that came.
class FileLock {
 public:
  /// Makes the file if need be. Throws std::runtime_error where that cannot be.
  explicit FileLock(const std::filesystem::path& file);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

  bool acquire(double patience);  ///< whether it was free within so many seconds
  std::string holder() const;     ///< "process 17 on host"

 private:
  std::filesystem::path name_;
  int file_ = -1;
};

}  // namespace drape

#pragma once

#include <filesystem>
#include <string>

namespace drape {

/// Writes a whole file under another name and renames it. Throws std::runtime_error where that cannot be.
void write_atomically(const std::filesystem::path& file, const std::string& text);

/// A run's results folder. Whole files are written under another name and renamed, so that nothing
/// half-written stands under a final name.
class RunFolder {
 public:
  /// Makes the folder. Throws std::runtime_error when it cannot be written to, or when it holds results
  /// already and `overwrite` is false, or other files under the names that a run uses; with `overwrite`, an
  /// earlier run's files in it are removed.
  RunFolder(std::filesystem::path path, bool overwrite);

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path file(const std::string& name) const { return path_ / name; }
  void write_text(const std::string& name, const std::string& text) const;

 private:
  std::filesystem::path path_;
};

}  // namespace drape

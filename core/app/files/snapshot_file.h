#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// States of one level in a file: positions as little-endian float32, state by state, row by row.
class SnapshotFile {
 public:
  SnapshotFile() = default;  ///< without states
  /// Reads a file of `count` states of n vertices. Throws std::runtime_error if it is missing, has another
  /// size or another checksum than the recorded one, if there is one.
  SnapshotFile(const std::filesystem::path& file, std::size_t count, Eigen::Index n,
               std::optional<std::uint32_t> checksum);

  std::size_t count() const { return count_; }
  /// n×3 [m]
  Positions positions(std::size_t state) const;

  /// A state's part of the file.
  static std::string bytes_of(const Positions& x);

 private:
  std::string bytes_;
  std::size_t count_ = 0;
  Eigen::Index n_ = 0;
};

}  // namespace drape

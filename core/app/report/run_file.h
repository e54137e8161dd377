#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "core/app/files/json_file.h"
#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// A file of a run's folder: every result that results.json names is read through it.
struct RunFile {
  std::filesystem::path path;             ///< with the run's folder; empty for none
  std::optional<std::uint32_t> checksum;  ///< of its bytes, where that is recorded

  /// The file that a record of results.json names by `key`; none without a name. Throws std::runtime_error
  /// for a name that leads out of the run's folder.
  static RunFile of(const JsonFile& results, const Json& record, const char* key,
                    const char* checksum_key = "");

  bool is_named() const { return !path.empty(); }
  /// Whether the file is there.
  bool exists() const;
  /// Whether these bytes have the recorded checksum, if there is one.
  bool fits(std::string_view bytes) const;
  /// Its bytes. Throws std::runtime_error if it cannot be read, or if its checksum is not the recorded one.
  std::string bytes() const;
  /// The PLY that it is. Throws std::runtime_error as bytes() and read_mesh do.
  TriangleMesh mesh() const;
  /// The fields of that PLY. Throws std::runtime_error as bytes() and read_ply_fields do.
  VertexFields fields() const;
};

}  // namespace drape

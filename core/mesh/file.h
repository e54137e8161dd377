#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace drape {

/// The whole file as bytes. Throws std::runtime_error naming the path and the cause.
std::string read_file(const std::filesystem::path& path);

/// Writes path + ".part" and renames it, so that nothing half-written stands under the final name.
/// Throws std::runtime_error naming the path and the cause; the part is then removed.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Returns once what has been written to a file or folder is on the disk, where the system can say so.
void sync_to_disk(const std::filesystem::path& path);

}  // namespace drape

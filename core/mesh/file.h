#pragma once

#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace drape {

/// A file that cannot be read. `what()` names it; `cause` alone does not.
struct FileError : std::runtime_error {
  FileError(const std::string& message, std::string cause)
      : std::runtime_error(message), cause(std::move(cause)) {}
  std::string cause;
};

/// The most that is read of a file [bytes]: of any, and of a config.
inline constexpr std::uintmax_t largest_file = 2'000'000'000, largest_config = 8'000'000;

/// A file or folder cannot be written: the disk is full, the folder is gone, or the like. Whatever wants to
/// write it cannot go on, while other errors concern only what threw them.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The whole file as bytes. Every file that a user names or can change is read by this. Throws FileError,
/// without waiting, for what is no regular file (pipes and devices may give bytes for ever) or has more than
/// `most` bytes.
std::string read_file(const std::filesystem::path& path, std::uintmax_t most = largest_file);

/// Writes path + ".part" and renames it, so that nothing half-written stands under the final name.
/// Throws WriteError naming the path and the cause; the part is then removed.
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// As write_file, unless the file has these bytes already. Whether it had others, or was not there.
bool write_where_other(const std::filesystem::path& path, std::string_view bytes);

/// Makes the folder, and those above it, where need be. Throws WriteError.
void make_folder(const std::filesystem::path& path);

/// Replaces what has the new name. Throws WriteError.
void rename_file(const std::filesystem::path& from, const std::filesystem::path& to);

/// CRC-32.
std::uint32_t checksum_of(std::string_view bytes);

/// Returns once what has been written to a file or folder is on the disk, where the system can say so.
void sync_to_disk(const std::filesystem::path& path);

}  // namespace drape

#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <string_view>

namespace drape {

static_assert(std::endian::native == std::endian::little, "binary files hold numbers as memory does");

/// Appends a number as memory holds it.
template <class Number>
void append_bytes(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// A file that cannot be read. `what()` names it; `cause` alone does not.
struct FileError : std::runtime_error {
  FileError(const std::string& message, std::string cause)
      : std::runtime_error(message), cause(std::move(cause)) {}
  std::string cause;
};

/// Throws std::runtime_error with the file's or folder's name and what is wrong: "out: holds no run; …".
[[noreturn]] void refuse_path(const std::filesystem::path& path, const std::string& fault);

/// Largest file to be read [bytes]: of any kind, and of a config.
inline constexpr std::uintmax_t largest_file = 2'000'000'000, largest_config = 8'000'000;

/// A file or folder cannot be written, as on a full disk. It ends the run, where other errors end only the
/// method that threw them.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  WriteError(const std::filesystem::path& path, int error);  ///< of this errno
};

/// The whole file as bytes. Every file that a user names or can change goes through this function. Throws
/// FileError, without blocking, for a file that is not regular (a pipe) or larger than `most` bytes.
std::string read_file(const std::filesystem::path& path, std::uintmax_t most = largest_file);

enum class Existing { replaced, kept };  ///< what becomes of a file that has the name already

/// Writes each file of drape's own: under a name that no file has, path + ".part" or path + ".1.part", which
/// is renamed. No file is ever incomplete, and nothing that was there is written into, nor followed as a
/// link. Throws WriteError, after removing the part; also if the name is taken and `existing` is kept.
void write_file(const std::filesystem::path& path, std::string_view bytes,
                Existing existing = Existing::replaced);

/// Makes the folder and its parents if they do not exist. Throws WriteError, also for a link in its place.
void make_folder(const std::filesystem::path& path);

/// Renames a file; replaces one of the new name. Throws WriteError.
void rename_file(const std::filesystem::path& from, const std::filesystem::path& to);

/// The CRC-32 of the bytes.
std::uint32_t checksum_of(std::string_view bytes);

/// Flushes a file or folder to the disk (fsync), where the system supports it.
void sync_to_disk(const std::filesystem::path& path);

}  // namespace drape

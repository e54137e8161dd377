#include "core/kernel/files/file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <cerrno>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <system_error>

#include "core/kernel/files/message_text.h"

namespace drape {
namespace {

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;

struct Descriptor {
  int number;
  ~Descriptor() {
    if (number >= 0) close(number);
  }
};

}  // namespace

WriteError::WriteError(const std::filesystem::path& path, int error)
    : runtime_error("cannot write " + path.string() + ": " + std::generic_category().message(error)) {}

void refuse_path(const std::filesystem::path& path, const std::string& fault) {
  throw std::runtime_error(path.string() + ": " + fault);
}

std::string read_file(const std::filesystem::path& path, std::uintmax_t most) {
  const std::string name = printable(path.string());
  const auto refuse = [&](const std::string& cause) { throw FileError(name + ": " + cause, cause); };
  if (path.native().find('\0') != std::string::npos) refuse("has a NUL character in its name");
  const auto refuse_number = [&](int error) {
    const std::string reason = std::generic_category().message(error);
    throw FileError("cannot read " + name + ": " + reason,
                    error == ENOENT ? "no such file" : "cannot be read (" + reason + ")");
  };
  // Opening a pipe without a writer would block.
  const Descriptor file{open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC)};
  struct stat status {};
  if (file.number < 0 || fstat(file.number, &status) != 0) refuse_number(errno);
  if (S_ISDIR(status.st_mode)) refuse("is a folder, not a file");
  if (!S_ISREG(status.st_mode)) refuse("is a pipe or a device; give a file on a disk");
  const auto refuse_if_larger = [&](std::uintmax_t size) {
    if (size > most)
      refuse("is larger than " + std::to_string(most / 1'000'000) + " MB, the most that is read of it");
  };
  // The size is a hint: /proc says 0, also of what has no end, and a file may grow.
  std::string bytes;
  refuse_if_larger(static_cast<std::uintmax_t>(status.st_size));
  bytes.reserve(static_cast<std::size_t>(status.st_size));
  most = std::min<std::uintmax_t>(most, bytes.capacity() + 16'000'000);
  char buffer[1 << 16];
  while (true) {
    const ssize_t n = read(file.number, buffer, sizeof buffer);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) refuse_number(errno);
    if (n == 0) return bytes;
    bytes.append(buffer, static_cast<std::size_t>(n));
    refuse_if_larger(bytes.size());
  }
}

void write_file(const std::filesystem::path& path, std::string_view bytes, Existing existing) {
  std::string part;
  File file;
  for (int k = 0; !file; ++k) {
    part = path.string() + (k > 0 ? "." + std::to_string(k) : "") + ".part";
    file.reset(std::fopen(part.c_str(), "wbxe"));  // x: no file is opened that was there, and no link
    if (!file && errno != EEXIST) throw WriteError(path, errno);
  }
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
  const bool closed = std::fclose(file.release()) == 0;  // the last bytes may fail only here
  const bool whole = written && closed, kept = existing == Existing::kept;
  // Unlike a rename, a second name replaces nothing; some file systems do not have such names.
  const bool named = whole && kept && link(part.c_str(), path.c_str()) == 0;
  if (whole && !named && !(kept && errno == EEXIST) && std::rename(part.c_str(), path.c_str()) == 0) return;
  const int error = errno;
  std::remove(part.c_str());
  if (!named) throw WriteError(path, error);
}

void make_folder(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw WriteError(path, error.value());
  if (std::filesystem::is_symlink(path)) throw WriteError(path.string() + ": is a link; make it a folder");
}

void rename_file(const std::filesystem::path& from, const std::filesystem::path& to) {
  if (std::rename(from.c_str(), to.c_str()) != 0) throw WriteError(to, errno);
}

std::uint32_t checksum_of(std::string_view bytes) {
  boost::crc_32_type checksum;
  checksum.process_bytes(bytes.data(), bytes.size());
  return checksum.checksum();
}

void sync_to_disk(const std::filesystem::path& path) {
  const Descriptor file{open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  if (file.number < 0) throw WriteError(path, errno);
  // EINVAL, EROFS: there is nothing behind this file that could be flushed.
  if (fsync(file.number) != 0 && errno != EINVAL && errno != EROFS) throw WriteError(path, errno);
}

}  // namespace drape

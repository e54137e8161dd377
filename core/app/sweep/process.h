#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace drape {

/// How a process ended: its exit code, or 128 + the signal that ended it.
struct Exit {
  int code = 0;
  int signal = 0;  ///< 0 if it exited by itself
};

/// A child in its own process group: a terminal's Ctrl-C does not reach it. The kernel kills it if this
/// process dies.
class Process {
 public:
  /// Runs a program (found on PATH if it has no slash), standard output and error into the files. Throws
  /// std::runtime_error if that fails.
  Process(const std::vector<std::string>& words, const std::filesystem::path& out,
          const std::filesystem::path& err);

  /// How it ended, or empty while it runs; not to be called again after that.
  std::optional<Exit> poll() const;
  Exit wait() const;
  void signal(int number) const;
  std::int64_t resident_bytes() const;  ///< 0 if unknown

 private:
  pid_t pid_ = -1;
};

/// The exit status and output of a program.
struct ProgramOutput {
  Exit exit;
  std::string out, err;
};

/// Runs a program to its end; 127 if it does not exist.
ProgramOutput run_program(const std::vector<std::string>& words);

/// The executable file of this process.
std::filesystem::path own_program();
/// Whether that file, or since the first call a library of this process, such as a plugin, was removed or
/// replaced.
bool own_program_replaced();

/// A file's text; empty without the file.
std::string text_of_file(const std::filesystem::path& file);

}  // namespace drape

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
  int signal = 0;  ///< 0 if it ended by itself
};

/// A child in a process group of its own, so that a terminal's Ctrl-C does not reach it, which the kernel
/// kills should this process die.
class Process {
 public:
  /// Runs a program (found on PATH if it has no slash), standard output and error into the files. Throws
  /// std::runtime_error where that cannot be.
  Process(const std::vector<std::string>& words, const std::filesystem::path& out,
          const std::filesystem::path& err);

  /// How it ended, or nothing while it runs; not asked again after that.
  std::optional<Exit> poll() const;
  Exit wait() const;
  void signal(int number) const;
  std::int64_t resident_bytes() const;  ///< 0 where the kernel does not tell

 private:
  pid_t pid_ = -1;
};

/// What a program said, once it has ended.
struct Said {
  Exit exit;
  std::string out, err;
};

/// Runs a program to its end. One that is not there ends with 127.
Said run_program(const std::vector<std::string>& words);

/// The file of the running program.
std::filesystem::path own_program();

/// A whole file's text; empty where there is none.
std::string text_of_file(const std::filesystem::path& file);

}  // namespace drape

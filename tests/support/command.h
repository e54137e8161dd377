#pragma once

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

/// An empty folder that goes away with the object.
struct Scratch {
  Scratch() {
    std::string name = (std::filesystem::temp_directory_path() / "drape_test_XXXXXX").string();
    REQUIRE(mkdtemp(name.data()));
    path = name;
  }
  ~Scratch() { std::filesystem::remove_all(path); }
  Scratch(const Scratch&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path / name; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name, std::ios::binary) << text;
  }

  std::filesystem::path path;
};

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  INFO(file);
  REQUIRE(stream);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// How a command ended; a signal's exit code is 128 + its number, as in a shell.
struct Ended {
  int exit_code = -1;
  std::string out, err;
};

/// A shell command that runs in a folder, in a process group of its own. One still running when the object
/// goes away is killed.
class Command {
 public:
  Command(const std::string& line, const std::filesystem::path& folder) {
    pid_ = fork();
    REQUIRE(pid_ >= 0);
    if (pid_ == 0) {
      setpgid(0, 0);
      unsetenv("DRAPE_PLUGIN_PATH");
      const bool ready = chdir(folder.c_str()) == 0 && redirect("/dev/null", O_RDONLY, 0) &&
                         redirect(output_.path / "out", O_WRONLY | O_CREAT, 1) &&
                         redirect(output_.path / "err", O_WRONLY | O_CREAT, 2);
      if (ready) execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
      _exit(126);
    }
    setpgid(pid_, pid_);  // whoever of the two comes first
  }
  ~Command() {
    if (pid_ <= 0) return;
    send(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  Command(const Command&) = delete;

  void send(int signal) const { kill(-pid_, signal); }

  /// Fails the test case when it takes longer than so many seconds.
  Ended wait(double seconds = 60) {
    int status = 0;
    const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (waitpid(pid_, &status, WNOHANG) == 0) {
      if (std::chrono::steady_clock::now() > until) FAIL("the command takes more than " << seconds << " s");
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    pid_ = 0;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text_of(output_ / "out"),
            text_of(output_ / "err")};
  }

 private:
  static bool redirect(const std::filesystem::path& file, int flags, int to) {
    const int from = open(file.c_str(), flags, 0600);
    return from >= 0 && dup2(from, to) == to;
  }

  Scratch output_;
  pid_t pid_ = 0;
};

inline const std::string drape_command = DRAPE_BUILD_BIN_DIR "/drape";

/// `drape` with these arguments, in that folder, to its end.
inline Ended drape_with(const std::string& arguments, const std::filesystem::path& folder,
                        const std::string& environment = "") {
  INFO("drape " << arguments);
  return Command("exec env " + environment + " " + drape_command + " " + arguments, folder).wait();
}

/// The text with its one occurrence of `from` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  INFO("replacing \"" << from << "\"");
  REQUIRE(at != std::string::npos);
  REQUIRE(text.find(from, at + 1) == std::string::npos);
  return text.replace(at, from.size(), to);
}

/// Three methods on a square of 6 × 6 vertices and 2 levels.
inline std::string small_experiment() {
  return text_of(std::filesystem::path(DRAPE_SOURCE_DIR) / "tests/configs/data/small.yaml");
}

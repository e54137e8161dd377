#pragma once

#include <fcntl.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/folders.h"
#include "tests/support/time_limit.h"

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

/// Many times what any command of the tests takes.
inline const TimeLimit command_limit{120 * test_slowdown(), 60};

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
    for (const char* stream : {"out", "err"})
      output_.write(stream, "");  // it may be killed before it opens them
    pid_ = fork();
    REQUIRE(pid_ >= 0);
    if (pid_ == 0) {
      setpgid(0, 0);
      prctl(PR_SET_PDEATHSIG, SIGKILL);  // when the test itself is killed
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

  /// Nothing where it has ended already.
  void send(int signal) const {
    if (pid_ > 0) kill(-pid_, signal);
  }
  /// Whether a signal that was sent has still to be delivered: until then another of its kind would be lost.
  bool has_pending(int signal) const {
    const std::string status = text_of("/proc/" + std::to_string(pid_) + "/status");
    const std::string mask = "ShdPnd:\t";
    return std::stoull(status.substr(status.find(mask) + mask.size(), 16), nullptr, 16) >> (signal - 1) & 1;
  }

  /// Fails the test case when the command takes more than the limit.
  Ended wait(const TimeLimit& limit = command_limit) {
    TimeTaken taken(pid_);
    while (!has_ended()) pause(taken, limit);
    return {WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_), text_of(output_ / "out"),
            text_of(output_ / "err")};
  }

  /// Waits until the condition holds that the command is to bring about; fails the test case when the command
  /// ends without, or takes more than the limit.
  void wait_until(const std::string& what, const std::function<bool()>& condition,
                  const TimeLimit& limit = command_limit) {
    INFO("waiting until " << what);
    TimeTaken taken(pid_);
    for (bool ended = false; !condition(); ended = has_ended()) {
      if (ended) FAIL("the command ended before");
      pause(taken, limit);
    }
  }

 private:
  static bool redirect(const std::filesystem::path& file, int flags, int to) {
    const int from = open(file.c_str(), flags, 0600);
    return from >= 0 && dup2(from, to) == to;
  }

  bool has_ended() {
    if (pid_ > 0 && waitpid(pid_, &status_, WNOHANG) != 0) pid_ = 0;
    return pid_ == 0;
  }

  static void pause(TimeTaken& taken, const TimeLimit& limit) {
    taken.look();
    const std::string excess = taken.excess(limit);
    if (!excess.empty()) FAIL("the command " << excess);
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }

  Scratch output_;
  pid_t pid_ = 0;
  int status_ = 0;
};

inline const std::string drape_command = folders::commands() + "/drape";

/// `drape` with these arguments, in that folder, to its end.
inline Ended drape_with(const std::string& arguments, const std::filesystem::path& folder,
                        const std::string& environment = "") {
  INFO("drape " << arguments);
  return Command("exec env " + environment + " " + drape_command + " " + arguments, folder).wait();
}

/// Standard error of what must be refused without a word on standard output.
inline std::string refused_by(const std::string& arguments, const std::filesystem::path& folder,
                              const std::string& environment = "") {
  const Ended ended = drape_with(arguments, folder, environment);
  INFO(ended.err);
  CHECK(ended.exit_code == 2);
  CHECK(ended.out == "");
  return ended.err;
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
  return text_of(std::filesystem::path(folders::source()) / "tests/configs/data/small.yaml");
}

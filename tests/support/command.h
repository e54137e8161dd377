#pragma once

#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/folders.h"

/// An empty folder, or one with this experiment in e.yaml, that goes away with the object.
struct Scratch {
  Scratch() {
    std::string name = (std::filesystem::temp_directory_path() / "drape_test_XXXXXX").string();
    REQUIRE(mkdtemp(name.data()));
    path = name;
  }
  explicit Scratch(const std::string& experiment) : Scratch() { write("e.yaml", experiment); }
  ~Scratch() { std::filesystem::remove_all(path); }
  Scratch(const Scratch&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path / name; }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path / name, std::ios::binary) << text;
  }

  /// Changes the byte in the middle of a file.
  void damage(const std::string& name) const {
    std::fstream file(path / name, std::ios::binary | std::ios::in | std::ios::out);
    const auto middle = static_cast<std::streamoff>(std::filesystem::file_size(path / name) / 2);
    const int byte = file.seekg(middle).peek();
    REQUIRE(file.seekp(middle).put(static_cast<char>(byte ^ 1)));
  }

  std::filesystem::path path;
};

inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  INFO(file);
  REQUIRE(stream);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline nlohmann::json json_in(const std::filesystem::path& file) {
  return nlohmann::json::parse(text_of(file));
}

/// Waits until the condition holds; fails the test case after ten minutes.
inline void wait_until(const std::string& what, const std::function<bool()>& condition) {
  INFO("waiting until " << what);
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(10);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) FAIL("in vain for ten minutes");
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

/// How a command ended; a signal's exit code is 128 + its number, as in a shell.
struct Ended {
  int exit_code = -1;
  std::string out, err;
};

/// A shell command that runs in a folder, in a process group of its own. What still runs of the group when
/// the object goes away is killed.
class Command {
 public:
  Command(const std::string& line, const std::filesystem::path& folder) : line_(line) {
    const std::string out = (output_ / "out").string(), err = (output_ / "err").string();
    for (const char* stream : {"out", "err"}) output_.write(stream, "");  // the command may be killed before
    const std::string redirected = "exec </dev/null >" + out + " 2>" + err + "\n" + line;
    pid_ = fork();
    REQUIRE(pid_ >= 0);
    if (pid_ == 0) {
      setpgid(0, 0);
      prctl(PR_SET_PDEATHSIG, SIGKILL);  // when the test itself is killed
      unsetenv("DRAPE_PLUGIN_PATH");
      if (chdir(folder.c_str()) == 0) execl("/bin/sh", "sh", "-c", redirected.c_str(), nullptr);
      _exit(126);
    }
    setpgid(pid_, pid_);  // whoever of the two comes first
  }
  ~Command() {
    send(SIGKILL);
    waitpid(pid_, nullptr, 0);
  }
  Command(const Command&) = delete;

  /// To all processes of the group; nothing where they have ended already.
  void send(int signal) const { kill(-pid_, signal); }
  /// To the command alone, without what it has started.
  void send_alone(int signal) const { kill(pid_, signal); }
  /// Whether a signal that was sent has still to be delivered: until then another of its kind would be lost.
  bool has_pending(int signal) const {
    const std::string status = text_of("/proc/" + std::to_string(pid_) + "/status"), mask = "ShdPnd:\t";
    return std::stoull(status.substr(status.find(mask) + mask.size(), 16), nullptr, 16) >> (signal - 1) & 1;
  }
  /// Processor time of the command's process so far, in seconds: how far it has come, on a busy machine too.
  double processor_time() const {
    clockid_t clock;
    timespec time{};
    if (clock_getcpuclockid(pid_, &clock) == 0) clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }

  Ended wait() {
    ::wait_until("this has ended: " + line_, [&] { return has_ended(); });
    const int code = ended_.si_code == CLD_EXITED ? ended_.si_status : 128 + ended_.si_status;
    return {code, text_of(output_ / "out"), text_of(output_ / "err")};
  }

  /// Sends a signal, and waits for the end that it brings about.
  Ended ended_by(int signal) {
    send(signal);
    return wait();
  }

  /// Waits until the condition holds that the command is to bring about; fails the test case when the command
  /// ends without.
  void wait_until(const std::string& what, const std::function<bool()>& condition) {
    bool ended = false;
    ::wait_until(what + ", by: " + line_, [&] {
      if (condition()) return true;
      if (ended) FAIL("the command ended before; it said: " << text_of(output_ / "err"));
      ended = has_ended();
      return false;
    });
  }

 private:
  /// The ended command stays a zombie, so that its number, which is the group's, is given to no other.
  bool has_ended() {
    return waitid(P_PID, id_t(pid_), &ended_, WEXITED | WNOHANG | WNOWAIT) == 0 && ended_.si_pid;
  }

  const std::string line_;
  Scratch output_;
  pid_t pid_ = 0;
  siginfo_t ended_{};
};

inline long lines_in(const std::filesystem::path& file) {
  std::ifstream lines(file);  // which may not be there yet, or be removed at any time
  return std::count(std::istreambuf_iterator<char>(lines), {}, '\n');
}

/// Waits until the file has that many lines.
inline void wait_for_lines(Command& command, const std::filesystem::path& file, long lines) {
  command.wait_until(file.string() + " has " + std::to_string(lines) + " lines",
                     [&] { return lines_in(file) >= lines; });
}

inline const std::string drape_command = (folders::commands() / "drape").string();

/// `drape` with these arguments, at work in that folder.
struct DrapeAtWork : Command {
  DrapeAtWork(const std::string& arguments, const Scratch& folder)
      : Command("exec " + drape_command + " " + arguments, folder.path) {}
};

/// `drape` with these arguments, in that folder, to its end.
inline Ended drape_with(const std::string& arguments, const std::filesystem::path& folder,
                        const std::string& environment = "") {
  INFO("drape " << arguments);
  return Command("exec env " + environment + " " + drape_command + " " + arguments, folder).wait();
}

/// The same, where it must end with this exit code.
inline Ended drape_ends(const std::string& arguments, const Scratch& folder, int exit_code = 0) {
  const Ended ended = drape_with(arguments, folder.path);
  INFO("drape " << arguments << "\n" << ended.err);
  REQUIRE(ended.exit_code == exit_code);
  return ended;
}

/// Standard output of what must succeed without a word on standard error.
inline std::string shown_by(const std::string& arguments, const std::filesystem::path& folder) {
  const Ended ended = drape_with(arguments, folder);
  CHECK(ended.exit_code == 0);
  CHECK(ended.err == "");
  return ended.out;
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

/// An experiment of tests/configs/data, by its name there.
inline std::string experiment_of_tests(const std::string& name) {
  return text_of(folders::source() / "tests/configs/data" / (name + ".yaml"));
}

/// Three methods on a square of 6 × 6 vertices and 2 levels.
inline std::string small_experiment() { return experiment_of_tests("small"); }

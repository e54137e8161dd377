#pragma once

#include <signal.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

/// How many times slower the tests run than they are written for. The presets of the sanitizers set it.
inline double test_slowdown() {
  const char* const factor = std::getenv("DRAPE_TEST_SLOWDOWN");
  return factor ? std::atof(factor) : 1;
}

/// What a command may take before it counts as one that never ends, in seconds.
struct TimeLimit {
  double cpu;   ///< on processors, summed over its processes
  double idle;  ///< while none of its processes runs, wants to run, or waits for a disk
};

/// The time that a process and its descendants have taken. Time in which they want to run and other processes
/// have the processors is in neither sum: what takes too long here does so on a busy machine and an idle one.
class TimeTaken {
 public:
  explicit TimeTaken(pid_t process) : process_(process) {}

  /// Call it again and again while the process runs; it looks at most ten times a second.
  void look() {
    const auto now = Clock::now();
    if (now - looked_ < std::chrono::milliseconds(100)) return;
    processes_.clear();
    const Seen seen = see(process_);
    cpu_ = std::max(cpu_, seen.cpu);
    // Of a longer pause, when this process itself got no turn, nothing is known.
    if (!seen.wants_to_run) idle_ += std::min(std::chrono::duration<double>(now - looked_).count(), 0.2);
    looked_ = now;
  }

  /// What is wrong with it, empty while it keeps to the limit.
  std::string excess(const TimeLimit& limit) const {
    std::ostringstream text;
    if (cpu_ > limit.cpu) text << "takes more than " << limit.cpu << " s of processor time";
    if (idle_ > limit.idle) text << "hangs: has done nothing for " << limit.idle << " s";
    return text.str();
  }

  /// Ends it and its descendants.
  void kill_all() const {
    kill(process_, SIGKILL);
    for (const pid_t process : processes_) kill(process, SIGKILL);
  }

 private:
  using Clock = std::chrono::steady_clock;

  struct Seen {
    double cpu = 0;
    bool wants_to_run = false;
  };

  static std::string text_of(const std::string& file) {
    std::ostringstream text;
    text << std::ifstream(file).rdbuf();
    return text.str();
  }

  Seen see(pid_t process) {
    const std::string folder = "/proc/" + std::to_string(process);
    processes_.push_back(process);
    Seen seen;
    // After the command's name, which may hold anything: state, 10 other numbers, then ticks in user mode and
    // in the kernel, the same two of ended children.
    const std::string stat = text_of(folder + "/stat");
    long user = 0, kernel = 0, ended_user = 0, ended_kernel = 0;
    if (const std::size_t name_end = stat.rfind(')'); name_end != std::string::npos)
      std::sscanf(stat.c_str() + name_end + 1, " %*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %ld %ld %ld %ld",
                  &user, &kernel, &ended_user, &ended_kernel);
    seen.cpu = static_cast<double>(user + kernel + ended_user + ended_kernel) /
               static_cast<double>(sysconf(_SC_CLK_TCK));

    std::error_code gone;  // processes and threads may end meanwhile
    for (std::filesystem::directory_iterator thread(folder + "/task", gone), end; !gone && thread != end;
         thread.increment(gone)) {
      const std::string thread_stat = text_of(thread->path() / "stat");
      const std::size_t state = thread_stat.rfind(')') + 2;
      if (state < thread_stat.size())
        seen.wants_to_run |= thread_stat[state] == 'R' || thread_stat[state] == 'D';
      std::istringstream children(text_of(thread->path() / "children"));
      for (pid_t child; children >> child;) {
        const Seen of_child = see(child);
        seen.cpu += of_child.cpu;
        seen.wants_to_run |= of_child.wants_to_run;
      }
    }
    return seen;
  }

  const pid_t process_;
  Clock::time_point looked_ = Clock::now();
  std::vector<pid_t> processes_;
  double cpu_ = 0, idle_ = 0;
};

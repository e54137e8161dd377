#pragma once

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

// What /proc says of processes. They may end at any time, and then have neither threads nor children.

inline std::string proc_text(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// The folders of a process's threads.
inline std::vector<std::string> threads_of(pid_t process) {
  std::vector<std::string> folders;
  std::error_code gone;
  const std::string all = "/proc/" + std::to_string(process) + "/task";
  for (std::filesystem::directory_iterator thread(all, gone), end; !gone && thread != end;
       thread.increment(gone))
    folders.push_back(thread->path());
  return folders;
}

inline std::vector<pid_t> children_of(pid_t process) {
  std::vector<pid_t> children;
  for (const std::string& thread : threads_of(process)) {
    std::istringstream text(proc_text(thread + "/children"));
    for (pid_t child; text >> child;) children.push_back(child);
  }
  return children;
}

/// Children first named, each before its own children.
inline std::vector<pid_t> descendants_of(pid_t process) {
  std::vector<pid_t> all;
  for (const pid_t child : children_of(process)) {
    all.push_back(child);
    for (const pid_t one : descendants_of(child)) all.push_back(one);
  }
  return all;
}

inline bool is_zombie(pid_t process) {
  const std::string stat = proc_text("/proc/" + std::to_string(process) + "/stat");
  const std::size_t state = stat.rfind(')') + 2;
  return state < stat.size() && stat[state] == 'Z';
}

/// The process's number and the words it was started with, at most 200 bytes of them.
inline std::string name_of(pid_t process) {
  std::string words = proc_text("/proc/" + std::to_string(process) + "/cmdline").substr(0, 200);
  if (words.ends_with('\0')) words.pop_back();
  std::replace(words.begin(), words.end(), '\0', ' ');
  return std::to_string(process) + " " + words;
}

/// How many times slower the tests run than they are written for. The presets of the sanitizers set it.
inline double test_slowdown() {
  const char* const factor = std::getenv("DRAPE_TEST_SLOWDOWN");
  return factor ? std::atof(factor) : 1;
}

/// The time that processes may take before they count as ones that never end, in seconds.
struct TimeLimit {
  double cpu;   ///< on processors, summed over the processes
  double idle;  ///< while none of them runs, wants to run, or waits for a disk
};

/// The time that a process and its descendants have taken. Time in which they want to run and other processes
/// have the processors is in neither sum: what takes too long here does so on a busy machine and an idle one.
class TimeTaken {
 public:
  enum class Of { process_and_descendants, descendants };

  explicit TimeTaken(pid_t process, Of of = Of::process_and_descendants) : process_(process), of_(of) {}

  /// Call it again and again while the process runs; it looks at most ten times a second. True if it looked.
  bool look() {
    const auto now = Clock::now();
    if (now - looked_ < std::chrono::milliseconds(100)) return false;
    const Seen seen = see(process_, of_ == Of::process_and_descendants);
    cpu_ = std::max(cpu_, seen.cpu);
    // Of a longer pause, when this process itself got no turn, nothing is known.
    if (!seen.wants_to_run) idle_ += std::min(std::chrono::duration<double>(now - looked_).count(), 0.2);
    looked_ = now;
    return true;
  }

  double cpu() const { return cpu_; }
  double idle() const { return idle_; }

  /// The limit that was exceeded, in words; empty while there is none.
  std::string excess(const TimeLimit& limit) const {
    std::ostringstream text;
    if (cpu_ > limit.cpu) text << "takes more than " << limit.cpu << " s of processor time";
    if (idle_ > limit.idle) text << "hangs: was idle for " << limit.idle << " s";
    return text.str();
  }

 private:
  using Clock = std::chrono::steady_clock;

  struct Seen {
    double cpu = 0;
    bool wants_to_run = false;
  };

  static Seen see(pid_t process, bool itself) {
    const std::string folder = "/proc/" + std::to_string(process);
    Seen seen;
    // After the command's name, which may hold anything: state, 10 other numbers, then ticks in user mode and
    // in the kernel, the same two of ended children.
    const std::string stat = proc_text(folder + "/stat");
    long user = 0, kernel = 0, ended_user = 0, ended_kernel = 0;
    if (const std::size_t name_end = stat.rfind(')'); name_end != std::string::npos)
      std::sscanf(stat.c_str() + name_end + 1, " %*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %ld %ld %ld %ld",
                  &user, &kernel, &ended_user, &ended_kernel);
    const long ticks = ended_user + ended_kernel + (itself ? user + kernel : 0);
    seen.cpu = static_cast<double>(ticks) / static_cast<double>(sysconf(_SC_CLK_TCK));
    if (itself)
      for (const std::string& thread : threads_of(process)) {
        const std::string thread_stat = proc_text(thread + "/stat");
        const std::size_t state = thread_stat.rfind(')') + 2;
        if (state < thread_stat.size())
          seen.wants_to_run |= thread_stat[state] == 'R' || thread_stat[state] == 'D';
      }
    for (const pid_t child : children_of(process)) {
      const Seen of_child = see(child, true);
      seen.cpu += of_child.cpu;
      seen.wants_to_run |= of_child.wants_to_run;
    }
    return seen;
  }

  const pid_t process_;
  const Of of_;
  Clock::time_point looked_ = Clock::now();
  double cpu_ = 0, idle_ = 0;
};

// Runs a test as ctest is given it, in limits that a busy machine does not shorten, and ends all that it
// started:
//
//   drape_limited SECONDS_OF_PROCESSOR_TIME IDLE_SECONDS COMMAND [ARGUMENT...]
//
// Ends as the command ends, by the same signal too; with 124 where the command exceeds a limit, and with 123
// where it ends well but leaves processes running. The environment's DRAPE_TEST_TIME names a file that has
// the processor time and the idle time so far, in seconds: deadlines for what a test waits for.

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <csignal>
#include <cstdlib>
#include <iostream>
#include <thread>

#include "tests/support/time_limit.h"

namespace {

volatile std::sig_atomic_t stopped_by = 0;

/// The file in which tests read the time taken.
class TimeFile {
 public:
  TimeFile() {
    std::string name = (std::filesystem::temp_directory_path() / "drape_test_time_XXXXXX").string();
    file_ = mkstemp(name.data());
    name_ = name;
    write(0, 0);
    setenv("DRAPE_TEST_TIME", name_.c_str(), 1);
  }
  ~TimeFile() {
    close(file_);
    std::filesystem::remove(name_);
  }
  TimeFile(const TimeFile&) = delete;

  /// Seconds of processor time and of idle time.
  void write(double cpu, double idle) const {
    char text[64];
    const int size = std::snprintf(text, sizeof text, "%14.2f %14.2f\n", cpu, idle);
    if (pwrite(file_, text, static_cast<std::size_t>(size), 0) != size) std::perror(name_.c_str());
  }

 private:
  std::string name_;
  int file_;
};

/// Starts a command that is killed when this process ends.
pid_t started(char** words) {
  const pid_t parent = getpid(), child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() == parent) execvp(words[0], words);
    std::perror(words[0]);
    _exit(126);
  }
  if (child < 0) {
    std::perror("fork");
    std::exit(125);
  }
  return child;
}

/// A command, and everything that it or its descendants start: orphans become children of this process.
class Test {
 public:
  explicit Test(char** words) {
    prctl(PR_SET_CHILD_SUBREAPER, 1);
    command_ = started(words);
  }

  /// Waits for the command; returns its status, as of waitpid.
  int wait(const TimeLimit& limit) {
    while (reap()) {
      if (taken_.look()) time_file_.write(taken_.cpu(), taken_.idle());
      const std::string excess = taken_.excess(limit);
      if (!excess.empty()) {
        std::cerr << "\nthe test " << excess << ". Its processes:\n" << list() << std::flush;
        kill(command_, SIGTERM);  // on which it may say what it is at
        wait_for([&] { return !reap(); }, {5, 5});
        status_ = 124 << 8;
        break;
      }
      if (stopped_by) {
        status_ = stopped_by;
        break;
      }
      pause();
    }
    return status_;
  }

  /// Ends what the test has left, which may take a moment to end by itself where the test has ended well.
  bool leaves_processes() {
    if (status_ == 0) wait_for([&] { return reap(), list().empty(); }, {10, 2});
    const std::string left = list();
    while (true) {
      for (const pid_t process : descendants_of(getpid())) kill(process, SIGKILL);
      if (waitpid(-1, nullptr, 0) < 0) break;  // each that ends hands its children over
    }
    if (!left.empty())
      std::cerr << "\nthe test left processes running, which were ended:\n" << left << std::flush;
    return !left.empty();
  }

 private:
  static void pause() { std::this_thread::sleep_for(std::chrono::milliseconds(5)); }

  /// False once the command has ended.
  bool reap() {
    int status = 0;
    for (pid_t child; (child = waitpid(-1, &status, WNOHANG)) > 0;)
      if (child == command_) command_ = 0, status_ = status;
    return command_ > 0;
  }

  template <class Condition>
  static void wait_for(const Condition& condition, const TimeLimit& limit) {
    TimeTaken taken(getpid(), TimeTaken::Of::descendants);
    while (!condition() && taken.excess(limit).empty()) taken.look(), pause();
  }

  /// The processes that are alive, one a line.
  static std::string list() {
    std::string all;
    for (const pid_t process : descendants_of(getpid()))
      if (!is_zombie(process)) all += "  " + name_of(process) + "\n";
    return all;
  }

  const TimeFile time_file_;
  TimeTaken taken_{getpid(), TimeTaken::Of::descendants};
  pid_t command_ = 0;
  int status_ = 0;
};

/// Ends this process as waitpid says of another.
[[noreturn]] void end_with(int status) {
  if (WIFEXITED(status)) std::exit(WEXITSTATUS(status));
  const rlimit no_core{0, 0};  // the command has left its own
  setrlimit(RLIMIT_CORE, &no_core);
  signal(WTERMSIG(status), SIG_DFL);
  raise(WTERMSIG(status));
  std::exit(128 + WTERMSIG(status));
}

}  // namespace

int main(int count, char** words) {
  if (count < 4) {
    std::cerr << "usage: drape_limited SECONDS_OF_PROCESSOR_TIME IDLE_SECONDS COMMAND [ARGUMENT...]\n";
    return 125;
  }
  const TimeLimit limit{std::atof(words[1]) * test_slowdown(), std::atof(words[2])};
  // ctest kills the process that it started, which can do nothing then: so another one ends the test's.
  const pid_t parent = getpid(), watcher = fork();
  if (watcher < 0) {
    std::perror("fork");
    return 125;
  }
  if (watcher > 0) {
    int status = 0;
    waitpid(watcher, &status, 0);
    end_with(status);
  }
  for (const int number : {SIGTERM, SIGINT, SIGHUP}) signal(number, [](int own) { stopped_by = own; });
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != parent) return 125;
  int status = 0;
  {
    Test test(words + 3);
    status = test.wait(limit);
    if (test.leaves_processes() && status == 0) status = 123 << 8;
  }
  end_with(status);
}

// Runs a test as ctest is given it, in a limit that a busy machine does not shorten:
//
//   drape_limited SECONDS_OF_PROCESSOR_TIME IDLE_SECONDS COMMAND [ARGUMENT...]
//
// Ends as the command ends, by the same signal too.

#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <cstdlib>
#include <iostream>
#include <thread>

#include "tests/support/time_limit.h"

int main(int count, char** words) {
  if (count < 4) {
    std::cerr << "usage: drape_limited SECONDS_OF_PROCESSOR_TIME IDLE_SECONDS COMMAND [ARGUMENT...]\n";
    return 125;
  }
  const TimeLimit limit{std::atof(words[1]) * test_slowdown(), std::atof(words[2])};
  const pid_t parent = getpid(), child = fork();
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // when ctest kills its test
    if (getppid() == parent) execvp(words[3], words + 3);
    std::perror(words[3]);
    _exit(126);
  }
  if (child < 0) {
    std::perror("fork");
    return 125;
  }

  TimeTaken taken(child);
  int status = 0;
  while (waitpid(child, &status, WNOHANG) == 0) {
    taken.look();
    if (const std::string excess = taken.excess(limit); !excess.empty()) {
      std::cerr << "\nthe test " << excess << std::endl;
      taken.kill_all();
      waitpid(child, &status, 0);
      return 124;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  const rlimit no_core{0, 0};  // the command has left its own
  setrlimit(RLIMIT_CORE, &no_core);
  signal(WTERMSIG(status), SIG_DFL);
  raise(WTERMSIG(status));
  return 128 + WTERMSIG(status);
}

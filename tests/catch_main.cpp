#define CATCH_CONFIG_RUNNER
#include <sys/prctl.h>
#include <sys/wait.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <fstream>
#include <iostream>
#include <thread>

namespace {

/// Whether all that the tests have started ends within a minute, the orphans of what they have started too.
bool no_process_is_left() {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (std::chrono::steady_clock::now() < deadline) {
    const pid_t ended = waitpid(-1, nullptr, WNOHANG);
    if (ended < 0) return true;
    if (ended == 0) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

}  // namespace

int main(int count, char** words) {
  prctl(PR_SET_CHILD_SUBREAPER, 1);  // orphans become children of this process
  const int failed = Catch::Session().run(count, words);
  // A sanitizer leaves its symbolizer running.
  if (failed || DRAPE_SANITIZED || no_process_is_left()) return failed;
  std::cerr << "the tests left processes running: " << std::ifstream("/proc/thread-self/children").rdbuf()
            << "\n";
  return 1;
}

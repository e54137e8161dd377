#include <csignal>
#include <cstdlib>

#include "core/app/cli/commands.h"
#include "core/app/experiment/exit_codes.h"

namespace drape {

namespace {

volatile std::sig_atomic_t received = 0;

void on_signal(int number) {
  if (received) std::_Exit(exit_by_signal + number);
  received = number;
}

}  // namespace

void stop_on_signals() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // by nohup
}

int stop_signal() { return received; }

}  // namespace drape

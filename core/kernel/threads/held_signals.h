#pragma once

#include <csignal>

namespace drape {

/// Holds signals to this thread back while it lives, also from the threads and processes that it begins.
/// Threads of drape's own begin so, and leave the process's signals to those of its caller.
class HeldSignals {
 public:
  HeldSignals() {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  HeldSignals(const HeldSignals&) = delete;
  ~HeldSignals() { release(); }
  void release() const { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_;
};

}  // namespace drape

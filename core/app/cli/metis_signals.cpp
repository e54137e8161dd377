#include <csignal>

/// METIS sets a handler of SIGTERM while it orders, which jumps out of whatever thread the system gives the
/// signal to: a crash if that is one of OpenBLAS's. It calls this function of glibc, and here it finds one
/// that leaves the command's own handler in place.
extern "C" [[gnu::visibility("default")]] sighandler_t __sysv_signal(int, sighandler_t) noexcept {
  return SIG_DFL;
}

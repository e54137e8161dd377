// Preloaded: METIS's first ordering is met by a SIGTERM in a thread that drape has not started, such as one
// of OpenBLAS's. METIS calls this function, to set its handlers, before it orders.

#include <dlfcn.h>

#include <csignal>
#include <thread>

extern "C" [[gnu::visibility("default")]] int gk_sigtrap() {
  static bool sent = false;
  const auto set_handlers = reinterpret_cast<int (*)()>(dlsym(RTLD_NEXT, "gk_sigtrap"));
  const int done = set_handlers();
  if (!sent)
    std::thread([] {
      sigset_t none;
      sigemptyset(&none);
      pthread_sigmask(SIG_SETMASK, &none, nullptr);
      raise(SIGTERM);
    }).join();
  sent = true;
  return done;
}

#include "core/app/files/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "core/kernel/files/file.h"
#include "core/kernel/threads/stopwatch.h"

namespace drape {

FileLock::FileLock(const std::filesystem::path& file) : name_(file) {
  // Without O_CLOEXEC: child processes inherit the lock.
  file_ = open(file.c_str(), O_RDWR | O_CREAT, 0644);
  if (file_ < 0) refuse_path(file, std::string("cannot be made (") + std::strerror(errno) + ")");
}

FileLock::~FileLock() { close(file_); }

bool FileLock::acquire(double patience) {
  const Stopwatch watch;
  while (flock(file_, LOCK_EX | LOCK_NB) != 0) {
    if (watch.seconds() > patience) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  const std::string self = "process " + std::to_string(getpid()) + " on " + host + "\n";
  if (ftruncate(file_, 0) != 0 || pwrite(file_, self.data(), self.size(), 0) < 0)
    refuse_path(name_, "cannot write (is the disk full?)");
  return true;
}

std::string FileLock::holder() const {
  std::string text = read_file(name_);
  while (!text.empty() && text.back() == '\n') text.pop_back();
  return text;
}

}  // namespace drape

#include "core/app/files/file_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <boost/algorithm/string/trim.hpp>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

#include "core/kernel/files/file.h"
#include "core/kernel/threads/stopwatch.h"

namespace drape {

namespace {

constexpr std::string_view holder_begins = "process ";

/// Whether the open file is a lock's, not one of somebody else that has its name, or that has another name.
bool is_lock(int file) {
  struct stat status {};
  char begin[holder_begins.size()] = {};
  if (fstat(file, &status) != 0 || !S_ISREG(status.st_mode) || status.st_nlink != 1) return false;
  return pread(file, begin, sizeof begin, 0) == 0 || std::string_view(begin, sizeof begin) == holder_begins;
}

}  // namespace

FileLock::FileLock(const std::filesystem::path& file) : name_(file) {
  // Without O_CLOEXEC: child processes inherit the lock. A pipe without a reader would block.
  file_ = open(file.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY, 0644);
  if (file_ >= 0 && is_lock(file_)) return;
  const std::string cause = file_ < 0 && errno != ELOOP
                                ? std::string("cannot be made (") + std::strerror(errno) + ")"
                                : "is not a lock of drape's; move it away";
  if (file_ >= 0) close(file_);
  refuse_path(file, cause);
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
  const std::string self = std::string(holder_begins) + std::to_string(getpid()) + " on " + host + "\n";
  if (ftruncate(file_, 0) == 0 && pwrite(file_, self.data(), self.size(), 0) == std::ssize(self)) return true;
  refuse_path(name_, "cannot write (is the disk full?)");
}

std::string FileLock::holder() const {
  const std::string holder = boost::trim_right_copy(read_file(name_));
  return holder.empty() ? "another process" : holder;  // which has not written its number yet
}

}  // namespace drape

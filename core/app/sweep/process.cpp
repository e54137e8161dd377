#include "core/app/sweep/process.h"

#include <fcntl.h>
#include <link.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "core/kernel/files/file.h"
#include "core/kernel/threads/held_signals.h"

namespace drape {

namespace {

/// In the child, between fork and exec, with all signals blocked: nothing here may allocate. Handlers are
/// this program's, which would take a signal and not end the other one.
[[noreturn]] void become(char* const* words, const char* out, const char* err, pid_t parent,
                         const HeldSignals& held) {
  setpgid(0, 0);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action = {};
    if (sigaction(signal, nullptr, &action) == 0 && action.sa_handler != SIG_IGN)
      std::signal(signal, SIG_DFL);
  }
  held.release();
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const auto redirect = [](const char* file, int flags, int to) {
    const int from = open(file, flags | O_NOFOLLOW | O_CLOEXEC, 0644);
    return from >= 0 && dup2(from, to) == to;
  };
  const bool alone = getppid() != parent;  // the parent died before it could be watched
  if (!alone && redirect("/dev/null", O_RDONLY, 0) && redirect(out, O_WRONLY | O_CREAT | O_APPEND, 1) &&
      redirect(err, O_WRONLY | O_CREAT | O_APPEND, 2))
    execvp(words[0], words);
  _exit(127);
}

namespace fs = std::filesystem;

fs::file_time_type time_of(const fs::path& file) {
  std::error_code none;  // the kernel's own library is not a file
  return fs::last_write_time(file, none);
}

/// The libraries of this process, plugins among them, with the times of their last changes.
std::vector<std::pair<fs::path, fs::file_time_type>> libraries() {
  std::vector<std::pair<fs::path, fs::file_time_type>> times;
  dl_iterate_phdr(
      [](dl_phdr_info* info, std::size_t, void* to) {
        if (*info->dlpi_name)
          static_cast<decltype(times)*>(to)->emplace_back(info->dlpi_name, time_of(info->dlpi_name));
        return 0;
      },
      &times);
  return times;
}

Exit exit_of(int status) {
  if (WIFSIGNALED(status)) return {128 + WTERMSIG(status), WTERMSIG(status)};
  return {WEXITSTATUS(status), 0};
}

}  // namespace

Process::Process(const std::vector<std::string>& words, const std::filesystem::path& out,
                 const std::filesystem::path& err) {
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  const pid_t parent = getpid();
  const HeldSignals held;
  pid_ = fork();
  if (pid_ == 0) become(arguments.data(), out.c_str(), err.c_str(), parent, held);
  if (pid_ < 0) throw std::runtime_error(words[0] + ": cannot be started (" + std::strerror(errno) + ")");
  setpgid(pid_, pid_);  // parent or child, whichever is first
}

std::optional<Exit> Process::poll() const {
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return std::nullopt;
  return exit_of(status);
}

Exit Process::wait() const {
  int status = 0;
  while (waitpid(pid_, &status, 0) < 0 && errno == EINTR) continue;
  return exit_of(status);
}

void Process::signal(int number) const { kill(-pid_, number); }

std::int64_t Process::resident_bytes() const {
  std::ifstream in("/proc/" + std::to_string(pid_) + "/statm");
  std::int64_t all = 0, resident = 0;
  in >> all >> resident;
  return in ? resident * sysconf(_SC_PAGESIZE) : 0;
}

ProgramOutput run_program(const std::vector<std::string>& words) {
  std::string folder = (std::filesystem::temp_directory_path() / "drape_XXXXXX").string();
  if (!mkdtemp(folder.data())) throw std::runtime_error(folder + ": cannot make a temporary folder");
  const std::filesystem::path out = folder + "/out", err = folder + "/err";
  ProgramOutput said;
  said.exit = Process(words, out, err).wait();
  said.out = text_of_file(out);
  said.err = text_of_file(err);
  std::error_code ignored;
  std::filesystem::remove_all(folder, ignored);
  return said;
}

std::filesystem::path own_program() {
  static const std::filesystem::path path = std::filesystem::read_symlink("/proc/self/exe");
  return path;  // of the first call: the link's text changes when the file is replaced
}

bool own_program_replaced() {
  static const auto first = libraries();
  std::error_code error;
  const auto is_other = [](const auto& library) { return time_of(library.first) != library.second; };
  return !fs::equivalent("/proc/self/exe", own_program(), error) ||
         std::any_of(first.begin(), first.end(), is_other);
}

std::string text_of_file(const std::filesystem::path& file) {
  return std::filesystem::exists(file) ? read_file(file) : std::string();
}

}  // namespace drape

// The `drape` command. Its exit codes are in exit_codes.h.

#include <fcntl.h>
#include <malloc.h>
#include <sys/mman.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <vector>

#include "core/app/cli/commands.h"
#include "core/app/cli/config_arguments.h"
#include "core/app/experiment/exit_codes.h"
#include "core/app/run/runner.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"

namespace drape {

namespace {

volatile std::sig_atomic_t received = 0, seen = 0;  // the first signal; a bit for each that came

void on_signal(int number) {
  // Only the same one twice: Slurm and systemd signal a sweep and its runs alike, and the sweep then stops
  // its runs by SIGINT. A terminal that is closed may send SIGHUP twice: its shell does, and then the system.
  if ((seen >> number & 1) && number != SIGHUP) std::_Exit(exit_by_signal + number);
  seen = seen | 1 << number;
  if (!received) received = number;
}

int run(int argc, char** argv) {
  Commands commands;
  for (const auto add : {add_new_command, add_check_commands, add_run_command, add_view_command,
                         add_export_command, add_figures_command, add_fabric_command, add_fit_command,
                         add_report_commands, add_sweep_commands, add_plugin_commands})
    add(commands);
  std::string asked;  // main reads it as `COMMAND --help`
  commands
      .add("help", "show a command's options and an example", "drape help run", [] { return exit_bad_input; })
      .add_option("command", asked, "the command");
  add_reference_command(commands);
  return commands.run(argc, argv);
}

/// Opens those of the three standard streams that are closed on /dev/null: otherwise the first files of a run
/// would take their places, and what is printed would go into them.
void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) == -1 && open("/dev/null", O_RDWR) != stream) std::_Exit(exit_aborted);
}

/// Keeps freed memory in the process, in huge pages where the system has them. A run makes and frees matrices
/// of megabytes in every iteration: each would otherwise be given back, and fetched again page by page.
void keep_freed_memory() {
  if (!mallopt(M_MMAP_MAX, 0) || !mallopt(M_TRIM_THRESHOLD, -1)) return;
  constexpr std::size_t reserved = std::size_t(1) << 30;  // of addresses; a page is taken by its first use
  const auto memory = static_cast<char*>(std::malloc(reserved));
  if (!memory) return;
  const std::size_t page = sysconf(_SC_PAGESIZE);
  madvise(memory + page - reinterpret_cast<std::uintptr_t>(memory) % page, reserved - page, MADV_HUGEPAGE);
  std::free(memory);
}

/// Takes the empty parts out of the lists of folders by which this process, and a compiler that it starts,
/// find files: each stands for the folder that the user is in, whose files are not to be executed or
/// included.
void forget_current_folder() {
  for (const char* name : {"PATH", "LD_LIBRARY_PATH", "COMPILER_PATH", "LIBRARY_PATH", "CPATH",
                           "C_INCLUDE_PATH", "CPLUS_INCLUDE_PATH"}) {
    const char* value = std::getenv(name);
    if (!value) continue;
    std::vector<std::string> folders = split(value, ':');
    std::erase(folders, "");
    if (folders.empty())
      unsetenv(name);
    else
      setenv(name, joined(folders, ":", ":").c_str(), 1);
  }
}

}  // namespace

void stop_on_signals() {
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
  if (std::signal(SIGHUP, on_signal) == SIG_IGN) std::signal(SIGHUP, SIG_IGN);  // by nohup
}

int stop_signal() { return received; }

void allow_lost_output() {
  if (std::cout.flush()) return;
  std::cerr << "warning: standard output cannot be written to; the results are not affected\n";
  if (const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC); nowhere >= 0) {
    dup2(nowhere, STDOUT_FILENO);
    close(nowhere);
  }
  std::cout.clear();
}

}  // namespace drape

int main(int argc, char** argv) {
  using namespace drape;
  // Exceeding a file size limit is reported as an error instead of ending the process.
  std::signal(SIGXFSZ, SIG_IGN);
  open_standard_streams();
  keep_freed_memory();
  forget_current_folder();
  static bool at_work = true;  // until main returns: who ends the program before is a plugin
  std::atexit([] {
    if (!at_work) return;
    std::cerr << "error: a plugin ended the program\n";
    std::_Exit(exit_aborted);
  });
  const std::shared_ptr<void> returned(nullptr, [](void*) { at_work = false; });
  const auto end = [](const std::string& message, int exit_code) {
    std::cerr << "error: " << printable(message) << "\n";
    return exit_code;
  };
  try {
    const int exit_code = run(argc, argv);
    if (!std::cout.flush()) return end("standard output cannot be written to", exit_aborted);
    return exit_code;
  } catch (const RefusedConfig& refused) {
    refused.list();
    return exit_bad_input;
  } catch (const RunAborted& error) {
    return end(error.what(), exit_aborted);
  } catch (const WriteError& error) {
    return end(error.what(), exit_aborted);
  } catch (const nlohmann::json::exception& error) {
    return end(std::string("a results file is not as drape writes it (") + error.what() +
                   "); run the experiment again",
               exit_bad_input);
  } catch (...) {
    return end(message_in_flight(), exit_bad_input);
  }
}

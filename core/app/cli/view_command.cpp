#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "core/app/cli/commands.h"
#include "core/app/cli/config_arguments.h"
#include "core/app/experiment/exit_codes.h"
#include "core/app/report/report.h"
#include "core/app/report/run_collection.h"
#include "core/app/view/page.h"
#include "core/kernel/files/message_text.h"

namespace drape {

namespace {

namespace fs = std::filesystem;

bool has_display() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY"})
    if (const char* value = std::getenv(name); value && *value) return true;
  return false;
}

/// Starts xdg-open in a session of its own: a browser that it becomes outlives this process. Returns whether
/// the program exists.
bool open_in_browser(const fs::path& page) {
  std::string words[] = {"xdg-open", fs::absolute(page).string()};
  char* arguments[] = {words[0].data(), words[1].data(), nullptr};
  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
  posix_spawn_file_actions_init(&files);
  posix_spawnattr_init(&attributes);
  for (const int stream : {0, 1, 2})
    posix_spawn_file_actions_addopen(&files, stream, "/dev/null", stream == 0 ? O_RDONLY : O_WRONLY, 0);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);
  pid_t child = 0;
  const int error = posix_spawnp(&child, arguments[0], &files, &attributes, arguments, environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&files);
  return error == 0;
}

/// Opens the report of a run or a sweep, and writes it if it is missing or older than the results. Without a
/// display or without xdg-open it prints the page's address instead.
int view(const fs::path& folder) {
  const fs::path page = folder / "report.html";
  require_run_or_sweep(folder);
  const bool sweep = is_sweep(folder);
  if (!is_current(page, folder / (sweep ? "sweep.json" : "results.json"))) {
    if (sweep)
      write_runs_report({folder}, page);
    else
      warn_of(write_report(folder));
  }
  std::cout << "report: " << printable(page.string()) << "\n";
  if (!has_display() || !open_in_browser(page))
    std::cout << "open it in a browser: file://" << url_path(fs::absolute(page).lexically_normal())
              << (sweep ? "" : "#in-3d") << "\n";
  return exit_done;
}

}  // namespace

void add_view_command(Commands& commands) {
  const auto folder = std::make_shared<std::string>();
  commands
      .add("view", "open the report of a run or a sweep, with its 3D viewer", "drape view results/sphere",
           [folder] { return view(*folder); })
      .add_option("folder", *folder, "results folder, or a sweep's")
      ->required();
}

}  // namespace drape

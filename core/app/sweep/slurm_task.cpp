// The jobs that slurm_engine.cpp submits.

#include <chrono>
#include <thread>

#include "core/app/sweep/slurm_engine.h"

namespace drape {

int run_task(const SweepFolder& folder, int index, int threads, bool report,
             const std::function<bool()>& stop) {
  const nlohmann::ordered_json sweep = folder.read();
  if (sweep.is_null() || index < 0 || index >= int(sweep["runs"].size()))
    throw std::runtime_error(folder.path().string() + ": sweep.json has no run " + std::to_string(index));
  const RunFiles files = folder.files(sweep["runs"][index]["folder"]);
  // A node that Slurm considers dead may still execute the task that is restarted elsewhere.
  FileLock lock(files.lock());
  while (!lock.acquire(1))
    if (stop()) return exit_by_signal + SIGINT;
  if (const RunStatus before = resolve_interrupted(files, read_status(files)); before.has_results()) {
    write_status(files, before);
    return before.exit_code;
  }
  RunProcess run(files, {threads, report, sweep.value("time_limit", 0.0)});
  for (bool stopped = false; !run.ended();) {
    if (stop() && !stopped) stopped = true, run.stop();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return run.status().exit_code;
}

void collect_tasks(const SweepFolder& folder) {
  folder.finalize();
  std::error_code ignored;
  std::filesystem::remove(folder.jobs(), ignored);
}

}  // namespace drape

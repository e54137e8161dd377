#include <cstdio>
#include <iostream>

#include "core/app/cli/commands.h"
#include "core/app/cli/config_arguments.h"
#include "core/app/experiment/exit_codes.h"
#include "core/app/files/json_file.h"
#include "core/app/files/machine.h"
#include "core/app/report/run_table.h"
#include "core/app/sweep/slurm_engine.h"
#include "core/app/sweep/sweep_folder.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/threads/parallel.h"

namespace drape {

namespace {

/// The command lines of `drape sweep` and `drape sweep-job`.
struct SweepRequest : SweepOptions {
  std::string config, folder, engine = "local";
  std::optional<int> most_levels;
  double memory_gigabytes = 0;
  bool allow_memory = false, dry_run = false, wait = false, cancel = false;
  int task = -1;
};

/// Lists the runs; returns the exit code, which says whether every run ended as expected.
int list_runs(const SweepFolder& folder) {
  std::cout << printable_lines(list_of_runs(folder));
  return table_of(read_runs({folder.path()})).all_pass() ? exit_done : exit_not_converged;
}

/// Throws what would refuse the sweep, but for another one that has the folder now.
void foresee_refusal(const Sweep& sweep, const SweepFolder& folder, const SweepRequest& r) {
  if (r.engine == "slurm")
    refuse_in_scripts(folder);
  else if (!r.allow_memory)
    MemoryEstimate(sweep, folder).require(sweep, folder, machine_memory());
  folder.refuse_foreign();
  folder.checked_statuses(sweep, r.threads);
}

/// Lists the runs without writing anything.
void show_plan(const Sweep& sweep, const SweepFolder& folder, int threads) {
  std::printf("sweep %s: %zu runs in %s, each with %d thread%s\n", sweep.parameters.name.c_str(),
              sweep.runs.size(), printable(folder.path().string()).c_str(), threads, threads == 1 ? "" : "s");
  const MemoryEstimate memory(sweep, folder);
  for (const SweepRun& run : sweep.runs) {
    const RunFiles files = folder.files(run.folder);
    RunStatus status = read_status(files);
    // Its results may have been damaged or removed since.
    if (status.has_results()) status = resolve_status(files, status);
    std::printf("%-10s %s  levels %d, about %.0f vertices, %.1f GB  %s\n", to_string(status.state),
                printable(run.folder).c_str(), run.levels, run.vertices, memory.bytes(run) / 1e9,
                printable(json_text(run.settings)).c_str());
  }
}

/// Performs an action of a sweep that has begun: errors no longer count as refused input.
template <class Action>
int begun(const SweepFolder& folder, const Action& action) {
  try {
    return action();
  } catch (const std::exception& error) {
    std::cerr << "error: " << printable(reason_of(error)) << "; the sweep in "
              << printable(folder.path().string()) << " is aborted; the same command runs what is missing\n";
    return exit_aborted;
  }
}

void check_options(const SweepRequest& r) {
  for (const std::string& option : r.sbatch)
    if (!option.starts_with('-') || option.find_first_not_of('-') == option.npos)
      throw std::runtime_error("--sbatch " + option +
                               ": an option of sbatch begins with -, as in --sbatch=--partition=long");
  if (r.engine == "slurm") return;
  const char* given = r.wait ? "--wait" : r.cancel ? "--cancel" : !r.sbatch.empty() ? "--sbatch" : nullptr;
  if (given) throw std::runtime_error(std::string(given) + " is of --engine slurm; give that too");
  const long workers = std::max(1, r.workers), cores = core_count();
  if (workers * r.threads > cores)
    throw std::runtime_error(std::to_string(workers) + " × " + std::to_string(r.threads) +
                             " threads (workers × threads) are more than the " + std::to_string(cores) +
                             " cores that this process may use; lower --workers or --threads");
}

int run_local(const Sweep& sweep, const SweepFolder& folder, SweepRequest r) {
  if (!r.allow_memory) MemoryEstimate(sweep, folder).require(sweep, folder, machine_memory());
  const auto lock = folder.lock();
  refuse_while_queued(folder);
  if (r.workers == 0) r.workers = core_count() / r.threads;
  const std::vector<std::size_t> missing = folder.prepare(sweep, r.threads, r.retry_failed);
  return begun(folder, [&] {
    run_locally(sweep, folder, missing, r);
    if (!stop_signal()) return list_runs(folder);
    std::cout << printable_lines(list_of_runs(folder));
    std::cerr << "stopped on request; the same command runs what is missing\n";
    return exit_by_signal + stop_signal();
  });
}

int run_on_slurm(const Sweep& sweep, const SweepFolder& folder, const SweepRequest& r) {
  refuse_in_scripts(folder);
  if (r.cancel) {
    cancel_jobs(folder, r);
    folder.refresh();
    std::cout << printable_lines(list_of_runs(folder));
    return exit_done;
  }
  std::optional<SlurmJobs> jobs;
  {
    const auto lock = folder.lock();
    refuse_while_queued(folder);
    const std::vector<std::size_t> missing = folder.prepare(sweep, r.threads, r.retry_failed);
    const int submitted = begun(folder, [&] {
      if (missing.empty()) return exit_done;
      jobs = submit(sweep, folder, missing, r);
      std::cout << "submitted: " << missing.size() << " runs as job array " << jobs->array
                << ", collected by job " << jobs->collector << "; their output is in "
                << printable((folder.slurm() / "logs").string()) << std::endl;
      return exit_done;
    });
    if (submitted != exit_done) return submitted;
  }
  if (jobs && !r.wait) return exit_done;
  return begun(folder, [&] {
    if (jobs && !wait_for(folder, *jobs, r)) {
      std::cerr << "no longer waiting; the jobs go on\n";
      return exit_by_signal + stop_signal();
    }
    folder.finalize();
    return list_runs(folder);
  });
}

int run_sweep(SweepRequest r, const Registry& registry) {
  ConfigErrors errors;
  const std::optional<Sweep> sweep = read_sweep(r.config, registry, errors, r.most_levels);
  require_none(errors);
  if (r.threads == 0) r.threads = sweep->parameters.threads;
  r.memory = r.memory_gigabytes * 1e9;
  r.stop = [] { return stop_signal() != 0; };
  check_options(r);
  const SweepFolder folder(r.folder.empty() ? std::filesystem::path("results") / sweep->parameters.name
                                            : std::filesystem::path(r.folder));
  if (r.dry_run) {
    show_plan(*sweep, folder, r.threads);
    foresee_refusal(*sweep, folder, r);
    return exit_done;
  }
  stop_on_signals();  // nothing to save before this point
  const int exit_code =
      r.engine == "slurm" ? run_on_slurm(*sweep, folder, r) : run_local(*sweep, folder, std::move(r));
  allow_lost_output();
  return exit_code;
}

/// A job of a sweep on a cluster: a run, or collecting the runs' statuses.
int run_job(SweepRequest r) {
  stop_on_signals();
  r.stop = [] { return stop_signal() != 0; };
  r.threads = std::max(1, r.threads);
  const SweepFolder folder(r.folder);
  if (r.task >= 0) return run_task(folder, r.task, r);
  collect_tasks(folder);
  return exit_done;
}

}  // namespace

void add_sweep_commands(Commands& commands) {
  const auto request = std::make_shared<SweepRequest>();
  SweepRequest& r = *request;  // lives as long as the commands
  CLI::App& sweep = commands.add_with_plugins(
      "sweep", "run every variation of an experiment; resumes an interrupted sweep",
      "drape sweep configs/sweeps/ablations.yaml -j 2 --dry-run",
      [request](const Registry& registry) { return run_sweep(*request, registry); });
  sweep.add_option("file", r.config, "sweep file (YAML)")->required();
  add_option(sweep, "-o,--out FOLDER", r.folder, "the sweep's folder (default: results/NAME)");
  add_option(sweep, "--engine NAME", r.engine,
             "local: processes on this machine; slurm: a job array on a cluster")
      ->check(one_of({"local", "slurm"}));
  add_option(sweep, "-j,--workers N", r.workers,
             "concurrent runs (default: as many as the cores allow with --threads)")
      ->check(positive_integer());
  add_option(sweep, "--threads N", r.threads, "threads of each run, in place of the sweep's")
      ->check(positive_integer());
  add_option(sweep, "--memory-limit GB", r.memory_gigabytes,
             "memory of all runs together; with slurm, of each")
      ->check(number_of_at_least(1e-3));
  sweep.add_flag("--allow-memory", r.allow_memory,
                 "allow runs that may need more memory than this machine has");
  add_option(sweep, "--most-levels N", r.most_levels, "largest number of levels of every run")
      ->check(positive_integer());
  sweep.add_flag("--dry-run", r.dry_run, "validate and list the runs without running any");
  sweep.add_flag("--retry-failed", r.retry_failed, "rerun failed runs");
  sweep.add_flag("-q,--quiet", r.quiet, "no progress on standard error; failed runs are still listed");
  sweep.add_flag("--report", r.report, "write every run's report.html and its pictures");
  sweep.add_flag("--wait", r.wait, "with slurm: wait for the jobs and list the runs");
  sweep.add_flag("--cancel", r.cancel, "with slurm: cancel the sweep's jobs");
  add_option(sweep, "--sbatch OPTION", r.sbatch,
             "with slurm: a further option of sbatch, as --sbatch=--partition=long; may be repeated");

  CLI::App& job = commands.add("sweep-job", "executed by a sweep's jobs on a cluster", "",
                               [request] { return run_job(*request); });
  job.group("");
  job.add_option("folder", r.folder, "the sweep's folder")->required();
  job.add_option("--task", r.task, "index of the run; without it, collect the runs' statuses");
  job.add_option("--threads", r.threads, "threads of the run")->check(positive_integer());
  job.add_flag("--report", r.report, "write the run's report");
}

}  // namespace drape

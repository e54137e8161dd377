#include "core/app/cli/sweep_command.h"

#include <csignal>
#include <cstdio>
#include <iostream>

#include "core/app/cli/config_arguments.h"
#include "core/app/cli/help.h"
#include "core/app/cli/stop_signals.h"
#include "core/app/experiment/exit_codes.h"
#include "core/app/files/json_file.h"
#include "core/app/files/machine.h"
#include "core/app/report/run_table.h"
#include "core/app/sweep/local_engine.h"
#include "core/app/sweep/memory.h"
#include "core/app/sweep/slurm_engine.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/threads/parallel.h"

namespace drape {

namespace {

/// Whether every run ended as expected.
int exit_code_of(const SweepFolder& folder) {
  return table_of(read_runs({folder.path()})).all_pass() ? exit_done : exit_not_converged;
}

/// Lists the runs without writing anything.
void show_plan(const Sweep& sweep, const SweepFolder& folder, int threads) {
  std::printf("sweep %s: %zu runs in %s, each with %d thread%s\n", sweep.parameters.name.c_str(),
              sweep.runs.size(), folder.path().c_str(), threads, threads == 1 ? "" : "s");
  const MemoryEstimate memory(sweep, folder);
  for (const SweepRun& run : sweep.runs)
    std::printf("%-10s %s  levels %d, about %.0f vertices, %.1f GB  %s\n",
                to_string(read_status(folder.files(run.folder)).state), run.folder.c_str(), run.levels,
                run.vertices, memory.bytes(run) / 1e9, json_text(run.settings).c_str());
}

/// Performs an action of a sweep that has begun: errors no longer count as refused input.
template <class Action>
int begun(const SweepFolder& folder, const Action& action) {
  const auto end = [&](const std::string& cause) {
    std::cerr << "error: " << printable(cause) << "; the sweep in " << folder.path().string()
              << " is aborted; the same command runs what is missing\n";
    return exit_aborted;
  };
  try {
    return action();
  } catch (const std::exception& error) {
    return end(reason_of(error));
  }
}

}  // namespace

SweepCommand::SweepCommand(CLI::App& app)
    : sweep_(
          app.add_subcommand("sweep", "run every variation of an experiment; resumes an interrupted sweep")),
      job_(app.add_subcommand("sweep-job", "executed by a sweep's jobs on a cluster")->group("")) {
  show_example(*sweep_, "drape sweep configs/sweeps/ablations.yaml -j 2 --dry-run");
  sweep_->add_option("file", config_, "sweep file (YAML)")->required();
  sweep_->add_option("-o,--out", out_, "the sweep's folder (default: results/NAME)")->type_name("FOLDER");
  sweep_->add_option("--engine", engine_, "local: processes on this machine; slurm: a job array on a cluster")
      ->type_name("NAME")
      ->check([](const std::string& name) {
        return name == "local" || name == "slurm" ? "" : "must be local or slurm, not " + excerpt(name);
      });
  sweep_
      ->add_option("-j,--workers", workers_,
                   "concurrent runs (default: as many as the cores allow with --threads)")
      ->type_name("N")
      ->check(positive_integer);
  sweep_->add_option("--threads", threads_, "threads of each run, in place of the sweep's")
      ->type_name("N")
      ->check(positive_integer);
  sweep_->add_option("--memory-limit", memory_limit_, "memory of all runs together; with slurm, of each")
      ->type_name("GB")
      ->check(number_of_at_least(1e-3));
  sweep_->add_flag("--allow-memory", allow_memory_,
                   "allow runs that may need more memory than this machine has");
  sweep_->add_option("--most-levels", most_levels_, "largest number of levels of every run")
      ->type_name("N")
      ->check(positive_integer);
  sweep_->add_flag("--dry-run", dry_run_, "validate and list the runs without running any");
  sweep_->add_flag("--retry-failed", retry_failed_, "rerun failed runs");
  sweep_->add_flag("-q,--quiet", quiet_, "no progress on standard error; failed runs are still listed");
  sweep_->add_flag("--report", report_, "write every run's report.html and its pictures");
  sweep_->add_flag("--wait", wait_, "with slurm: wait for the jobs and list the runs");
  sweep_->add_flag("--cancel", cancel_, "with slurm: cancel the sweep's jobs");
  sweep_
      ->add_option("--sbatch", sbatch_,
                   "with slurm: a further option of sbatch, as --sbatch=--partition=long; may be repeated")
      ->type_name("OPTION")
      ->allow_extra_args(false);

  job_->add_option("folder", out_, "the sweep's folder")->required();
  job_->add_option("--task", task_, "index of the run; without it, collect the runs' statuses");
  job_->add_option("--threads", threads_, "threads of the run")->check(positive_integer);
  job_->add_flag("--report", report_, "write the run's report");
}

void SweepCommand::check_options(int threads) const {
  if (engine_ != "slurm") {
    const char* given = wait_ ? "--wait" : cancel_ ? "--cancel" : !sbatch_.empty() ? "--sbatch" : nullptr;
    if (given) throw std::runtime_error(std::string(given) + " is of --engine slurm; give that too");
    const long workers = std::max(1, workers_), cores = core_count();
    if (workers * threads > cores)
      throw std::runtime_error(std::to_string(workers) + " × " + std::to_string(threads) +
                               " threads (workers × threads) are more than the " + std::to_string(cores) +
                               " cores that this process may use; lower --workers or --threads");
  }
}

int SweepCommand::run(const Registry& registry) const {
  ConfigErrors errors;
  const std::optional<Sweep> sweep = read_sweep(config_, registry, errors, most_levels_);
  if (!sweep) return report_errors(errors);
  const int threads = threads_ ? threads_ : sweep->parameters.threads;
  check_options(threads);
  const SweepFolder folder(out_.empty() ? std::filesystem::path("results") / sweep->parameters.name
                                        : std::filesystem::path(out_));
  if (dry_run_) {
    show_plan(*sweep, folder, threads);
    return exit_done;
  }
  stop_on_signals();  // nothing to save before this point
  return engine_ == "slurm" ? run_slurm(*sweep, folder) : run_local(*sweep, folder);
}

int SweepCommand::run_local(const Sweep& sweep, const SweepFolder& folder) const {
  if (!allow_memory_) MemoryEstimate(sweep, folder).require(sweep, folder, machine_memory());
  const FolderLock lock(folder.path());
  refuse_while_queued(folder);
  LocalOptions options;
  options.threads = threads_ ? threads_ : sweep.parameters.threads;
  options.workers = workers_ ? workers_ : core_count() / options.threads;
  options.memory_limit = memory_limit_ * 1e9;
  options.report = report_;
  options.quiet = quiet_;
  options.time_limit = sweep.parameters.time_limit.value_or(0);
  options.stop = [&] { return stop_signal() != 0; };
  folder.prepare(sweep, options.threads);
  return begun(folder, [&] {
    run_locally(sweep, folder, folder.missing(sweep, retry_failed_), options);
    const auto json = folder.refresh();
    std::cout << printable_lines(list_of_runs(json));
    if (stop_signal()) {
      std::cerr << "stopped on request; the same command runs what is missing\n";
      return exit_by_signal + stop_signal();
    }
    return exit_code_of(folder);
  });
}

int SweepCommand::run_slurm(const Sweep& sweep, const SweepFolder& folder) const {
  const auto stop = [&] { return stop_signal() != 0; };
  if (cancel_) {
    cancel_jobs(folder, stop);
    std::cout << printable_lines(list_of_runs(folder.refresh()));
    return exit_done;
  }
  std::optional<SlurmJobs> jobs;
  {
    const FolderLock lock(folder.path());
    refuse_while_queued(folder);
    SlurmOptions options;
    options.threads = threads_ ? threads_ : sweep.parameters.threads;
    options.workers = workers_;
    options.memory = memory_limit_ * 1e9;
    options.report = report_;
    options.sbatch = sbatch_;
    folder.prepare(sweep, options.threads);
    const int submitted = begun(folder, [&] {
      const std::vector<std::size_t> missing = folder.missing(sweep, retry_failed_);
      if (missing.empty()) return exit_done;
      jobs = submit(sweep, folder, missing, options);
      std::cout << "submitted: " << missing.size() << " runs as job array " << jobs->array
                << ", collected by job " << jobs->collector << "; their output is in "
                << (folder.slurm() / "logs").string() << std::endl;
      return exit_done;
    });
    if (submitted != exit_done) return submitted;
  }
  if (jobs && !wait_) return exit_done;
  return begun(folder, [&] {
    if (jobs && !wait_for(folder, *jobs, stop, quiet_)) {
      std::cerr << "no longer waiting; the jobs go on\n";
      return exit_by_signal + stop_signal();
    }
    const auto json = folder.finalize();
    std::cout << printable_lines(list_of_runs(json));
    return exit_code_of(folder);
  });
}

int SweepCommand::run_job() const {
  stop_on_signals();
  const SweepFolder folder(out_);
  if (task_ < 0) {
    collect_tasks(folder);
    return exit_done;
  }
  return run_task(folder, task_, std::max(1, threads_), report_, [&] { return stop_signal() != 0; });
}

}  // namespace drape

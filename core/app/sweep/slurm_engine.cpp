#include "core/app/sweep/slurm_engine.h"

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <chrono>
#include <cmath>
#include <thread>

#include "core/app/files/json_file.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"

namespace drape {

namespace fs = std::filesystem;

namespace {

/// "0-3,7", as sbatch expects indices.
std::string ranges(const std::vector<std::size_t>& sorted) {
  std::string text;
  for (std::size_t k = 0; k < sorted.size();) {
    std::size_t last = k;
    while (last + 1 < sorted.size() && sorted[last + 1] == sorted[last] + 1) ++last;
    text += (text.empty() ? "" : ",") + std::to_string(sorted[k]);
    if (last > k) text += "-" + std::to_string(sorted[last]);
    k = last + 1;
  }
  return text;
}

std::string one_line(const std::string& text) {
  return boost::replace_all_copy(boost::trim_right_copy(text), "\n", " ");
}

std::string directives(const std::vector<std::string>& options) {
  std::string text = "#!/bin/sh\n";
  for (const std::string& option : options) text += "#SBATCH " + option + "\n";
  return text;
}

bool is_job(const std::string& id) { return id.find_first_not_of("0123456789") == id.npos; }

std::string submit_script(const fs::path& script, std::vector<std::string> words) {
  words.insert(words.begin(), {"sbatch", "--parsable"});
  words.push_back(script.string());
  const ProgramOutput said = run_program(words);
  if (said.exit.code == 127)
    throw std::runtime_error(
        "sbatch: not found; install Slurm's client (slurm-client), or use --engine local");
  if (said.exit.code != 0)
    throw std::runtime_error("sbatch refused " + script.string() + ": " + one_line(said.err));
  std::string id = one_line(said.out.substr(0, said.out.find(';')));  // "id;cluster" with several clusters
  if (id.empty() || !is_job(id))
    throw std::runtime_error("sbatch answers \"" + excerpt(id) +
                             "\", no job's number; take out what of --sbatch keeps it from submitting one");
  return id;
}

/// Whether any of the jobs is queued, running or ending.
bool in_queue(const SlurmJobs& jobs) {
  std::string ids = jobs.array;
  if (!jobs.collector.empty()) ids += "," + jobs.collector;
  const ProgramOutput said = run_program({"squeue", "--noheader", "--format=%i", "--jobs=" + ids});
  if (said.exit.code == 0) return !said.out.empty();
  if (said.err.find("Invalid job id") != std::string::npos) return false;  // finished, and no longer known
  throw std::runtime_error("cannot ask Slurm for the jobs " + ids + ": " +
                           (said.exit.code == 127 ? "squeue is not installed here" : one_line(said.err)));
}

/// As `in_queue`, but tolerates minutes without an answer of Slurm's controller.
bool still_in_queue(const SlurmJobs& jobs, int& silent) {
  try {
    const bool queued = in_queue(jobs);
    silent = 0;
    return queued;
  } catch (const std::runtime_error& error) {
    if (++silent > 600) throw;
    if (silent == 1) std::fprintf(stderr, "warning: %s; asking again\n", printable(error.what()).c_str());
    return true;
  }
}

/// The last jobs that were submitted for the folder; empty without any.
std::optional<SlurmJobs> submitted_jobs(const SweepFolder& folder) {
  const Json json = parse_json(text_of_file(folder.jobs()));
  if (!json.is_object()) return std::nullopt;
  const JsonFile file(folder.jobs(), "see which of its jobs are in the queue (`squeue`), then remove it");
  SlurmJobs jobs{file.find<std::string>(json, "array").value_or(""),
                 file.find<std::string>(json, "collector").value_or("")};
  for (const std::string& id : {jobs.array, jobs.collector})  // others would be options of scancel
    if (!is_job(id)) file.refuse("a job is a number, not " + excerpt(id));
  return jobs;
}

}  // namespace

void refuse_in_scripts(const SweepFolder& folder) {
  for (const fs::path& path : {folder.path(), fs::absolute(folder.path()), own_program()})
    if (std::ranges::any_of(path.string(), [](unsigned char c) {
          return c < ' ' || c == '\x7f' || c == '"' || c == '\\' || c == '%';
        }))
      refuse_path(
          path,
          "its name has a control character, \", \\ or %, which the scripts of Slurm's jobs cannot have; "
          "name another folder with --out");
}

void refuse_while_queued(const SweepFolder& folder) {
  const auto jobs = submitted_jobs(folder);
  if (jobs && in_queue(*jobs))
    refuse_path(folder.path(), "its jobs " + jobs->array + " and " + jobs->collector +
                                   " are still queued or running (`squeue`); wait for them, or take them off "
                                   "the queue with --cancel");
}

SlurmJobs submit(const Sweep& sweep, const SweepFolder& folder, const std::vector<std::size_t>& missing,
                 const SweepOptions& options) {
  const fs::path slurm = fs::absolute(folder.slurm()).lexically_normal(), logs = slurm / "logs";
  for (const fs::path& own : {slurm, logs}) make_folder(own);
  const MemoryEstimate memory(sweep, folder);
  double bytes = 0;
  for (const std::size_t k : missing) bytes = std::max(bytes, 1.2 * memory.bytes(sweep.runs[k]));
  if (options.memory > 0) bytes = options.memory;

  const std::string name = "drape-" + sweep.parameters.name;
  const std::string job =
      shell_quoted(own_program()) + " sweep-job " + shell_quoted(fs::absolute(folder.path()).string());
  write_file(slurm / "job.sh",
             directives({"--job-name=" + name,
                         "--array=" + ranges(missing) +
                             (options.workers ? "%" + std::to_string(options.workers) : ""),
                         "--cpus-per-task=" + std::to_string(options.threads),
                         "--mem=" + std::to_string(std::llround(std::ceil(bytes / 1048576))) + "M",
                         "--requeue", "--open-mode=append", "--output=\"" + (logs / "%a.out").string() + "\"",
                         "--error=\"" + (logs / "%a.err").string() + "\""}) +
                 "exec " + job + " --threads " + std::to_string(options.threads) +
                 (options.report ? " --report" : "") + " --task \"$SLURM_ARRAY_TASK_ID\"\n");
  write_file(slurm / "collect.sh", directives({"--job-name=" + name + "-collect", "--requeue", "--mem=100M",
                                               "--output=\"" + (logs / "collect.out").string() + "\"",
                                               "--error=\"" + (logs / "collect.err").string() + "\""}) +
                                       "exec " + job + "\n");

  SlurmJobs jobs;
  const auto remember = [&] {
    write_file(folder.jobs(), json_text({{"array", jobs.array}, {"collector", jobs.collector}}, 1) + "\n");
  };
  jobs.array = submit_script(slurm / "job.sh", options.sbatch);
  remember();  // before anything else can fail: they must stay cancellable
  std::vector<std::string> after = options.sbatch;
  after.push_back("--dependency=afterany:" + jobs.array);
  jobs.collector = submit_script(slurm / "collect.sh", after);
  remember();
  return jobs;
}

bool wait_for(const SweepFolder& folder, const SlurmJobs& jobs, const SweepOptions& options) {
  std::size_t told = 0;
  for (int silent = 0; still_in_queue(jobs, silent);) {
    std::size_t done = 0, failed = 0;
    const Json sweep = folder.read();
    for (const Json& run : sweep["runs"]) {
      const RunState state = read_status(folder.files(run["folder"])).state;
      done += state == RunState::converged || state == RunState::not_converged || state == RunState::failed;
      failed += state == RunState::failed;
    }
    if (done != told && !options.quiet)
      std::fprintf(stderr, "[%zu/%zu] done, %zu failed\n", done, sweep["runs"].size(), failed);
    told = done;
    for (int k = 0; k < 10; ++k) {
      if (options.stop()) return false;
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
  return true;
}

void cancel_jobs(const SweepFolder& folder, const SweepOptions& options) {
  const auto jobs = submitted_jobs(folder);
  if (!jobs || !in_queue(*jobs))
    refuse_path(folder.path(), "has no jobs in Slurm's queue; there is nothing to cancel");
  std::vector<std::string> words = {"scancel", jobs->array};
  if (!jobs->collector.empty()) words.push_back(jobs->collector);
  const ProgramOutput said = run_program(words);
  if (said.exit.code != 0) throw std::runtime_error("scancel: " + one_line(said.err));
  if (wait_for(folder, *jobs, options)) collect_tasks(folder);
}

int run_task(const SweepFolder& folder, int index, const SweepOptions& options) {
  const Json sweep = folder.read();
  if (index < 0 || index >= int(sweep["runs"].size()))
    refuse_path(folder.path(), "sweep.json has no run " + std::to_string(index));
  const RunFiles files = folder.files(sweep["runs"][index]["folder"]);
  // A node that Slurm considers dead may still execute the task that is restarted elsewhere.
  FileLock lock(files.lock());
  while (!lock.acquire(1))
    if (options.stop()) return exit_by_signal + SIGINT;
  if (const RunStatus before = resolve_status(files, read_status(files)); before.has_results()) {
    write_status(files, before);
    return before.exit_code;
  }
  RunProcess run(files, options, sweep["time_limit"]);
  for (bool stopped = false; !run.ended();) {
    if (options.stop() && !stopped) stopped = true, run.stop();
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

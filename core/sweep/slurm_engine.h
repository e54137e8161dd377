#pragma once

#include <functional>

#include "core/sweep/sweep_folder.h"

namespace drape {

struct SlurmOptions {
  int workers = 0;  ///< runs at a time; 0: as many as the cluster takes
  int threads = 1;
  double memory = 0;  ///< of each run [bytes]; 0: by estimate
  bool report = false;
  std::vector<std::string> sbatch;  ///< further options, as "--partition=long"
};

/// A sweep's jobs on the cluster: an array over the missing runs, and one after it that collects.
struct SlurmJobs {
  std::string array, collector;
};

/// The jobs last submitted for the folder, collected or not; nothing if there were none.
std::optional<SlurmJobs> submitted_jobs(const SweepFolder& folder);

/// Throws std::runtime_error while jobs of the folder are queued or running.
void refuse_while_queued(const SweepFolder& folder);

/// Writes slurm/job.sh and slurm/collect.sh and submits them. Throws std::runtime_error with what sbatch
/// says.
SlurmJobs submit(const Sweep& sweep, const SweepFolder& folder, const std::vector<std::size_t>& missing,
                 const SlurmOptions& options);

/// Waits until none of the jobs is in the queue, telling standard error how it goes; false if `stop` came
/// first.
bool wait_for(const SweepFolder& folder, const SlurmJobs& jobs, const std::function<bool()>& stop);

/// Takes the folder's jobs off the queue and waits until they are gone. Throws if there are none.
void cancel_jobs(const SweepFolder& folder, const std::function<bool()>& stop);

/// What an array's task does, on its node: the run of sweep.json with this index, unless it has results.
/// Returns the task's exit code.
int run_task(const SweepFolder& folder, int index, int threads, bool report,
             const std::function<bool()>& stop);

/// What the collecting job does.
void collect_tasks(const SweepFolder& folder);

}  // namespace drape

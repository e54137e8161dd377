#pragma once

#include "core/app/sweep/sweep_folder.h"

namespace drape {

/// A sweep's jobs: an array over the missing runs, and a subsequent one that collects their statuses.
struct SlurmJobs {
  std::string array, collector;
};

/// Throws std::runtime_error while jobs of the folder are queued or running.
void refuse_while_queued(const SweepFolder& folder);

/// Throws std::runtime_error for a folder, or a path of this program, that sbatch would read otherwise: in a
/// script's directives a line ends the text, and % begins what Slurm puts in its place.
void refuse_in_scripts(const SweepFolder& folder);

/// Writes slurm/job.sh and slurm/collect.sh and submits them. Throws std::runtime_error with sbatch's
/// message.
SlurmJobs submit(const Sweep& sweep, const SweepFolder& folder, const std::vector<std::size_t>& missing,
                 const SweepOptions& options);

/// Waits until no job is in the queue, with progress on standard error unless `quiet`; false if `stop` came
/// first.
bool wait_for(const SweepFolder& folder, const SlurmJobs& jobs, const SweepOptions& options);

/// Cancels the folder's jobs and waits until they are off the queue. Throws std::runtime_error without any.
void cancel_jobs(const SweepFolder& folder, const SweepOptions& options);

/// A task of the array, on its node: executes the run with this index in sweep.json, unless it has results.
/// Returns the task's exit code.
int run_task(const SweepFolder& folder, int index, const SweepOptions& options);

/// The collecting job.
void collect_tasks(const SweepFolder& folder);

}  // namespace drape

#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/kernel/plugin/registry.h"

namespace drape {

/// `drape sweep`, and `drape sweep-job`, which its jobs on a cluster execute.
class SweepCommand {
 public:
  explicit SweepCommand(CLI::App& app);

  bool chosen() const { return sweep_->parsed(); }
  bool job_chosen() const { return job_->parsed(); }
  /// Both return the exit code.
  int run(const Registry& registry) const;
  int run_job() const;

 private:
  int run_local(const struct Sweep& sweep, const class SweepFolder& folder) const;
  int run_slurm(const struct Sweep& sweep, const class SweepFolder& folder) const;
  void check_options(int threads) const;

  CLI::App *sweep_, *job_;
  std::string config_, out_, engine_ = "local";
  std::vector<std::string> sbatch_;
  int workers_ = 0, threads_ = 0, task_ = -1;
  double memory_limit_ = 0;
  std::optional<int> most_levels_;
  bool dry_run_ = false, retry_failed_ = false, report_ = false, wait_ = false, cancel_ = false,
       allow_memory_ = false, quiet_ = false;
};

}  // namespace drape

#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "core/app/cli/config_arguments.h"
#include "core/app/run/checkpoint_manager.h"
#include "core/app/run/runner.h"

namespace drape {

/// `drape run`: runs an experiment; with --resume, resumes a run or warm-starts another one from its state.
class RunCommand {
 public:
  explicit RunCommand(CLI::App& app);
  RunCommand(const RunCommand&) = delete;  // options write into it

  bool chosen() const { return command_->parsed(); }
  /// After parsing: throws CLI::RequiredError if neither an experiment nor a run to resume is named.
  void check() const;
  /// Returns the exit code.
  int run(const Registry& registry) const;

 private:
  int run_config(const Registry& registry) const;
  int report_complete_run(const RunFolder& run, const Registry& registry) const;
  int resume(const Registry& registry) const;
  int warm_start(const Registry& registry) const;
  int run(const Experiment& experiment, const Scene& scene, RunOptions options,
          std::optional<InterruptedRun> interrupted) const;

  CLI::App* command_;
  ConfigArguments arguments_;
  RunOptions options_;
  std::string resumed_;       // the results folder of --resume
  std::optional<int> level_;  // of the state to warm-start from
  bool view_ = false, keep_view_ = false;
  int threads_ = 0, port_ = 0;
};

}  // namespace drape

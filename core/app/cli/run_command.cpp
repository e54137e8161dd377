#include "core/app/cli/run_command.h"

#include <csignal>
#include <iostream>
#include <sstream>
#include <thread>

#include "core/app/cli/help.h"
#include "core/app/cli/stop_signals.h"
#include "core/app/experiment/exit_codes.h"
#include "core/app/experiment/method_choice.h"
#include "core/app/run/recorder_files.h"
#include "core/app/run/run_folder.h"
#include "core/app/view/live_view.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/threads/parallel.h"

namespace drape {

namespace {

/// Says which methods a run left out because the user named none.
void show_other_methods(const Experiment& experiment, const std::string& run) {
  std::vector<std::string> others;
  for (const auto& [name, solver] : experiment.methods)
    if (name != run) others.push_back(name);
  if (!others.empty())
    std::cerr << "only " << run << " was run; --method all adds " << joined(others) << "\n";
}

}  // namespace

RunCommand::RunCommand(CLI::App& app) {
  command_ = app.add_subcommand("run", "run an experiment and write its results and report");
  show_example(*command_, "drape run configs/sphere.yaml --levels 3 --method all -o results/sphere");
  arguments_.add_to(*command_);
  arguments_.config_option->required(false);
  command_
      ->add_option_function<std::string>(
          "-o,--out", [this](const std::string& folder) { options_.out = folder; },
          "results folder (default: results/NAME)")
      ->type_name("FOLDER");
  command_
      ->add_option("--method", options_.methods,
                   "methods to run, or all (default: pcs, or the experiment's only method)")
      ->type_name("A,B")
      ->delimiter(',')
      ->allow_extra_args(false);
  command_->add_option("-j,--threads", threads_, "threads (default: one per core that the process may use)")
      ->type_name("N")
      ->check(positive_integer);
  command_->add_flag("--overwrite", options_.overwrite,
                     "replace the results of an earlier run in the folder");
  command_
      ->add_option(
          "--resume", resumed_,
          "results folder of an interrupted run to resume; with --set, --levels, --level or --method: start "
          "another run from its state, in the folder of --out")
      ->type_name("FOLDER");
  command_
      ->add_option("--level", level_,
                   "with --resume: level of the state to start from (default: the run's last one)")
      ->type_name("N");
  command_
      ->add_option("--checkpoint", options_.checkpoint,
                   "approximate interval of checkpoints in seconds (default 5; 0: at every step)")
      ->type_name("SECONDS")
      ->check(number_of_at_least(0));
  CLI::Option* quiet = command_->add_flag_function(
      "-q,--quiet", [this](std::int64_t) { options_.verbosity = Verbosity::quiet; },
      "no progress on standard error");
  command_
      ->add_flag_function(
          "-v,--verbose", [this](std::int64_t) { options_.verbosity = Verbosity::iterations; },
          "a line on standard error for every iteration")
      ->excludes(quiet);
  CLI::Option* show =
      command_->add_flag("--view", view_, "serve a live view of the run on 127.0.0.1; prints its address");
  command_->add_option("--port", port_, "with --view: port (default: any free one)")
      ->type_name("N")
      ->check([](const std::string& text) -> std::string {
        const std::optional<int> number = parse_integer(text);
        return number && *number >= 0 && *number <= 65535 ? "" : "must be a port, 0 to 65535, not " + text;
      })
      ->needs(show);
  command_
      ->add_flag("--view-keep", keep_view_, "with --view: keep serving the view after the run, until Ctrl-C")
      ->needs(show);
  command_->add_flag("!--no-report", options_.report, "write no report.html and pictures");
}

void RunCommand::check() const {
  if (chosen() && arguments_.config.empty() && resumed_.empty())
    throw CLI::RequiredError(arguments_.config_option->get_name());
}

int RunCommand::run(const Registry& registry) const {
  set_thread_count(threads_);
  if (resumed_.empty()) {
    if (level_) throw std::runtime_error("--level is of a saved state; name its run with --resume");
    return run_config(registry);
  }
  const auto refuse = [](const std::string& why) { throw std::runtime_error("--resume " + why); };
  if (!arguments_.config.empty())
    refuse("takes the experiment from the run's own config.yaml; leave out " + arguments_.config +
           ", and change parameters with --set KEY=VALUE");
  if (arguments_.allow_start_repair)
    refuse("starts from a state without intersections; leave out --allow-start-repair");
  const bool changed =
      !arguments_.sets.empty() || arguments_.levels > 0 || level_ || !options_.methods.empty();
  if (!changed && !options_.out.empty())
    refuse(
        "resumes in the run's own folder; leave out --out, or start another run with --set, --level or "
        "--method");
  if (!changed && options_.overwrite) refuse("keeps the existing results; leave out --overwrite");
  if (!changed) return resume(registry);
  if (options_.out.empty())
    refuse("with --set, --levels, --level or --method is another run; name its folder with --out");
  std::error_code error;
  if (std::filesystem::equivalent(options_.out, resumed_, error))
    refuse(
        "with --set, --levels, --level or --method leaves the run that it begins from as it is; name "
        "another folder with --out");
  return warm_start(registry);
}

int RunCommand::run_config(const Registry& registry) const {
  Loaded loaded(arguments_, registry);
  if (loaded.exit_code) return loaded.exit_code;
  RunOptions options = options_;
  if (options.out.empty())
    options.out = std::filesystem::path("results") / loaded.experiment->parameters.name;
  options.methods = chosen_methods(*loaded.experiment, options_.methods);
  const int exit_code = run(*loaded.experiment, *loaded.scene, options, std::nullopt);
  if (options_.methods.empty() && options.verbosity != Verbosity::quiet && exit_code < exit_by_signal)
    show_other_methods(*loaded.experiment, options.methods[0]);
  return exit_code;
}

/// For a complete run: checks its files and returns its exit code.
int RunCommand::report_complete_run(const RunFolder& run, const Registry& registry) const {
  const std::filesystem::path& folder = run.path();
  refuse_damaged_results(folder);
  ConfigErrors errors;
  const auto experiment = read_experiment(folder / "config.yaml", {}, registry, errors);
  const auto scene = experiment ? build_scene(*experiment, errors, IntersectingStart::allowed) : nullptr;
  if (!errors.empty()) return report_errors(errors);
  const std::vector<std::string> again = write_rest(run, *scene);
  if (!again.empty())
    std::cerr << "warning: damaged or missing files were written again: " << joined(again) << "\n";
  std::cout << folder.string() << ": the run is complete; there is nothing to resume\n";
  return all_methods_succeeded(folder) ? exit_done : exit_not_converged;
}

/// Resumes an interrupted run in its folder, which is locked before anything in it is read.
int RunCommand::resume(const Registry& registry) const {
  const std::filesystem::path folder = resumed_;
  RunFolder locked = RunFolder::of_run(folder);
  if (is_complete(folder)) return report_complete_run(locked, registry);
  std::string warning;
  InterruptedRun interrupted = interrupted_run(std::move(locked), warning);
  const Checkpoint& checkpoint = interrupted.checkpoint;
  std::istringstream warnings(warning);
  for (std::string line; std::getline(warnings, line);) std::cerr << "warning: " << printable(line) << "\n";
  ConfigErrors errors;
  const auto experiment = read_experiment(folder / "config.yaml", {}, registry, errors);
  if (experiment) refuse_too_large(*experiment, arguments_.large_memory(), errors);
  const auto scene = errors.empty() ? build_scene(*experiment, errors, IntersectingStart::allowed) : nullptr;
  if (scene && checkpoint.start.rows() > 0)
    warm_start_scene(*experiment, *scene, checkpoint.first_level, checkpoint.start, errors);
  if (!errors.empty()) return report_errors(errors);
  RunOptions options = options_;
  options.out = folder;
  options.methods = checkpoint.methods;
  return run(*experiment, *scene, std::move(options), std::move(interrupted));
}

/// Warm-starts a possibly changed experiment from a state of a run, in another folder.
int RunCommand::warm_start(const Registry& registry) const {
  const std::filesystem::path folder = resumed_, config = folder / "config.yaml";
  RunOptions options = options_;
  if (options.methods.size() > 1)
    throw std::runtime_error("--resume with --method: name one method, whose state to start from");
  const SavedState state = saved_state(folder, options.methods.empty() ? "" : options.methods[0], level_);
  ConfigErrors errors;
  const auto before = read_experiment(config, {}, registry, errors);
  if (!before) return report_errors(errors);
  const auto experiment = read_experiment(config, arguments_.overrides(), registry, errors);
  if (experiment) refuse_other_cloth(*before, *experiment, state.level, errors);
  if (errors.empty()) refuse_too_large(*experiment, arguments_.large_memory(), errors);
  const auto scene = errors.empty() ? build_scene(*experiment, errors, IntersectingStart::allowed) : nullptr;
  if (scene) warm_start_scene(*experiment, *scene, state.level, state.x, errors);
  if (!errors.empty()) return report_errors(errors);
  options.methods = {state.method};
  options.first_level = state.level;
  options.warm_started_from =
      folder.string() + ", method " + state.method + ", level " + std::to_string(state.level);
  return run(*experiment, *scene, std::move(options), std::nullopt);
}

/// Runs an experiment, or resumes it from a checkpoint.
int RunCommand::run(const Experiment& experiment, const Scene& scene, RunOptions options,
                    std::optional<InterruptedRun> interrupted) const {
  stop_on_signals();  // nothing to save before this point
  options.stop = [] { return stop_signal() != 0; };
  std::optional<LiveView> view;
  if (view_) {
    view.emplace(experiment, scene, options.methods, port_);
    options.view = &*view;
    std::cout << "view: " << view->url() << std::endl;
  }
  const bool converged = interrupted ? resume_experiment(experiment, scene, options, std::move(*interrupted))
                                     : run_experiment(experiment, scene, options);
  if (options.report)
    std::cout << "report: " << (options.out / "report.html").string() << "\n";
  else
    std::cout << "results: " << (options.out / "results.json").string() << "\n";
  const bool stopped = stop_signal() != 0 || (view && view->stop_requested());
  const int as_signal = stop_signal() ? stop_signal() : SIGINT;  // the view's Stop counts as Ctrl-C
  if (keep_view_ && !stop_signal()) {
    std::cout << "the view stays at " << view->url() << " until Ctrl-C" << std::endl;
    while (!stop_signal()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  if (stopped) {
    std::cerr << "stopped on request; everything up to then is in " << options.out.string() << "\n";
    return exit_by_signal + as_signal;
  }
  return converged ? exit_done : exit_not_converged;
}

}  // namespace drape

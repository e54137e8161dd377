#include <csignal>
#include <iostream>
#include <thread>

#include "core/app/cli/commands.h"
#include "core/app/cli/config_arguments.h"
#include "core/app/experiment/exit_codes.h"
#include "core/app/report/run_data.h"
#include "core/app/report/run_table.h"
#include "core/app/run/runner.h"
#include "core/app/run/saved_run.h"
#include "core/app/setup/build_scene.h"
#include "core/app/view/live_view.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/kernel/threads/parallel.h"

namespace drape {

namespace {

/// The command line of `drape run`.
struct RunRequest : RunOptions, ConfigArguments {
  std::string resumed;       ///< the results folder of --resume
  std::optional<int> level;  ///< of the state to warm-start from
  bool show = false, keep_view = false;
  int threads = 0, port = 0;
};

/// Says which methods a run left out because the user named none.
void show_other_methods(const Experiment& experiment, const std::string& run) {
  std::vector<std::string> others = experiment.method_names();
  std::erase(others, run);
  if (!others.empty())
    std::cerr << "only " << run << " was run; --method all adds " << joined(others) << "\n";
}

/// Says which methods have not converged, and why: a quiet run has told nothing of it.
int exit_code_of(const RunData& run) {
  for (const MethodRecord& method : run.methods) {
    if (has_converged(method.status)) continue;
    std::string line = "error: " + method.name + ": " + method.status;
    for (const LevelRecord& level : method.levels)
      if (!has_converged(level.status))
        line += "; level " + std::to_string(level.level) + " " + level.status +
                (level.message.empty() ? "" : ": " + level.message);
    std::cerr << printable(line) << "\n";
  }
  return run.converged() ? exit_done : exit_not_converged;
}

int run(RunRequest& r, const Experiment& experiment, const Scene& scene,
        std::optional<InterruptedRun> interrupted = std::nullopt) {
  stop_on_signals();  // nothing to save before this point
  r.stop = [] { return stop_signal() != 0; };
  std::optional<LiveView> view;
  if (r.show) {
    view.emplace(experiment, scene, r.methods, r.port);
    r.view = &*view;
    std::cout << "view: " << view->url() << std::endl;
  }
  const bool converged = interrupted ? resume_experiment(experiment, scene, r, std::move(*interrupted))
                                     : run_experiment(experiment, scene, r);
  const bool stopped = stop_signal() != 0 || (view && view->stop_requested());
  if (r.methods.size() > 1 && r.verbosity != Verbosity::quiet && !stopped)
    std::cerr << printable_lines(methods_text(table_of(read_runs({r.out}))));
  if (r.verbosity != Verbosity::quiet && member_of(complete_results(r.out), "measured") == false)
    std::cerr << "drape report " << printable(r.out.string())
              << " measures how near the preview is to the end, and draws pictures\n";
  if (r.report)
    std::cout << "report: " << printable((r.out / "report.html").string()) << "\n";
  else
    std::cout << "results: " << printable((r.out / "results.json").string()) << "\n";
  const int as_signal = stop_signal() ? stop_signal() : SIGINT;  // the view's Stop counts as Ctrl-C
  if (r.keep_view && !stop_signal()) {
    std::cout << "the view stays at " << view->url() << " until Ctrl-C" << std::endl;
    while (!stop_signal()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  if (stopped) {
    std::cerr << "stopped on request; everything up to then is in " << printable(r.out.string()) << "\n";
    return exit_by_signal + as_signal;
  }
  return converged ? exit_done : exit_code_of(read_run(r.out));
}

int run_config(RunRequest& r, const Registry& registry) {
  const LoadedExperiment loaded(r, registry);
  const Experiment& experiment = loaded.experiment;
  if (r.out.empty()) r.out = std::filesystem::path("results") / experiment.parameters.name;
  const bool named_none = r.methods.empty();
  r.methods = chosen_methods(experiment, r.methods);
  const int exit_code = run(r, experiment, *loaded.scene);
  if (named_none && r.verbosity != Verbosity::quiet && exit_code < exit_by_signal)
    show_other_methods(experiment, r.methods[0]);
  return exit_code;
}

/// Resumes an interrupted run in its folder.
int resume(RunRequest& r, const Registry& registry) {
  r.out = r.resumed;
  const Json complete = complete_results(r.out);
  r.measure = r.measure || !complete.is_null();  // all that a complete run can go on to
  if (member_of(complete, "measured") == false && r.verbosity != Verbosity::quiet)
    std::cerr << printable(r.resumed) << ": the run is complete; what it left to measure is measured now\n";
  std::vector<std::string> warnings;
  ConfigErrors errors;
  std::optional<SavedRun> saved = read_saved_run(r.out, registry, r.large_memory(), warnings, errors);
  warn_of(warnings);
  require_none(errors);
  if (!saved->interrupted) {
    std::cout << printable(r.resumed) << ": the run is complete; there is nothing to resume\n";
    return exit_code_of(read_run(r.out));
  }
  r.methods = saved->interrupted->checkpoint.methods;
  return run(r, saved->experiment, *saved->scene, std::move(saved->interrupted));
}

/// Warm-starts a possibly changed experiment from a state of a run, in another folder.
int warm_start(RunRequest& r, const Registry& registry) {
  const std::filesystem::path folder = r.resumed, config = folder / "config.yaml";
  if (r.methods.size() > 1)
    throw std::runtime_error("--resume with --method: name one method, whose state to start from");
  const SavedState state = saved_state(folder, r.methods.empty() ? "" : r.methods[0], r.level);
  ConfigErrors errors;
  const auto before = read_experiment(config, {}, registry, errors);
  require_none(errors);
  const auto experiment = read_experiment(config, r.overrides(), registry, errors, r.large_memory());
  if (experiment) refuse_other_cloth(*before, *experiment, state.level, errors);
  require_none(errors);
  const auto scene = build_scene(*experiment, errors, r.large_memory(), IntersectingStart::allowed);
  if (scene) warm_start_scene(*experiment, *scene, state.level, state.x, errors);
  require_none(errors);
  r.methods = {state.method};
  r.first_level = state.level;
  r.warm_started_from =
      folder.string() + ", method " + state.method + ", level " + std::to_string(state.level);
  return run(r, *experiment, *scene);
}

int run_or_resume(RunRequest& r, const Registry& registry) {
  set_thread_count(r.threads);
  if (r.resumed.empty()) {
    if (r.config.empty()) throw CLI::RequiredError("experiment");
    if (r.level) throw std::runtime_error("--level is of a saved state; name its run with --resume");
    return run_config(r, registry);
  }
  const auto refuse = [](const std::string& why) { throw std::runtime_error("--resume " + why); };
  if (!r.config.empty())
    refuse("takes the experiment from the run's own config.yaml; leave out " + r.config +
           ", and change parameters with --set KEY=VALUE");
  if (r.allow_start_repair)
    refuse("starts from a state without intersections; leave out --allow-start-repair");
  const bool changed = !r.sets.empty() || r.levels > 0 || r.level || !r.methods.empty();
  if (!changed && !r.out.empty())
    refuse(
        "resumes in the run's own folder; leave out --out, or start another run with --set, --level or "
        "--method");
  if (!changed && r.overwrite) refuse("keeps the existing results; leave out --overwrite");
  if (!changed) return resume(r, registry);
  if (r.out.empty())
    refuse("with --set, --levels, --level or --method is another run; name its folder with --out");
  std::error_code error;
  if (std::filesystem::equivalent(r.out, r.resumed, error))
    refuse(
        "with --set, --levels, --level or --method leaves the run that it begins from as it is; name "
        "another folder with --out");
  return warm_start(r, registry);
}

}  // namespace

void add_run_command(Commands& commands) {
  const auto request = std::make_shared<RunRequest>();
  CLI::App& command =
      commands.add_with_plugins("run", "run an experiment and write its results and report",
                                "drape run configs/sphere.yaml --levels 3 --method all -o results/sphere",
                                [request](const Registry& registry) {
                                  const int exit_code = run_or_resume(*request, registry);
                                  allow_lost_output();
                                  return exit_code;
                                });
  RunRequest& r = *request;  // lives as long as the command
  r.add_to(command)->required(false);
  add_option(command, "-o,--out FOLDER", r.out, "results folder (default: results/NAME)");
  add_option(command, "--method A,B", r.methods,
             "methods to run, or all (default: pcs, or the experiment's only method)")
      ->delimiter(',');
  add_option(command, "-j,--threads N", r.threads, "threads (default: one per core that the process may use)")
      ->check(integer_between(1, most_threads, "an integer from 1 to " + std::to_string(most_threads)));
  command.add_flag("--overwrite", r.overwrite, "replace the results of an earlier run in the folder");
  add_option(
      command, "--resume FOLDER", r.resumed,
      "results folder of an interrupted run to resume; with --set, --levels, --level or --method: start "
      "another run from its state, in the folder of --out");
  add_option(command, "--level N", r.level,
             "with --resume: level of the state to start from (default: the run's last one)");
  add_option(command, "--checkpoint SECONDS", r.checkpoint,
             "approximate interval of checkpoints in seconds (default 5; 0: at every step)")
      ->check(number_of_at_least(0));
  const auto set_verbosity = [&r](Verbosity verbosity) {
    return [&r, verbosity](std::int64_t) { r.verbosity = verbosity; };
  };
  CLI::Option* quiet = command.add_flag_function("-q,--quiet", set_verbosity(Verbosity::quiet),
                                                 "no progress on standard error");
  command
      .add_flag_function("-v,--verbose", set_verbosity(Verbosity::iterations),
                         "a line on standard error for every iteration")
      ->excludes(quiet);
  CLI::Option* show =
      command.add_flag("--view", r.show, "serve a live view of the run on 127.0.0.1; prints its address");
  add_option(command, "--port N", r.port, "with --view: port (default: any free one)")
      ->check(integer_between(0, 65535, "a port, 0 to 65535"))
      ->needs(show);
  command
      .add_flag("--view-keep", r.keep_view, "with --view: keep serving the view after the run, until Ctrl-C")
      ->needs(show);
  command.add_flag("!--no-report", r.report, "write no report.html and pictures");
  r.measure = false;
  command.add_flag(
      "--measure", r.measure,
      "measure previews and errors and draw pictures at once; a run of one method leaves them to "
      "the first report, table, figure or comparison that asks for them");
}

}  // namespace drape

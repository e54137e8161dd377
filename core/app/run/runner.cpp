#include "core/app/run/runner.h"

#include <algorithm>
#include <cstdio>
#include <optional>

#include "core/app/files/yaml_file.h"
#include "core/app/report/report.h"
#include "core/app/report/run_data.h"
#include "core/app/run/recorder_files.h"
#include "core/app/run/run_observer.h"
#include "core/app/view/live_view.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/threads/stopwatch.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/solve/newton_state.h"

namespace drape {

namespace {

/// Shows the results that a method had when the run was interrupted.
void catch_up(const MethodState& state, Progress& progress, LiveView* view) {
  for (const LevelResult& result : state.finished)
    if (view) view->level_started(result.level), view->level_finished(result);
  if (!state.under_way) return;
  progress.level_started(state.level);
  if (view) view->level_started(state.level);
}

/// Observes a solve that belongs to no method: it is not recorded, and stops when the run is to stop.
class UnrecordedObserver : public Observer {
 public:
  UnrecordedObserver(Progress& progress, RunObserver& run) : progress_(progress), run_(run) {}

  void level_started(int level) override {
    progress_.method_started("reference");
    progress_.level_started(level);
  }
  void iteration(const IterationRow& row, const Positions& x) override { progress_.iteration(row, x); }
  void level_finished(const LevelResult& result) override { progress_.level_finished(result); }
  bool stop_requested() override { return run_.stop_requested(); }

 private:
  Progress& progress_;
  RunObserver& run_;
};

/// What to do about an aborted run.
std::string way_on(const RunFolder& folder) {
  const std::string again = "run the experiment again with --overwrite: ";
  if (!has_checkpoint(folder.path())) return again + "there is no checkpoint of it";
  for (const char* needed : {"iterations.csv", "log.jsonl"})
    if (const auto file = folder.file(needed); !std::filesystem::exists(file))
      return again + "its " + needed + " is missing";
  return "resume it with drape run --resume " + folder.path().string();
}

/// Performs an action of a run that has begun; errors abort the run.
template <class Action>
bool with_folder(const RunFolder& folder, const RunOptions& options, const Action& action) {
  std::string cause;
  try {
    return action();
  } catch (const RunAborted&) {
    throw;
  } catch (...) {
    cause = message_in_flight();
  }
  const bool complete = !complete_results(folder.path()).is_null();
  if (!complete) record_abort(folder, cause);
  if (options.view) options.view->run_finished("the run was aborted: " + cause);
  if (complete)
    throw RunAborted(cause + "; the results are complete, and the next report measures what is missing");
  throw RunAborted(cause + "; the run is aborted. Once the cause is removed, " + way_on(folder));
}

/// Time that a stopped run still spends on its report's pictures [s].
constexpr double seconds_for_pictures = 2;

/// Writes the report. If that fails, the results remain.
void report_on(const RunFolder& folder, const std::function<bool()>& stopped) {
  const std::string name = folder.path().string();
  std::optional<Stopwatch> since_stop;
  const auto cancelled = [&] {
    if (!since_stop && stopped()) since_stop.emplace();
    return since_stop && since_stop->seconds() > seconds_for_pictures;
  };
  try {
    write_report(folder.path(), cancelled);
  } catch (const std::exception& error) {
    throw RunAborted(reason_of(error) + "; the results in " + name +
                     " are there without their report; write it with drape report " + name);
  }
}

/// Runs the remaining methods, beginning with the current one if `resumed`, then measures errors.
bool run(const Experiment& experiment, const Scene& scene, const RunOptions& options, const RunFolder& folder,
         Recorder& recorder, const Checkpoint& begun, bool resumed) {
  std::vector<std::string> changing;
  for (const ScheduleKey& key : experiment.parameters.schedule.keys) changing.push_back(key.parameter);
  Progress progress(experiment.parameters.newton.force_tolerance, experiment.parameters.level_count(),
                    options.verbosity, scene.load_stepping.get(), changing);
  RunObserver observer(experiment, scene, folder, recorder, progress, options, begun);

  bool cancelled = false, later = false;
  for (int m = begun.method; m < static_cast<int>(begun.methods.size()) && !cancelled; ++m) {
    const std::string& name = begun.methods[m];
    const Solver& solver = experiment.solver_of(name);
    const bool interrupted = resumed && m == begun.method;
    progress.method_started(name);
    if (options.view) options.view->method_started(name);
    if (options.method_started) options.method_started(name);
    if (scene.load_stepping) scene.load_stepping->begin(0, true);  // another method has left it at its end
    if (interrupted) {
      restore_load_stepping(scene, begun.state);  // that of the levels that are shown
      catch_up(begun.state, progress, options.view);
    } else {
      recorder.method_started(name);
    }
    observer.method_started(m, solver.can_resume(), interrupted);
    const MethodState state = observer.now().state;
    std::optional<MethodFailure> failure;
    try {
      const std::size_t returned = solver.resume(scene, state, observer).size(),
                        reported = observer.now().state.finished.size();
      if (returned == 0) throw std::runtime_error("the method solved no level");
      if (returned != reported)
        throw std::runtime_error("the method returned the results of " + std::to_string(returned) +
                                 " levels and reported " + std::to_string(reported) + " to its observer");
    } catch (const WriteError&) {
      throw;  // concerns the whole run
    } catch (...) {
      failure = {std::min(observer.level(), scene.finest()), message_in_flight()};
      progress.method_failed(failure->level, failure->cause);
      // What a prototype of Python raises, such as KeyboardInterrupt, stops the run, which is to be resumed
      // in this method.
      cancelled = observer.stop_requested();
    }
    const std::vector<LevelResult>& results = observer.now().state.finished;
    for (const LevelResult& r : results) cancelled = cancelled || r.outcome == Outcome::cancelled;
    // The last checkpoint, from which the run can go on to measure, is that of the method's last level.
    later = !options.measure && !cancelled && !failure && begun.methods.size() == 1 && !scene.reference &&
            solver.can_resume();
    recorder.method_finished(results, failure, !later);
  }
  UnrecordedObserver unrecorded(progress, observer);
  const bool measured = later || recorder.measure_errors(unrecorded, cancelled);
  for (const auto& [metric, cause] : recorder.not_measured()) progress.not_measured(metric, cause);
  const bool complete = !cancelled && measured;
  recorder.run_finished(complete, !later);
  if (complete && !later) remove_checkpoints(folder.path());
  if (options.report) report_on(folder, [&] { return observer.stop_requested(); });
  const bool good = recorder.all_converged();
  if (options.view)
    options.view->run_finished((!complete ? "stopped on request"
                                : good    ? "everything converged"
                                          : "not everything converged") +
                               ("; the results are in " + folder.path().string()));
  return good;
}

}  // namespace

bool run_experiment(const Experiment& experiment, const Scene& scene, const RunOptions& options) {
  const std::vector<std::string> methods = chosen_methods(
      experiment, options.methods.empty() ? std::vector<std::string>{all_methods} : options.methods);
  const std::string& start_file = experiment.parameters.start.file;
  TriangleMesh start;
  if (!start_file.empty()) start = read_mesh(start_file);  // it may be of the run that is overwritten
  refuse_long_paths(options.out, methods);
  const ConfigNode config = saved_config(experiment);
  const std::string config_text = to_yaml(config);
  if (first_unprintable(config_text) != config_text.npos)
    throw std::runtime_error(
        "a file of the experiment is in a folder whose name is no UTF-8, so that its config.yaml could not "
        "be read again; rename the folder");
  const RunFolder folder(options.out, options.overwrite, files_of(config));
  return with_folder(folder, options, [&] {
    Checkpoint begun;
    begun.config = config_text;
    begun.methods = methods;
    begun.first_level = options.first_level;
    if (!options.warm_started_from.empty()) begun.start = scene.starts[options.first_level];
    write_file(folder.file("config.yaml"), begun.config);
    if (!start_file.empty()) write_mesh(folder.file("start.ply"), start);
    Recorder recorder(folder, experiment, scene);
    if (options.verbosity != Verbosity::quiet)
      for (const std::string& line : remarks_of(experiment, scene))
        std::fprintf(stderr, "remark: %s\n", printable(line).c_str());
    if (!options.warm_started_from.empty()) recorder.warm_started_from(options.warm_started_from);
    begun.files = fingerprints_of_files(config, folder.path());
    return run(experiment, scene, options, folder, recorder, begun, false);
  });
}

bool resume_experiment(const Experiment& experiment, const Scene& scene, const RunOptions& options,
                       InterruptedRun interrupted) {
  const RunFolder& folder = interrupted.folder;
  const Checkpoint& checkpoint = interrupted.checkpoint;
  require_fitting(checkpoint, experiment, scene);
  refuse_short_files(folder, checkpoint.recorder);
  if (const std::filesystem::path table = folder.file("errors.csv");
      std::filesystem::exists(table) && !read_file(table).starts_with(errors_header))
    refuse_path(table, "drape did not write it, and would replace it; rename it");
  return with_folder(folder, options, [&] {
    folder.remove_unfinished();
    Recorder recorder(folder, experiment, scene, checkpoint.recorder);
    if (!recorder.restored().empty())
      std::fprintf(stderr, "warning: %s\n", written_again_text(recorder.restored()).c_str());
    return run(experiment, scene, options, folder, recorder, checkpoint, true);
  });
}

RunCollection measured_runs(const std::vector<std::filesystem::path>& folders,
                            const std::function<const Registry&()>& plugins,
                            std::vector<std::string>& warnings) {
  RunCollection runs = read_runs(folders);
  RunOptions silently;
  silently.verbosity = Verbosity::quiet;
  silently.report = false;
  bool any = false;
  for (const RunRecord& run : runs.runs) {
    if (!run.data || member_of(run.data->results, "measured") != false) continue;
    any = true;
    std::string cause;
    try {
      ConfigErrors errors;
      std::optional<SavedRun> saved =
          read_saved_run(run.folder, plugins(), LargeMemory::allowed, warnings, errors);
      if (!errors.empty())
        cause = errors.front().message;
      else if (saved->interrupted)
        resume_experiment(saved->experiment, *saved->scene, silently, std::move(*saved->interrupted));
    } catch (const std::exception& error) {
      cause = reason_of(error);
    }
    if (!cause.empty())
      warnings.push_back("what the run in " + run.folder.string() + " left to measure is missing: " + cause);
  }
  return any ? read_runs(folders) : runs;
}

}  // namespace drape

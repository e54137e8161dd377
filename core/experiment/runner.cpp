#include "core/experiment/runner.h"

#include <algorithm>
#include <cstdio>

#include "core/experiment/progress.h"
#include "core/experiment/recorder.h"
#include "core/experiment/yaml_file.h"
#include "core/mesh/io.h"
#include "core/report/report.h"
#include "core/view/live_view.h"

namespace drape {

namespace {

/// Passes everything on to the recorder, the progress bar and the live view.
class RunObserver : public Observer {
 public:
  RunObserver(Recorder& recorder, Progress& progress, LiveView* view, const std::function<bool()>& stop)
      : recorder_(recorder), progress_(progress), view_(view), stop_(stop) {}

  void level_started(int level) override {
    recorder_.level_started(level);
    progress_.level_started(level);
    if (view_) view_->level_started(level);
  }
  void iteration(const IterationRow& row, const Positions& x) override {
    recorder_.iteration(row, x);
    progress_.iteration(row, x);
    if (view_) view_->iteration(row, x);
  }
  void level_finished(const LevelResult& result) override {
    recorder_.level_finished(result);
    progress_.level_finished(result);
    if (view_) view_->level_finished(result);
  }
  bool stop_requested() override { return (stop_ && stop_()) || (view_ && view_->stop_requested()); }
  bool refine_requested() override { return view_ && view_->refine_requested(); }

 private:
  Recorder& recorder_;
  Progress& progress_;
  LiveView* view_;
  const std::function<bool()>& stop_;
};

/// Of what belongs to no method: nothing is recorded.
class UnrecordedObserver : public Observer {
 public:
  UnrecordedObserver(Progress& progress, const std::function<bool()>& stop)
      : progress_(progress), stop_(stop) {}

  void level_started(int level) override {
    progress_.method_started("reference");
    progress_.level_started(level);
  }
  void iteration(const IterationRow& row, const Positions& x) override { progress_.iteration(row, x); }
  void level_finished(const LevelResult& result) override { progress_.level_finished(result); }
  bool stop_requested() override { return stop_ && stop_(); }

 private:
  Progress& progress_;
  const std::function<bool()>& stop_;
};

void require_methods(const Experiment& experiment, const std::vector<std::string>& chosen) {
  std::string known;
  for (const auto& [name, solver] : experiment.methods) known += (known.empty() ? "" : ", ") + name;
  for (const std::string& name : chosen)
    if (std::none_of(experiment.methods.begin(), experiment.methods.end(),
                     [&](const auto& method) { return method.first == name; }))
      throw std::runtime_error("--method " + name + ": the experiment's methods are " + known);
}

/// The resolved experiment as it is read from the results folder: mesh files are the copies that lie there.
ConfigNode saved_config(const Experiment& experiment) {
  ConfigNode config = experiment.resolved;
  ConfigErrors none;
  if (experiment.parameters.cloth.shape == "file") set_path(config, "cloth.file", "rest/l0.ply", none);
  if (!experiment.parameters.start.file.empty()) set_path(config, "start.file", "start.ply", none);
  if (!experiment.parameters.reference.file.empty())
    set_path(config, "reference.file", "reference.ply", none);
  return config;
}

}  // namespace

bool run_experiment(const Experiment& experiment, const Scene& scene, const RunOptions& options) {
  require_methods(experiment, options.methods);
  const RunFolder folder(options.out, options.overwrite);
  folder.write_text("config.yaml", to_yaml(saved_config(experiment)));
  if (!experiment.parameters.start.file.empty())
    write_ply(folder.file("start.ply"), read_mesh(experiment.parameters.start.file));
  Recorder recorder(folder, experiment, scene);
  Progress progress(experiment.parameters.newton.force_tolerance, experiment.parameters.levels,
                    options.quiet);
  RunObserver observer(recorder, progress, options.view, options.stop);
  const Problem problem = scene.problem();

  bool all_converged = true, cancelled = false;
  for (const auto& [name, solver] : experiment.methods) {
    if (!options.methods.empty() &&
        std::find(options.methods.begin(), options.methods.end(), name) == options.methods.end())
      continue;
    if (cancelled) break;
    recorder.method_started(name);
    progress.method_started(name);
    if (options.view) options.view->method_started(name);
    const std::vector<LevelResult> results = solver->solve(problem, observer);
    recorder.method_finished(results);
    for (const LevelResult& r : results) {
      all_converged = all_converged && r.outcome == Outcome::converged;
      cancelled = cancelled || r.outcome == Outcome::cancelled;
    }
  }
  UnrecordedObserver unrecorded(progress, options.stop);
  const bool measured = recorder.measure_errors(unrecorded, cancelled);
  recorder.run_finished(!cancelled && measured);
  if (options.report) write_report(folder.path());
  const bool good = all_converged && recorder.sound();
  if (options.view)
    options.view->run_finished((cancelled ? "stopped on request"
                                : good    ? "everything converged"
                                          : "not everything converged") +
                               ("; the results are in " + folder.path().string()));
  return good;
}

}  // namespace drape

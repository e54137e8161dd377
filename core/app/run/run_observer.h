#pragma once

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/app/run/audit.h"
#include "core/app/run/checkpoint.h"
#include "core/app/run/recorder.h"
#include "core/app/run/runner.h"
#include "core/app/view/live_view.h"
#include "core/kernel/threads/stopwatch.h"

namespace drape {

/// The interval of checkpoints is at least this many times the time to save one.
inline constexpr double save_time_ratio = 100;

/// Passes everything on to the recorder, the progress bar and other observers. Saves checkpoints: at the
/// beginning of every method and level, on a stop request, and from time to time. Results do not depend on
/// it.
class RunObserver : public Observer {
 public:
  /// `begun` is the run's state at its beginning.
  RunObserver(const Experiment& experiment, const Scene& scene, const RunFolder& folder, Recorder& recorder,
              Progress& progress, const RunOptions& options, Checkpoint begun)
      : experiment_(experiment),
        scene_(scene),
        folder_(folder.path()),
        recorder_(recorder),
        options_(options),
        now_(std::move(begun)),
        method_clock_(now_.state.seconds),
        viewers_{&progress} {
    for (Observer* viewer : {static_cast<Observer*>(options.view), options.observer})
      if (viewer) viewers_.push_back(viewer);
  }

  /// The state at this point; its method is the current one.
  const Checkpoint& now() const { return now_; }
  int level() const { return level_; }

  /// An interrupted method goes on from the present state.
  void method_started(int method, bool resumable, bool interrupted) {
    resumable_ = resumable;
    if (!interrupted) {
      now_.method = method;
      now_.state = {};
      now_.state.level = now_.first_level;
      method_clock_ = Stopwatch();
      write();  // not excluded from the rows' time, whose clock begins after it
    }
    level_ = now_.state.level;
  }

  void level_started(int level) override {
    require_level(scene_, level);
    level_ = level;
    recorder_.level_started(level);
    for (Observer* viewer : viewers_) viewer->level_started(level);
  }
  void iteration(const IterationRow& row, const Positions& x) override {
    require_state(scene_, row.level, x);
    recorder_.iteration(row, x);
    for (Observer* viewer : viewers_) viewer->iteration(row, x);
  }
  void increment_finished(const IncrementRow& row, const Positions& x) override {
    require_state(scene_, row.level, x);
    recorder_.increment_finished(row, x);
    for (Observer* viewer : viewers_) viewer->increment_finished(row, x);
  }
  void level_finished(const LevelResult& reported) override {
    const WorkClock watch;
    LevelResult result = audited(scene_, reported, experiment_.force_tolerance(now_.methods.at(now_.method)));
    if (scene_.garment) result = scene_.garment->judged(std::move(result));
    const Work audit = watch.work();
    if (const auto& before = now_.state.finished; !before.empty() && result.level <= before.back().level)
      throw std::runtime_error("the method reported level " + std::to_string(result.level) + " after level " +
                               std::to_string(before.back().level) +
                               "; report levels from coarse to fine, each once");
    recorder_.level_finished(result);
    recorder_.exclude(audit);  // a level's seconds end before it
    now_.state.finished.push_back(result);
    if (resumable_ && result.outcome != Outcome::cancelled) {
      now_.state.level = result.level + 1;
      now_.state.under_way.reset();
      save();
    }
    for (Observer* viewer : viewers_) viewer->level_finished(result);
  }
  bool checkpoint_due() override {
    const double interval = std::max(options_.checkpoint, save_time_ratio * cost_);
    return resumable_ && (stop_requested() || options_.checkpoint == 0 || since_.seconds() > interval);
  }
  void checkpoint(const NewtonState& state) override {
    now_.state.level = state.so_far.level;
    now_.state.under_way = state;
    save();
  }
  bool stop_requested() override {
    return (options_.stop && options_.stop()) || std::ranges::any_of(viewers_, &Observer::stop_requested);
  }
  bool refine_requested() override { return std::ranges::any_of(viewers_, &Observer::refine_requested); }

 private:
  void save() {
    const WorkClock watch;
    write();
    recorder_.exclude(watch);
  }
  void write() {
    const Stopwatch watch;
    now_.state.seconds = method_clock_.seconds();
    now_.recorder = recorder_.state();
    save_checkpoint(folder_, now_);
    cost_ = watch.seconds();
    since_ = Stopwatch();
  }

  const Experiment& experiment_;
  const Scene& scene_;
  const std::filesystem::path folder_;
  Recorder& recorder_;
  const RunOptions& options_;
  Checkpoint now_;
  Stopwatch method_clock_, since_;
  double cost_ = 0;  // of the last checkpoint [s]
  std::vector<Observer*> viewers_;
  bool resumable_ = false;
  int level_ = 0;
};

}  // namespace drape

#pragma once

#include <fstream>
#include <functional>
#include <map>
#include <string>

#include "core/app/files/json_file.h"
#include "core/app/files/machine.h"
#include "core/app/run/errors.h"
#include "core/app/run/run_folder.h"
#include "core/app/scene/scene.h"

namespace drape {

/// A level's final state, as in levels/.
struct RecordedState {
  std::string method;
  int level = 0;
  Positions x;
  Eigen::VectorXd contact_pressure = {};  ///< LevelModel::contact_pressure; empty without contact
  LevelSnapshots snapshots = {};
};

/// Why a method that threw has failed.
struct MethodFailure {
  int level = 0;  ///< the current one
  std::string cause;
};

/// Writes a run's results while it proceeds: iterations.csv, log.jsonl, levels/*.ply and results.json. Every
/// function throws WriteError if a file cannot be written.
class Recorder : public Observer {
 public:
  struct State {
    std::string results;  ///< contents of results.json
    std::string method;
    bool intersection_free = true;      ///< of the current method
    std::vector<RecordedState> states;  ///< all levels so far, in order
    SnapshotRecorder snapshots;         ///< of this level
    Cost spent, last;                   ///< of the method's levels before this one; of this level so far
    double overhead = 0;                ///< time of the method that recording took [s]
    double overhead_before = 0;         ///< the same before this level
    double increments = 0;              ///< time of this level's increments so far [s]
    double cpu = 0;   ///< processor time of this level before `clock_`, less that of recording since [s]
    double load = 0;  ///< load_average when the level began
    std::uint64_t iterations_bytes = 0, log_bytes = 0;  ///< sizes of its files
    /// The furthest that a level has come to, that of the obstacles' files; without values at the start.
    LoadSteppingState last_load;
  };

  Recorder(const RunFolder& folder, const Experiment& experiment, const Scene& scene);

  /// Resumes from another recorder's state: truncates the files to their former sizes and restores damaged or
  /// missing ones.
  Recorder(const RunFolder& folder, const Experiment& experiment, const Scene& scene, const State& state);
  /// Flushes the files to the disk before it returns.
  State state() const;
  /// The files that were restored.
  const std::vector<std::string>& restored() const { return restored_; }
  /// Records the origin of a warm start in results.json.
  void warm_started_from(const std::string& where);

  void method_started(const std::string& method);
  /// Does not count what the clock has measured as the method's time.
  void exclude(const WorkClock& clock) { exclude(clock.work()); }
  void exclude(const Work& work) {
    s_.overhead += work.seconds;
    s_.cpu -= work.cpu_seconds;
  }
  /// Evaluates the metrics on all finished levels and writes results.json: unless `all`, without those of
  /// pairs of levels and those that no table shows. A failed method keeps the results of its earlier levels.
  void method_finished(const std::vector<LevelResult>& results, const std::optional<MethodFailure>& failure,
                       bool all);
  /// Finds the reference, if necessary by a further solve under `observer`, and measures the errors of every
  /// method's finest state and of every snapshot. After a `cancelled` run it solves nothing further. Returns
  /// false if the observer requested a stop meanwhile.
  bool measure_errors(Observer& observer, bool cancelled);
  /// A run that was not `measured` has neither measured pairs nor errors yet.
  void run_finished(bool complete, bool measured);

  void level_started(int level) override;
  void iteration(const IterationRow& row, const Positions& x) override;
  void increment_finished(const IncrementRow& row, const Positions& x) override;
  void level_finished(const LevelResult& result) override;

  /// Whether every method so far has converged, without an intersection in a checked state.
  bool all_converged() const;
  /// The metrics that have thrown, with the first cause of each.
  const std::map<std::string, std::string>& not_measured() const { return not_measured_; }

 private:
  Recorder(const RunFolder& folder, const Experiment& experiment, const Scene& scene,
           std::uint64_t iterations_bytes, std::uint64_t log_bytes);
  /// Writes a file of the folder unless it has these bytes already; `written_` takes its name.
  void write(const std::string& name, const std::string& bytes);
  void write_scene();
  /// The obstacles under the load that the finest level has reached.
  void write_obstacles();
  /// Returns the checksum of the .ply.
  std::uint32_t write_state(const RecordedState& state, const VertexFields& garment);
  /// None of a cloth that is no garment.
  VertexFields garment_fields_of(const RecordedState& state) const;
  /// The states of a method as a ParaView collection.
  void write_collection(const std::string& method);
  /// Measures the fields of finished methods again whose file is not as recorded.
  void restore_fields();
  void write_again();
  /// Writes the obstacles again if load stepping has moved them on.
  void follow_schedule();
  /// Throws WriteError if the last write to iterations.csv or log.jsonl failed.
  void require_written(const std::ofstream& stream, const char* name) const;
  Json& method_entry() { return results_["methods"][s_.method]; }
  /// A state of a method on one level as it is on another, finer one, by the method's own interpolation.
  Positions prolonged(const std::string& method, const Positions& x, int from, int to) const;
  /// The energy of the finest level at a state of the current method, prolonged to it [J].
  double energy_on_finest(int level, const Positions& x) const;
  Json state_entry(const LevelResult& result, const Cost& cost);
  /// Counts intersecting pairs and logs the first ones; nothing without contact.
  std::optional<int> intersections(int level, const Positions& x);
  /// A metric's result; the error of a metric that throws goes to `entry`.
  MetricResult measure(const std::string& name, const Metric& metric, const MetricInput& input, Json& entry);
  /// What the metrics of pairs tell of x and another state of the level; `fields` takes their fields.
  Json compare(int level, const Positions& x, const Positions& other, VertexFields* fields = nullptr);
  /// A coarse state, prolonged, against a finer one of its method; writes the fields on the finest level.
  Json pair_entry(const RecordedState& coarse, const RecordedState& fine);
  /// The levels of the current method against each other, and the scene's start against them.
  void measure_pairs(const std::vector<LevelResult>& results);
  /// All states on the finest level.
  std::vector<const RecordedState*> finest_states() const;
  /// The finest state that the experiment chooses as reference; null without one.
  const RecordedState* reference_state() const;
  /// The state that errors are measured against; null without one.
  const Positions* find_reference(Observer& observer, bool cancelled);
  /// Writes the snapshots of a level that has ended, notes their energies in its state and returns their
  /// entry for results.json. `cost` is the level's own.
  Json add_snapshots(const LevelResult& result, const Cost& cost, RecordedState& state);
  /// Measures every snapshot against the finest state of its method, if that converged, and against the
  /// reference, if there is one, and writes errors.csv: once all methods have ended, because measuring must
  /// not count as time of a method. Leaves out snapshots whose file is damaged or missing, and logs them.
  /// Once `stop` returns true it measures no more and writes what it has.
  void write_errors(const Positions* reference, const std::function<bool()>& stop);
  void log(const char* event, const Json& more);
  void save() const;

  const RunFolder& folder_;
  const Experiment& experiment_;
  const Scene& scene_;
  std::ofstream iterations_, log_;
  Json results_;
  bool solved_ =
      false;  ///< only measures are left: results.json, which is complete, stays until they are there
  std::map<std::string, std::string> not_measured_;
  std::vector<std::string> written_, restored_;  // names of files that were missing or different
  State s_;                                      // without results
  WorkClock clock_;                              // since this level began, or the run was resumed
  std::optional<LevelResult> solved_reference_;
};

}  // namespace drape

#pragma once

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "core/experiment/errors.h"
#include "core/experiment/experiment.h"
#include "core/experiment/run_folder.h"
#include "core/experiment/snapshots.h"

namespace drape {

/// A level's result, as its mesh in levels/ has it.
struct RecordedState {
  std::string method;
  int level = 0;
  Positions x;
};

/// What a recorder knows in the middle of a run, and how long its files are.
struct RecorderState {
  std::string results;  ///< of results.json
  std::string method;
  bool intersection_free = true, method_intersection_free = true;
  std::vector<RecordedState> states;  ///< of all levels so far, in order
  SnapshotRecorder::Memory snapshots;
  std::vector<LevelSnapshots> measured;
  Cost spent, last;
  double overhead = 0;
  std::uint64_t steps_bytes = 0, log_bytes = 0;
};

/// What a method ended with that threw.
struct MethodFailure {
  int level = 0;  ///< it was at
  std::string cause;
};

/// Writes a run down while it goes: steps.csv, log.jsonl, levels/*.ply and results.json. Every function
/// throws WriteError where that cannot be.
class Recorder : public Observer {
 public:
  Recorder(const RunFolder& folder, const Experiment& experiment, const Scene& scene);

  /// Goes on where another one of the same run was, whose files are cut to what they were then, and written
  /// again where they are damaged or gone.
  Recorder(const RunFolder& folder, const Experiment& experiment, const Scene& scene,
           const RecorderState& state);
  /// The files are on the disk as far as the state knows them.
  RecorderState state() const;
  /// The files that were written again.
  const std::vector<std::string>& restored() const { return restored_; }
  /// Says in results.json where the methods begin, if that is not the scene's start.
  void warm_started_from(const std::string& where);

  void method_started(const std::string& method);
  /// Measures the levels reached and every pair of them, and writes results.json. A method that failed has
  /// the results before that.
  void method_finished(const std::vector<LevelResult>& results,
                       const std::optional<MethodFailure>& failure = std::nullopt);
  /// Finds the reference, where need be by solving on under `observer`, and measures every method's finest
  /// state and every snapshot's error. False when it was stopped.
  bool measure_errors(Observer& observer, bool cancelled);
  void run_finished(bool complete);

  void level_started(int level) override;
  void iteration(const IterationRow& row, const Positions& x) override;
  void change_finished(const ChangeRow& row, const Positions& x) override;
  void level_finished(const LevelResult& result) override;

  /// Whether no state that was looked at had an intersection.
  bool intersection_free() const { return intersection_free_; }

 private:
  using Json = nlohmann::ordered_json;

  Recorder(const RunFolder& folder, const Experiment& experiment, const Scene& scene,
           std::ios::openmode mode);
  using Names = std::vector<std::string>;  // of files
  // These give the files that were not there, or had other bytes.
  Names write_scene();
  Names write_state(const RecordedState& state) const;
  /// The states of a method as a ParaView collection.
  Names write_collection(const std::string& method) const;
  Names write_again();
  /// Of a file that steps or the log was just written to.
  void require_written(const std::ofstream& stream, const char* name) const;
  Json& method_entry() { return results_["methods"][method_]; }
  std::string file_of(const std::string& method, int level, const char* extension) const;
  Json state_entry(const LevelResult& result);
  /// Counts the pairs that intersect and logs the first ones; null where nothing is to be kept apart.
  Json intersections(int level, const Positions& x);
  /// A metric's result; one that cannot measure the state leaves a note in `entry` and the run goes on.
  MetricResult measure(const std::string& name, const Metric& metric, const MetricInput& input, Json& entry);
  Json compare(int level, const Positions& x, const Positions& other, const std::string& fields_file);
  /// The finest states that methods have reached.
  std::vector<const RecordedState*> finest_states() const;
  /// The finest state that the experiment names as reference; null where there is none.
  const RecordedState* reference_state() const;
  /// The state that errors are measured against, also as reference.ply; null where there is none.
  const Positions* find_reference(Observer& observer, bool cancelled);
  void log(Json entry);
  void save() const;

  const RunFolder& folder_;
  const Experiment& experiment_;
  const Scene& scene_;
  std::ofstream steps_, log_;
  Json results_;
  std::string method_;
  bool intersection_free_ = true, method_intersection_free_ = true;
  std::vector<RecordedState> states_;  // of all levels so far
  std::vector<std::string> restored_;
  SnapshotRecorder snapshots_;
  ErrorTable errors_;
  Cost spent_;           // by the method, in the levels before this one
  Cost last_;            // of this level's last iteration
  double overhead_ = 0;  // seconds that recording has taken between the levels of a method
  std::optional<LevelResult> solved_reference_;
};

}  // namespace drape

#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/experiment/checkpoint.h"
#include "core/numerics/stopwatch.h"

namespace drape {

/// Saves the state of a run while it goes: when a method or a level of it begins, when the run is to stop,
/// and about every `interval` seconds in between, less often where saving would take more than a hundredth of
/// the time. What a run computes does not depend on it.
class CheckpointManager {
 public:
  /// `begun` is what the run begins or goes on with.
  CheckpointManager(const RunFolder& folder, const Recorder& recorder, Checkpoint begun, double interval);

  void method_started(int method);
  void method_finished(bool converged);
  /// Saves the state after the level, unless it was cancelled.
  void level_finished(const LevelResult& result);
  bool due(bool stopping) const;
  void save(const NewtonState& under_way);

 private:
  void save();

  const std::filesystem::path folder_;
  const Recorder& recorder_;
  Checkpoint now_;
  double interval_, cost_ = 0;
  Stopwatch method_clock_, since_;
};

/// Marks of the files that the config.yaml of a results folder names; paths of those in it are relative.
std::vector<FileFingerprint> fingerprints_of_files(const ConfigNode& saved,
                                                   const std::filesystem::path& folder);

/// Whether the run in the folder has ended by itself, so that nothing is left to go on with.
bool is_complete(const std::filesystem::path& folder);

/// Whether every method of the run in the folder ended as asked.
bool all_methods_succeeded(const std::filesystem::path& folder);

/// Of a complete run, which has no checkpoint any more: throws std::runtime_error naming every mesh of a
/// level that is no longer what results.json says of it.
void refuse_damaged_results(const std::filesystem::path& folder);

/// The checkpoint that the run in the folder goes on from. `warning` says what is not as it was but no
/// obstacle. Throws std::runtime_error where it cannot go on, with the reason.
Checkpoint checkpoint_to_resume(const std::filesystem::path& folder, std::string& warning);

/// A state that a run left.
struct SavedState {
  std::string method;
  int level = 0;
  Positions x;
};

/// The state of a level, by default the last one, of a method, by default the last one, of the run in the
/// folder, interrupted or complete. Throws std::runtime_error where there is none.
SavedState saved_state(const std::filesystem::path& folder, const std::string& method,
                       std::optional<int> level);

/// Refuses changes of an experiment that leave a saved state of it without a meaning.
void refuse_other_cloth(const Experiment& before, const Experiment& changed, int level, ConfigErrors& errors);

/// Lets the scene's methods begin at x on that level and, where they begin finer levels from the scene's
/// start, at the same surface on these; held vertices are brought from there to their places. What the state
/// touches is appended to `errors`.
void warm_start(const Experiment& experiment, Scene& scene, int level, const Positions& x,
                ConfigErrors& errors);

}  // namespace drape

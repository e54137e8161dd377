#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/app/experiment/cloth.h"
#include "core/app/run/checkpoint.h"
#include "core/app/scene/scene.h"

namespace drape {

/// The config.yaml of an experiment: resolved, with paths to the copies of mesh files in the results folder.
ConfigNode saved_config(const Experiment& experiment);

/// The files that the keys of a saved_config name (Parameter::path); those of its results folder have
/// relative paths.
std::vector<std::filesystem::path> files_of(const ConfigNode& saved);

/// Fingerprints of those files.
std::vector<FileFingerprint> fingerprints_of_files(const ConfigNode& saved,
                                                   const std::filesystem::path& folder);

/// Whether the run in the folder is complete, and has measured what there is to measure.
bool is_complete(const std::filesystem::path& folder);

/// An interrupted run to be resumed: its folder, locked, with the checkpoint to resume it from.
struct InterruptedRun {
  RunFolder folder;
  Checkpoint checkpoint;
};

/// The interrupted run in a folder, which is locked before the checkpoint is read: no other process can
/// continue the run in between. `warnings` reports harmless differences. Throws std::runtime_error with the
/// reason if the run cannot be resumed.
InterruptedRun interrupted_run(RunFolder folder, std::vector<std::string>& warnings);

/// A run as its folder has it.
struct SavedRun {
  Experiment experiment;
  std::unique_ptr<Scene> scene;
  std::optional<InterruptedRun> interrupted;  ///< to be resumed; nothing if the run is complete
};

/// The run in a folder, which is locked before anything in it is read. Of a complete run the meshes are
/// checked, and inputs that are missing are written again. `warnings` reports harmless differences. Empty,
/// with every error appended, if its config.yaml is not valid here. Throws std::runtime_error if there is no
/// run, or one that is damaged or cannot be resumed.
std::optional<SavedRun> read_saved_run(const std::filesystem::path& folder, const Registry& registry,
                                       LargeMemory large, std::vector<std::string>& warnings,
                                       ConfigErrors& errors);

/// A saved state of a run.
struct SavedState {
  std::string method;
  int level = 0;
  Positions x;
};

/// The state of a method and level, by default the last ones, of the interrupted or complete run in the
/// folder. Throws std::runtime_error if there is none.
SavedState saved_state(const std::filesystem::path& folder, const std::string& method,
                       std::optional<int> level);

/// Appends an error for every change of the experiment that a saved state does not fit.
void refuse_other_cloth(const Experiment& before, const Experiment& changed, int level, ConfigErrors& errors);

/// Replaces the scene's starts by x on that level and by the same surface, refined at midpoints, on
/// finer ones. Dirichlet vertices move from there to their targets. Appends the intersections of x.
void warm_start_scene(const Experiment& experiment, Scene& scene, int level, const Positions& x,
                      ConfigErrors& errors);

}  // namespace drape

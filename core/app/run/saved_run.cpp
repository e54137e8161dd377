#include "core/app/run/saved_run.h"

#include <algorithm>

#include "core/app/files/json_file.h"
#include "core/app/files/yaml_file.h"
#include "core/app/report/run_data.h"
#include "core/app/run/recorder_files.h"
#include "core/app/setup/build_scene.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/mesh_files/io.h"

namespace drape {

namespace fs = std::filesystem;

namespace {

FileFingerprint fingerprint_of(const fs::path& path) {
  const std::string bytes = read_file(path);
  return {path.string(), bytes.size(), checksum_of(bytes)};
}

/// The value of a key of config.yaml that names a copy in the run's folder.
ConfigNode copy_named(const std::string& name) {
  ConfigNode node = ConfigNode::of(name);
  node.names_file = true;
  return node;
}

/// Throws std::runtime_error naming every mesh of a complete run, or of one of its methods, whose checksum
/// differs from results.json.
void refuse_damaged_results(const fs::path& folder, const std::string& only = "") {
  std::vector<std::string> damaged;
  const auto results = read_results(folder);
  const JsonFile file = results_file(folder);
  for (const auto& [name, method] : results["methods"].items()) {
    if (!only.empty() && name != only) continue;
    if (!method.is_object() || !method.contains("levels")) file.refuse("\"levels\" is missing");
    for (const auto& level : method["levels"]) {
      if (member_of(level, "mesh_checksum").is_null()) continue;  // of a level that failed
      const auto mesh = file.at<std::string>(level, "mesh");
      const RunFile saved = level_mesh(file, level);
      if (!saved.exists() || !saved.fits(read_file(saved.path))) damaged.push_back(mesh);
    }
  }
  if (!damaged.empty())
    refuse_path(folder, "the run is complete, but files are damaged or missing: " + joined(damaged) +
                            "; run the experiment again, as in drape run " +
                            (folder / "config.yaml").string() + " --out ANOTHER");
}

/// A cloth of a file is read from the rest shape of its own level, which has no second copy. Throws
/// std::runtime_error where a rest shape does not follow from it, but for what other programs round
/// otherwise.
void refuse_other_rest(const fs::path& folder, const Scene& scene) {
  for (const Level& level : scene.hierarchy.levels) {
    const std::string name = rest_file(level.index);
    const Positions& own = level.rest.vertices;
    Positions saved;
    try {
      saved = read_mesh(folder / name).vertices;
    } catch (const std::exception&) {
      continue;  // missing or cut short: it will be written again
    }
    if (saved.rows() != own.rows() || !((saved - own).norm() <= 1e-9 * own.norm()))
      refuse_path(folder, name + " does not follow from " + rest_file(scene.hierarchy.cloth) +
                              ": one of the two was changed; run the "
                              "experiment again");
  }
}

/// A finished level's state in a checkpoint; null if it has none.
const RecordedState* saved_in(const std::optional<Checkpoint>& checkpoint, const std::string& method,
                              int level) {
  if (checkpoint)
    for (const RecordedState& state : checkpoint->recorder.states)
      if (state.method == method && state.level == level) return &state;
  return nullptr;
}

}  // namespace

ConfigNode saved_config(const Experiment& experiment) {
  ConfigNode config = experiment.resolved;
  const ExperimentParameters& p = experiment.parameters;
  ExperimentParameters saved = p;
  if (!p.start.file.empty()) {
    const FileCoordinates own = p.start.file_coordinates(p.cloth);  // of a copy of the file as it was
    saved.start.unit = own.unit;
    saved.start.up = own.up;
    set_path(config, "start", *node_of(saved).find("start"));
    set_path(config, "start.file", copy_named("start.ply"));
  }
  if (!p.cloth.file.empty()) {
    ClothParameters& cloth = saved.cloth;
    if (cloth.shape == "pattern")
      cloth.shape = "file", cloth.rest = "uv", cloth.uv_unit = "m";
    else if (cloth.as_read.file.empty())
      cloth.as_read = {p.cloth, fs::absolute(cloth.file).string(), cloth.scale, cloth.rotate, cloth.join};
    const ClothParameters as_written;  // in metres, with z up, and transformed
    cloth.unit = as_written.unit;
    cloth.up = as_written.up;
    cloth.scale = as_written.scale;
    cloth.rotate = as_written.rotate;
    cloth.vertices = as_written.vertices;  // meshed as it was asked for
    cloth.edge_length = as_written.edge_length;
    cloth.seed = as_written.seed;
    cloth.join = as_written.join;
    cloth.grain = as_written.grain;  // its faces have warp as it was cut
    cloth.grain_along = as_written.grain_along;
    cloth.grain_regions.clear();
    set_path(config, "cloth", *node_of(saved).find("cloth"));
    set_path(config, "cloth.file", copy_named(rest_file(p.hierarchy.coarsen)));
  }
  if (!p.reference.file.empty()) set_path(config, "reference.file", copy_named("reference.ply"));
  return config;
}

std::vector<fs::path> files_of(const ConfigNode& saved) {
  std::vector<fs::path> files;
  if (saved.names_file) files.emplace_back(saved.scalar);
  const auto add = [&](const ConfigNode& part) {
    for (fs::path& file : files_of(part)) files.push_back(std::move(file));
  };
  for (const ConfigNode& item : saved.items) add(item);
  for (const auto& [key, value] : saved.entries) add(value);
  return files;
}

std::vector<FileFingerprint> fingerprints_of_files(const ConfigNode& saved, const fs::path& folder) {
  std::vector<FileFingerprint> fingerprints;
  for (const fs::path& file : files_of(saved)) {
    if (!fs::is_regular_file(folder / file)) continue;      // as a folder, or what a plugin writes
    fingerprints.push_back(fingerprint_of(folder / file));  // an absolute path stays as it is
    fingerprints.back().path = file;
  }
  return fingerprints;
}

bool is_complete(const fs::path& folder) {
  if (!has_checkpoint(folder) && fs::exists(folder / "results.json"))
    return member_of(read_results(folder), "complete") == true;
  const Json results = complete_results(folder);  // damaged ones are written again from the checkpoint
  return !results.is_null() && member_of(results, "measured") != false;
}

InterruptedRun interrupted_run(RunFolder run, std::vector<std::string>& warnings) {
  const fs::path& folder = run.path();
  Checkpoint checkpoint = load_checkpoint(folder, warnings);
  const fs::path config = folder / "config.yaml";
  if (!fs::exists(config)) write_file(config, checkpoint.config);
  if (read_file(config) != checkpoint.config)
    refuse_path(config,
                "is not the one that the checkpoint was made with; put that one back, or change parameters "
                "with --set KEY=VALUE --out ANOTHER");
  for (const FileFingerprint& was : checkpoint.files) {
    const fs::path path = was.path.starts_with('/') ? fs::path(was.path) : folder / was.path;
    if (!fs::exists(path)) refuse_path(path, "is missing, but the run reads it; put it back");
    if (const FileFingerprint is = fingerprint_of(path); is.bytes != was.bytes || is.checksum != was.checksum)
      refuse_path(path,
                  "is not what it was when the run began; put that file back, or run the experiment again");
  }
  const std::string program = Checkpoint().program;
  if (checkpoint.program != program)
    warnings.push_back("the checkpoint is by " + checkpoint.program + ", this is " + program +
                       ": the last bits may differ");
  checkpoint.program = program;  // of the next one
  return {std::move(run), std::move(checkpoint)};
}

std::optional<SavedRun> read_saved_run(const fs::path& folder, const Registry& registry, LargeMemory large,
                                       std::vector<std::string>& warnings, ConfigErrors& errors) {
  RunFolder locked = RunFolder::of_run(folder);
  const bool complete = is_complete(folder);
  SavedRun run;
  if (complete)
    refuse_damaged_results(folder);
  else
    run.interrupted = interrupted_run(std::move(locked), warnings);
  if (complete) large = LargeMemory::allowed;
  std::optional<Experiment> experiment = read_experiment(folder / "config.yaml", {}, registry, errors, large);
  if (!experiment) return {};
  run.experiment = std::move(*experiment);
  run.scene = build_scene(run.experiment, errors, large, IntersectingStart::allowed);
  if (!run.scene) return {};
  if (complete) {
    if (run.experiment.parameters.cloth.shape == "file") refuse_other_rest(folder, *run.scene);
    const std::vector<std::string> again = write_rest(folder, *run.scene);
    if (!again.empty()) warnings.push_back(written_again_text(again));
  } else if (const Checkpoint& checkpoint = run.interrupted->checkpoint; checkpoint.start.rows() > 0) {
    warm_start_scene(run.experiment, *run.scene, checkpoint.first_level, checkpoint.start, errors);
  }
  if (!errors.empty()) return {};
  return run;
}

SavedState saved_state(const fs::path& folder, const std::string& method, std::optional<int> level) {
  const Json results = read_results(folder);
  SavedState state{method, 0, {}};
  std::optional<Checkpoint> checkpoint;
  if (member_of(results, "complete") != true) {
    std::vector<std::string> warnings;
    checkpoint = load_checkpoint(folder, warnings);
    if (state.method.empty()) state.method = checkpoint->methods.at(checkpoint->method);
  }
  if (state.method.empty())
    for (const auto& [name, entry] : results["methods"].items()) state.method = name;
  if (!checkpoint) refuse_damaged_results(folder, state.method);
  const bool current = checkpoint && checkpoint->methods.at(checkpoint->method) == state.method;
  const auto mesh_of = [&](int l) { return folder / level_file(state.method, l, ".ply"); };
  const auto under_way = [&](int l) { return current ? checkpoint->state.of(l) : nullptr; };
  const auto has = [&](int l) {
    return under_way(l) || saved_in(checkpoint, state.method, l) || fs::exists(mesh_of(l));
  };
  int last = 32;  // more levels than an experiment can have
  while (last >= 0 && !has(last)) --last;
  const std::string whose = "holds no state of method " + state.method;
  if (last < 0) refuse_path(folder, whose + "; name another with --method");
  state.level = level.value_or(last);
  if (!has(state.level))
    refuse_path(folder, whose + " on level " + std::to_string(state.level) +
                            "; the last level that it has is " + std::to_string(last));
  if (const NewtonState* unfinished = under_way(state.level))
    state.x = unfinished->so_far.x;
  else if (const RecordedState* finished = saved_in(checkpoint, state.method, state.level))
    state.x = finished->x;  // its mesh may be damaged
  else
    state.x = read_mesh(mesh_of(state.level)).vertices;
  return state;
}

void refuse_other_cloth(const Experiment& before, const Experiment& changed, int level,
                        ConfigErrors& errors) {
  for (const char* key : {"cloth", "hierarchy", "refiner"})
    if (to_yaml(*before.resolved.find(key)) != to_yaml(*changed.resolved.find(key)))
      errors.push_back(
          {changed.location_of(key), "\"" + std::string(key) +
                                         "\" cannot be changed: the saved state is one of the cloth "
                                         "as it was; run the changed experiment from its start"});
  if (changed.parameters.level_count() <= level)
    errors.push_back(
        {changed.location_of("levels"), "\"levels\" must be at least " +
                                            std::to_string(level + 1 - changed.parameters.hierarchy.coarsen) +
                                            ", for the saved state is one of level " + std::to_string(level) +
                                            "; choose a coarser one with --level"});
}

void warm_start_scene(const Experiment& experiment, Scene& scene, int level, const Positions& x,
                      ConfigErrors& errors) {
  const LevelModel& model = *scene.model(level);
  if (x.rows() != model.level().vertex_count()) throw std::logic_error("a state of another level");
  if (scene.garment) errors.push_back(scene.garment->no_restart);
  scene.starts[level] = x;
  refuse_intersecting_start(experiment, model, x, errors);
  for (std::size_t l = level + 1; l < scene.starts.size(); ++l)
    scene.starts[l] = scene.hierarchy.prolong(scene.starts[l - 1], static_cast<int>(l) - 1,
                                              static_cast<int>(l), scene.hierarchy.midpoints);
}

}  // namespace drape

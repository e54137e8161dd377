// The recorder's job after all methods: the reference, and the errors of states against it.

#include <limits>

#include "core/app/experiment/declared_metrics.h"
#include "core/app/experiment/exit_codes.h"
#include "core/app/files/json_file.h"
#include "core/app/files/snapshot_file.h"
#include "core/app/run/recorder.h"
#include "core/app/run/recorder_files.h"
#include "core/kernel/files/file.h"
#include "core/kernel/threads/stopwatch.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/solve/newton.h"

namespace drape {

namespace {

/// After a stop, errors are measured for at most so long [s]; a resumed run measures all of them.
constexpr double seconds_after_stop = 5;

/// Continues from a state of the finest level to the force tolerance of the experiment's `reference`, with
/// the experiment's common Newton parameters.
LevelResult solve_to_tolerance(const Experiment& experiment, const Scene& scene, const Positions& x,
                               Observer& observer) {
  NewtonParameters newton = experiment.parameters.newton;
  newton.force_tolerance = experiment.parameters.reference.force_tolerance;
  const Stopwatch clock;
  PlainObjective objective(scene.finest_model());
  observer.level_started(scene.finest());
  LevelRun run{clock, observer};
  run.hierarchy = &scene.hierarchy;
  LevelResult result = minimise(objective, x, newton, run);
  observer.level_finished(result);
  return result;
}

/// "snapshots/pcs_l2.bin"
std::string snapshots_file(const RecordedState& state) {
  return "snapshots/" + state.method + "_l" + std::to_string(state.level) + ".bin";
}

}  // namespace

std::vector<const RecordedState*> Recorder::finest_states() const {
  std::vector<const RecordedState*> finest;
  for (const RecordedState& state : s_.states)
    if (state.level == scene_.finest()) finest.push_back(&state);
  return finest;
}

const RecordedState* Recorder::reference_state() const {
  const std::string& named = experiment_.parameters.reference.method;
  const RecordedState* lowest = nullptr;
  double lowest_energy = std::numeric_limits<double>::infinity();
  for (const RecordedState* state : finest_states()) {
    if (state->method == named) return state;
    for (const Json& entry : results_.at("methods").at(state->method).at("levels")) {
      if (entry.at("level").get<int>() != state->level ||
          !has_converged(entry.at("status").get<std::string>()))
        continue;
      const Json& energy = entry.at("energy");  // with limits and contact
      if (energy.is_number() && energy.get<double>() < lowest_energy) lowest = state, lowest_energy = energy;
    }
  }
  return named == ReferenceParameters::lowest ? lowest : nullptr;
}

const Positions* Recorder::find_reference(Observer& observer, bool cancelled) {
  const ReferenceParameters& p = experiment_.parameters.reference;
  if (scene_.reference) return &*scene_.reference;
  const RecordedState* state = reference_state();
  if (!state) return nullptr;
  Json& entry = results_["reference"];
  entry = {{"method", state->method}, {"mesh", "reference.ply"}};
  if (p.method != state->method) entry["chosen"] = p.method;
  if (p.force_tolerance == 0 || cancelled) return &state->x;
  entry["force_tolerance"] = p.force_tolerance;
  try {
    solved_reference_ = solve_to_tolerance(experiment_, scene_, state->x, observer);
  } catch (const std::exception& error) {
    entry.update({{"status", failed}, {"message", error.what()}});
    log("reference_solved", {{"status", failed}, {"message", error.what()}});
    return &state->x;
  }
  entry.update({{"status", to_string(solved_reference_->outcome)},
                {"message", solved_reference_->message},
                {"force_residual", solved_reference_->force_residual},
                {"iterations", solved_reference_->iterations},
                {"seconds", solved_reference_->seconds}});
  log("reference_solved", {{"status", to_string(solved_reference_->outcome)}});
  return &solved_reference_->x;
}

Json Recorder::add_snapshots(const LevelResult& r, const Cost& cost, RecordedState& state) {
  const Cost before = r.from_initial_state ? Cost() : s_.spent;
  const std::string file = snapshots_file(state);
  LevelSnapshots& own = state.snapshots;
  Json entry = {{"file", file}};
  std::string bytes;
  for (const Snapshot& snapshot : s_.snapshots.end_level(cost, r.x)) {
    bytes += SnapshotFile::bytes_of(snapshot.x);
    own.all.push_back(
        {before + snapshot.cost, snapshot.cost.iterations, energy_on_finest(r.level, snapshot.x)});
    entry["iterations"].push_back(own.all.back().iterations);
    entry["seconds"].push_back(own.all.back().cost.seconds);
  }
  make_folder(folder_.file("snapshots"));
  own.converged = has_converged(r.outcome);
  write_file(folder_.file(file), bytes);
  own.checksum = checksum_of(bytes);
  entry["checksum"] = own.checksum;
  sync_to_disk(folder_.file(file));
  return entry;
}

void Recorder::write_errors(const Positions* reference, const std::function<bool()>& stop) {
  const auto fault = [&](const std::string& message) { log("not_measured", {{"message", message}}); };
  const int finest = scene_.finest();
  const std::vector<ErrorMeasure> measures = error_measures(declared_metrics(experiment_.metrics));
  std::string text = errors_header;
  for (const char* target : {",own_", ",reference_"})
    for (const ErrorMeasure& measure : measures) text += target + measure.name;
  text += "\n";
  const auto target_at = [&](const Positions& x, double energy) {
    return ErrorTarget{x, energy, energy_scale(scene_, x, energy)};
  };
  std::optional<ErrorTarget> standard;
  if (reference) standard = target_at(*reference, scene_.finest_model().value(*reference));
  for (const RecordedState& level : s_.states) {
    std::optional<ErrorTarget> own;
    for (const RecordedState* end : finest_states())
      if (end->method == level.method && end->snapshots.converged)
        own = target_at(end->x, end->snapshots.all.back().energy);
    const bool same = own && standard && own->x == standard->x;
    const int vertices = scene_.hierarchy.levels[level.level].vertex_count();
    const std::vector<SavedSnapshot>& snapshots = level.snapshots.all;
    SnapshotFile states;
    try {
      states = SnapshotFile(folder_.file(snapshots_file(level)), snapshots.size(), vertices,
                            level.snapshots.checksum);
    } catch (const std::exception& error) {
      fault(error.what());  // the snapshots have no copy to restore them from
      continue;
    }
    for (std::size_t k = 0; k < states.count() && !stop(); ++k) {
      const Positions state = k + 1 < states.count() ? states.positions(k) : level.x;
      const Positions x = prolonged(level.method, state, level.level, finest);
      const SavedSnapshot& snapshot = snapshots[k];
      const auto against = [&](const std::optional<ErrorTarget>& target) {
        return target ? state_error(measures, experiment_, scene_, x, snapshot.energy, *target, fault)
                      : StateError(measures.size());
      };
      const StateError to_own = against(own), to_standard = same ? to_own : against(standard);
      const Cost& cost = snapshot.cost;
      text += level.method + "," + std::to_string(level.level) + "," + std::to_string(snapshot.iterations) +
              "," + number_cell(cost.seconds, 9) + "," + std::to_string(cost.iterations) + "," +
              number_cell(cost.flops, 9) + "," + std::to_string(vertices);
      for (const StateError* errors : {&to_own, &to_standard})
        for (const std::optional<double>& error : *errors) text += "," + number_cell(error, 9);
      text += "\n";
    }
  }
  write_file(folder_.file("errors.csv"), text);
}

bool Recorder::measure_errors(Observer& observer, bool cancelled) {
  const int finest = scene_.finest();
  // The last method may have been stopped under an earlier load than that of the other methods' states.
  if (scene_.load_stepping && !s_.last_load.values.empty())
    scene_.load_stepping->restore(finest, s_.last_load);
  const Positions* reference = find_reference(observer, cancelled);
  if (reference) {
    write_mesh(folder_.file("reference.ply"), {*reference, scene_.hierarchy.levels[finest].rest.triangles});
    for (const RecordedState* state : finest_states())
      if (&state->x != reference) {
        s_.method = state->method;
        Json row = compare(finest, *reference, state->x);
        row["against"] = text_member(results_["reference"], scene_.reference ? "file" : "method");
        method_entry()["reference"] = row;
      }
  }
  save();
  if (experiment_.parameters.snapshots == 0 || s_.states.empty())
    return !observer.stop_requested() || cancelled;
  const Stopwatch watch;
  const auto stop = [&] {
    return cancelled ? watch.seconds() > seconds_after_stop : observer.stop_requested();
  };
  try {
    write_errors(reference, stop);
  } catch (const WriteError&) {
    throw;
  } catch (const std::exception& error) {
    log("not_measured", {{"message", std::string("errors.csv: ") + error.what()}});
  }
  return !stop();
}

}  // namespace drape

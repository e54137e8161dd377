// The recorder's job after all methods: the reference, and the errors of states against it.

#include <limits>

#include "core/app/run/recorder.h"
#include "core/app/run/recorder_files.h"
#include "core/app/run/reference.h"
#include "core/kernel/files/file.h"
#include "core/kernel/threads/stopwatch.h"
#include "core/numerics/mesh_files/io.h"

namespace drape {

namespace {

/// After a stop, errors are measured for at most so long [s]; a resumed run measures all of them.
constexpr double seconds_after_stop = 5;

}  // namespace

std::vector<const RecordedState*> Recorder::finest_states() const {
  std::vector<const RecordedState*> finest;
  for (const RecordedState& state : states_)
    if (state.level == static_cast<int>(scene_.models.size()) - 1) finest.push_back(&state);
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
  if (scene_.reference) {
    results_["reference"] = {{"file", p.file}, {"mesh", "reference.ply"}};
    return &*scene_.reference;
  }
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
    log({{"event", "reference_solved"}, {"status", failed}, {"message", error.what()}});
    return &state->x;
  }
  entry.update({{"status", to_string(solved_reference_->outcome)},
                {"message", solved_reference_->message},
                {"force_residual", finite_or_null(solved_reference_->force_residual)},
                {"iterations", solved_reference_->iterations},
                {"seconds", solved_reference_->seconds}});
  log({{"event", "reference_solved"}, {"status", to_string(solved_reference_->outcome)}});
  return &solved_reference_->x;
}

bool Recorder::measure_errors(Observer& observer, bool cancelled) {
  const ReferenceParameters& p = experiment_.parameters.reference;
  const int finest = static_cast<int>(scene_.models.size()) - 1;
  // The last method may have been stopped under an earlier load than that of the other methods' states.
  if (scene_.load_stepping && !last_load_.values.empty()) scene_.load_stepping->restore(finest, last_load_);
  const Positions* reference = find_reference(observer, cancelled);
  if (reference) {
    write_ply(folder_.file("reference.ply"), {*reference, scene_.hierarchy.levels[finest].rest.triangles});
    for (const RecordedState* state : finest_states())
      if (&state->x != reference) {
        method_ = state->method;
        Json row = compare(finest, *reference, state->x);
        row["against"] = results_["reference"].value("method", p.file);
        method_entry()["reference"] = row;
      }
  }
  save();
  if (errors_.empty()) return !observer.stop_requested() || cancelled;
  const Stopwatch watch;
  const auto stop = [&] {
    return cancelled ? watch.seconds() > seconds_after_stop : observer.stop_requested();
  };
  const auto fault = [&](const std::string& message) {
    log({{"event", "not_measured"}, {"message", message}});
  };
  try {
    errors_.write(reference, stop, fault);
  } catch (const WriteError&) {
    throw;
  } catch (const std::exception& error) {
    fault(std::string("errors.csv: ") + error.what());
  }
  return !stop();
}

}  // namespace drape

#include "core/app/run/errors.h"

#include <utility>

#include "core/kernel/files/message_text.h"

namespace drape {

void SnapshotRecorder::iteration(const Cost& cost, const Positions& x, int most) {
  const bool wanted = most > 1 && seen % spacing == 0;
  ++seen;
  if (!wanted) return;
  const auto spaced = [&] { return std::ranges::count(snapshots, false, &Snapshot::kept); };
  if (spaced() == most - 1) {  // the last state takes one
    int k = 0;
    std::erase_if(snapshots, [&](const Snapshot& s) { return !s.kept && k++ % 2 == 1; });
    spacing *= 2;
    if ((seen - 1) % spacing != 0 || spaced() == most - 1) return;
  }
  snapshots.push_back({cost, x});
}

void SnapshotRecorder::keep(const Cost& cost, const Positions& x) {
  if (snapshots.empty() || snapshots.back().cost.iterations != cost.iterations)
    snapshots.push_back({cost, x});
  snapshots.back().kept = true;
}

std::vector<Snapshot> SnapshotRecorder::end_level(const Cost& cost, const Positions& last) {
  if (!snapshots.empty() && snapshots.back().cost.iterations == cost.iterations) snapshots.pop_back();
  snapshots.push_back({cost, last});
  return std::exchange(snapshots, {});
}

std::optional<double> energy_released(const Scene& scene, double energy) {
  if (scene.garment) return std::nullopt;
  return scene.finest_model().value(scene.placed.back()) - energy;
}

double energy_scale(const Scene& scene, const Positions& x, double energy) {
  const std::optional<double> released = energy_released(scene, energy);
  return released ? *released : scene.finest_model().value(x, {EnergyRole::membrane, EnergyRole::bending});
}

StateError state_error(const std::vector<ErrorMeasure>& measures, const Experiment& experiment,
                       const Scene& scene, const Positions& x, double energy, const ErrorTarget& target,
                       const std::function<void(const std::string&)>& fault) {
  StateError error(measures.size());
  for (const auto& [name, metric] : experiment.metrics) {
    if (metric->scope() != MetricScope::pair) continue;
    try {
      const MetricResult result =
          metric->evaluate({scene.hierarchy.levels.back(), scene.finest_model(), target.x, &x});
      for (const MetricValue& v : result.values)
        for (std::size_t k = 0; k < measures.size(); ++k)
          if (v.name == measures[k].value)
            error[k] = measures[k].better == Better::higher ? 1 - v.value : v.value;
    } catch (...) {
      fault(name + ": " + message_in_flight());
    }
  }
  if (target.scale > 0) error.back() = (energy - target.energy) / target.scale;
  return error;
}

}  // namespace drape

#include "core/app/run/errors.h"

#include <cmath>

#include "core/app/files/snapshot_file.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"

namespace drape {

namespace {

std::string number(double value) { return std::isfinite(value) ? general_text(value, 9) : ""; }

std::string cells(const StateError& error) {
  std::string text;
  for (const auto& value : error) text += "," + (value ? number(*value) : "");
  return text;
}

}  // namespace

void SnapshotRecorder::begin_level() { m_ = {}; }

void SnapshotRecorder::iteration(const Cost& cost, const Positions& x) {
  const bool wanted = most_ > 1 && m_.seen % m_.spacing == 0;
  ++m_.seen;
  if (!wanted) return;
  if (static_cast<int>(m_.snapshots.size()) == most_ - 1) {  // the last state takes one
    for (std::size_t k = 1; 2 * k < m_.snapshots.size(); ++k)
      m_.snapshots[k] = std::move(m_.snapshots[2 * k]);
    m_.snapshots.resize((m_.snapshots.size() + 1) / 2);
    m_.spacing *= 2;
    if ((m_.seen - 1) % m_.spacing != 0 || static_cast<int>(m_.snapshots.size()) == most_ - 1) return;
  }
  m_.snapshots.push_back({cost, x});
}

std::vector<Snapshot> SnapshotRecorder::end_level(const Cost& cost, const Positions& last) {
  if (!m_.snapshots.empty() && m_.snapshots.back().cost.iterations == cost.iterations)
    m_.snapshots.pop_back();
  m_.snapshots.push_back({cost, last});
  return std::move(m_.snapshots);
}

std::uint32_t write_snapshots(const std::filesystem::path& file, const std::vector<Snapshot>& snapshots) {
  std::string bytes;
  for (const Snapshot& snapshot : snapshots) bytes += SnapshotFile::bytes_of(snapshot.x);
  write_file(file, bytes);
  return checksum_of(bytes);
}

double energy_of_start(const Scene& scene) { return scene.finest_model().value(scene.placed.back()); }

Positions prolonged(const Experiment& experiment, const Scene& scene, const std::string& method,
                    const Positions& x, int from, int to) {
  const auto& weights = scene.hierarchy.weights(experiment.solver_of(method).interpolation());
  return scene.hierarchy.prolong(x, from, to, weights);
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
  if (target.released > 0) error.back() = (energy - target.energy) / target.released;
  return error;
}

nlohmann::ordered_json ErrorTable::add(const std::string& method, const LevelResult& result,
                                       const std::vector<Snapshot>& snapshots, const Cost& before,
                                       const Cost& spent) {
  LevelSnapshots level;
  level.method = method;
  level.level = result.level;
  level.file = "snapshots/" + method + "_l" + std::to_string(result.level) + ".bin";
  level.last = result.x;
  level.converged = has_converged(result.outcome);
  nlohmann::ordered_json entry = {{"file", level.file}};
  for (const Snapshot& snapshot : snapshots) {
    level.cost.push_back(before + snapshot.cost);
    level.iterations.push_back(snapshot.cost.iterations);
    level.energies.push_back(scene_.finest_model().value(
        prolonged(experiment_, scene_, method, snapshot.x, result.level, scene_.finest())));
    entry["iterations"].push_back(snapshot.cost.iterations);
    entry["seconds"].push_back(spent.seconds + snapshot.cost.seconds);
  }
  make_folder(folder_.file("snapshots"));
  level.checksum = write_snapshots(folder_.file(level.file), snapshots);
  entry["checksum"] = level.checksum;
  sync_to_disk(folder_.file(level.file));
  levels_.push_back(std::move(level));
  return entry;
}

void ErrorTable::write(const Positions* reference, const std::function<bool()>& stop,
                       const std::function<void(const std::string&)>& fault) {
  const int finest = scene_.finest();
  std::string text = "method,level,level_iterations,seconds,iterations,flops,vertices";
  for (const char* target : error_targets)
    for (const ErrorMeasure& measure : measures_) text += "," + std::string(target) + "_" + measure.name;
  text += "\n";
  const double start = energy_of_start(scene_);
  const auto target_at = [&](const Positions& x, double energy) {
    return ErrorTarget{x, energy, start - energy};
  };
  std::optional<ErrorTarget> standard;
  if (reference) standard = target_at(*reference, scene_.finest_model().value(*reference));
  for (const LevelSnapshots& level : levels_) {
    std::optional<ErrorTarget> own;
    for (const LevelSnapshots& other : levels_)
      if (other.method == level.method && other.level == finest && other.converged)
        own = target_at(other.last, other.energies.back());
    const bool same = own && standard && own->x == standard->x;
    const int vertices = scene_.hierarchy.levels[level.level].vertex_count();
    SnapshotFile states;
    try {
      states = SnapshotFile(folder_.file(level.file), level.cost.size(), vertices, level.checksum);
    } catch (const std::exception& error) {
      fault(error.what());  // the snapshots have no copy to restore them from
      continue;
    }
    for (std::size_t k = 0; k < states.count() && !stop(); ++k) {
      const Positions state = k + 1 < states.count() ? states.positions(k) : level.last;
      const Positions x = prolonged(experiment_, scene_, level.method, state, level.level, finest);
      const auto against = [&](const std::optional<ErrorTarget>& target) {
        return target ? state_error(measures_, experiment_, scene_, x, level.energies[k], *target, fault)
                      : StateError(measures_.size());
      };
      const StateError to_own = against(own), to_standard = same ? to_own : against(standard);
      const Cost& cost = level.cost[k];
      text += level.method + "," + std::to_string(level.level) + "," + std::to_string(level.iterations[k]) +
              "," + number(cost.seconds) + "," + std::to_string(cost.iterations) + "," + number(cost.flops) +
              "," + std::to_string(vertices) + cells(to_own) + cells(to_standard) + "\n";
    }
  }
  write_file(folder_.file("errors.csv"), text);
}

}  // namespace drape

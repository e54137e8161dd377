#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/app/experiment/declared_metrics.h"
#include "core/app/run/run_folder.h"
#include "core/app/scene/scene.h"

namespace drape {

/// The cost of reaching a state.
struct Cost {
  double seconds = 0;
  int iterations = 0;
  double flops = 0;  ///< of factorisations
};

inline Cost operator+(const Cost& a, const Cost& b) {
  return {a.seconds + b.seconds, a.iterations + b.iterations, a.flops + b.flops};
}

/// An intermediate state of a level.
struct Snapshot {
  Cost cost;    ///< since the beginning of the level
  Positions x;  ///< n×3 [m]
};

/// Records states of a level, evenly spaced over its iterations. When there are too many, it drops every
/// second one and doubles the spacing.
class SnapshotRecorder {
 public:
  /// At most `most` snapshots a level, the last state included; 0 disables recording.
  explicit SnapshotRecorder(int most) : most_(most) {}

  /// Snapshots of the current level.
  struct State {
    int spacing = 1, seen = 0;
    std::vector<Snapshot> snapshots;
  };
  const State& state() const { return m_; }
  void restore(State state) { m_ = std::move(state); }

  bool any() const { return most_ > 0; }
  void begin_level();
  /// Takes the state after an iteration; `cost` counts from the beginning of the level.
  void iteration(const Cost& cost, const Positions& x);
  /// The level's snapshots, ending with `last`.
  std::vector<Snapshot> end_level(const Cost& cost, const Positions& last);

 private:
  int most_;
  State m_;
};

/// Writes positions as a SnapshotFile. Returns the checksum of the file. Throws WriteError.
std::uint32_t write_snapshots(const std::filesystem::path& file, const std::vector<Snapshot>& snapshots);

/// One value per measure; absent if it could not be measured.
using StateError = std::vector<std::optional<double>>;

/// A state on the finest level that others are measured against.
struct ErrorTarget {
  Positions x;
  double energy = 0;    ///< of the finest level there, without limits and contact [J]
  double released = 0;  ///< what the cloth releases of that energy from the scene's start to there [J]
};

/// The finest level's energy at the scene's start, without noise and with pins where they begin [J].
double energy_of_start(const Scene& scene);

/// The error of a state x of the finest level, whose energy is given [J]. There is no energy gap to a target
/// that releases none. A metric that throws is reported to
/// `fault`; its values stay absent.
StateError state_error(const std::vector<ErrorMeasure>& measures, const Experiment& experiment,
                       const Scene& scene, const Positions& x, double energy, const ErrorTarget& target,
                       const std::function<void(const std::string&)>& fault);

/// A state of a method on one level as it is on another, finer one, by the method's own interpolation.
Positions prolonged(const Experiment& experiment, const Scene& scene, const std::string& method,
                    const Positions& x, int from, int to);

/// The snapshots of one level.
struct LevelSnapshots {
  std::string method, file;
  int level = 0;
  std::vector<Cost> cost;        ///< of each snapshot, with what it builds on
  std::vector<int> iterations;   ///< of the level
  std::vector<double> energies;  ///< on the finest level [J]
  Positions last;                ///< last state in full precision
  bool converged = false;
  std::uint32_t checksum = 0;  ///< of the file
};

/// Collects the snapshots of a run. It measures them once all methods have ended, because measuring must not
/// count as time of a method.
class ErrorTable {
 public:
  ErrorTable(const RunFolder& folder, const Experiment& experiment, const Scene& scene)
      : folder_(folder),
        experiment_(experiment),
        scene_(scene),
        measures_(error_measures(declared_metrics(experiment.metrics))) {}

  /// Adds a level's snapshots: writes their file, evaluates their energies and returns their entry for
  /// results.json. `before` is the cost that the level builds on, `spent` the cost of everything that the
  /// method has done before the level.
  nlohmann::ordered_json add(const std::string& method, const LevelResult& result,
                             const std::vector<Snapshot>& snapshots, const Cost& before, const Cost& spent);

  /// Measures every snapshot against the finest state of its method, if that converged, and against the
  /// reference, if there is one, and writes errors.csv. Leaves out snapshots whose file is damaged or
  /// missing, and reports them to `fault`. Once `stop` returns true it measures no more and writes what it
  /// has.
  void write(const Positions* reference, const std::function<bool()>& stop,
             const std::function<void(const std::string&)>& fault);

  [[nodiscard]] bool empty() const { return levels_.empty(); }
  using State = std::vector<LevelSnapshots>;
  const State& state() const { return levels_; }
  /// Restores what an earlier table of the same run had collected. The snapshots' files must still exist.
  void restore(State state) { levels_ = std::move(state); }

 private:
  const RunFolder& folder_;
  const Experiment& experiment_;
  const Scene& scene_;
  const std::vector<ErrorMeasure> measures_;
  State levels_;
};

}  // namespace drape

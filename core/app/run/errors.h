#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "core/app/experiment/declared_metrics.h"
#include "core/app/scene/scene.h"

namespace drape {

/// How errors.csv begins.
inline constexpr const char* errors_header =
    "method,level,level_iterations,seconds,iterations,flops,vertices";

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
  Cost cost;          ///< since the beginning of the level
  Positions x;        ///< n×3 [m]
  bool kept = false;  ///< whatever the spacing
};

/// Records states of a level, evenly spaced over its iterations, and those that are kept. When there are too
/// many, it drops every second one and doubles the spacing.
struct SnapshotRecorder {
  int spacing = 1, seen = 0;
  std::vector<Snapshot> snapshots = {};  ///< of the level so far

  /// Takes the state after an iteration; `cost` counts from the beginning of the level. At most `most`
  /// snapshots are kept, the last state included.
  void iteration(const Cost& cost, const Positions& x, int most);
  /// Takes the state after this iteration beyond that number, as at the end of a phase.
  void keep(const Cost& cost, const Positions& x);
  /// The level's snapshots, ending with `last`.
  std::vector<Snapshot> end_level(const Cost& cost, const Positions& last);
};

/// One value per measure; absent if it could not be measured.
using StateError = std::vector<std::optional<double>>;

/// A state on the finest level that others are measured against.
struct ErrorTarget {
  Positions x;
  double energy = 0;  ///< of the finest level there, without limits and contact [J]
  double scale = 0;   ///< what energy gaps are over, energy_scale [J]
};

/// What a cloth releases of the finest level's energy from the scene's start, without noise and with pins
/// where they begin, to a state with this `energy` [J]. None of a garment: its start has the
/// strain of its placement, of which nothing remains.
std::optional<double> energy_released(const Scene& scene, double energy);
/// What energy gaps at a target x of the finest level, with this `energy`, are over: energy_released; of a
/// garment the elastic energy there [J].
double energy_scale(const Scene& scene, const Positions& x, double energy);

/// The error of a state x of the finest level, whose energy is given [J]. A target whose scale is not
/// positive has no energy gap. A metric that throws is reported to `fault`; its values stay absent.
StateError state_error(const std::vector<ErrorMeasure>& measures, const Experiment& experiment,
                       const Scene& scene, const Positions& x, double energy, const ErrorTarget& target,
                       const std::function<void(const std::string&)>& fault);

/// A snapshot whose positions are in its level's file.
struct SavedSnapshot {
  Cost cost;           ///< with what it builds on
  int iterations = 0;  ///< of the level
  double energy = 0;   ///< on the finest level [J]
};

/// The snapshots of one level; nothing if none are recorded.
struct LevelSnapshots {
  std::vector<SavedSnapshot> all;
  bool converged = false;
  std::uint32_t checksum = 0;  ///< of the file
};

}  // namespace drape

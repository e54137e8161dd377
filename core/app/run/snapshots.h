#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/kernel/interfaces/solver.h"

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

}  // namespace drape

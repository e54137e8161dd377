#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/model/solver.h"

namespace drape {

/// What a state has cost.
struct Cost {
  double seconds = 0;
  int iterations = 0;
  double flops = 0;  ///< of factorisations
};

inline Cost operator+(const Cost& a, const Cost& b) {
  return {a.seconds + b.seconds, a.iterations + b.iterations, a.flops + b.flops};
}

/// A state on the way through a level.
struct Snapshot {
  Cost cost;    ///< since the level's start
  Positions x;  ///< n×3 [m]
};

/// Keeps states of a level while it is solved, evenly over its iterations and not more than so many: when
/// there are too many, every second one goes and the spacing doubles.
class SnapshotRecorder {
 public:
  /// At most `most` snapshots a level, its last state among them; 0 keeps nothing and costs nothing.
  explicit SnapshotRecorder(int most) : most_(most) {}

  /// Of the level under way.
  struct Memory {
    int spacing = 1, seen = 0;
    std::vector<Snapshot> kept;
  };
  const Memory& memory() const { return m_; }
  void restore(Memory memory) { m_ = std::move(memory); }

  bool any() const { return most_ > 0; }
  void begin_level();
  /// The state after an iteration; `cost` counts from the level's start.
  void iteration(const Cost& cost, const Positions& x);
  /// The level's snapshots, `last` at their end.
  std::vector<Snapshot> end_level(const Cost& cost, const Positions& last);

 private:
  int most_;
  Memory m_;
};

/// float32, little-endian, snapshot after snapshot, row by row. Written as a whole, then renamed. The
/// checksum of the file.
std::uint32_t write_snapshots(const std::filesystem::path& file, const std::vector<Snapshot>& snapshots);

/// The positions of such a file, `vertices` rows each. Throws std::runtime_error when the file is not made of
/// them, or has another checksum than this.
std::vector<Positions> read_snapshots(const std::filesystem::path& file, int vertices,
                                      std::optional<std::uint32_t> checksum = std::nullopt);

}  // namespace drape

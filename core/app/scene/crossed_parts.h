#pragma once

#include <vector>

#include "core/kernel/interfaces/level.h"

namespace drape {

/// The parts of a start that obstacles cut off: triangles that intersect one, and what lies behind its
/// surface. Its other parts are where they are meant to be.
class CrossedParts {
 public:
  /// `start` (n×3) [m] is of the level. Obstacles need not be closed. `gaps` [m] are theirs from the start,
  /// not positive for a half-space that it is in; empty if unknown. Both sides of an open sheet that has a
  /// gap, and is not cut, are free.
  CrossedParts(const Level& level, const Positions& start, std::vector<TriangleMesh> obstacles,
               const std::vector<double>& gaps);

  /// How far the deepest vertex behind an obstacle is from that obstacle's surface [m].
  double depth() const { return depth_; }
  /// The obstacles' mean normal where the start intersects them; zero if it does not.
  const Eigen::Vector3d& way_out() const { return way_out_; }
  /// Whether a translation [m] takes an edge of the other parts through an obstacle, or these deeper into one
  /// that is closed, or is longer than two fifths of a closed one that is cut and than `longest_edge` [m].
  bool lead_across(const Eigen::Vector3d& translation, double longest_edge) const;

 private:
  void add(const Level& level, const TriangleMesh& obstacle, bool has_gap);

  Positions start_;
  std::vector<TriangleMesh> obstacles_;
  std::vector<Positions> cut_;                            // the vertices of closed obstacles that are cut
  std::vector<std::vector<Eigen::Vector2i>> free_edges_;  // of each obstacle: those of the other parts
  std::vector<Eigen::Vector3d> outwards_;                 // unit, where a closed obstacle cuts
  double depth_ = 0;
  Eigen::Vector3d way_out_ = Eigen::Vector3d::Zero();
};

}  // namespace drape

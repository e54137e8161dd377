#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/level.h"
#include "core/numerics/collision_detection/surface.h"
#include "core/numerics/contact/pair_geometry.h"

namespace drape::ipc {

/// The pairs of the cloth's primitives that are within d̂ of each other in the rest shape, by what separates
/// them there.
///
/// Pairs that are neighbours along the cloth would be pushed apart at rest, so they have no barrier. Two
/// layers of a folded or sewn rest shape are not neighbours: they have a barrier that ends at their gap at
/// rest, so that it does not load the rest shape, but not below a quarter of d̂. Source: this project.
///
/// The rest shape is meant in space, also of cloth that is sewn of flat pieces: where their placement has it.
/// Pieces in their plane have no gaps, since they may lie on one another there, or anywhere. The placement is
/// what the cloth starts from, so a barrier that ends at its gaps does not load the start, and paths along
/// the cloth lead across seams, whose vertices the pieces share.
class RestLayers {
 public:
  /// The pairs of the level's rest shape; `cloth` is its surface. Throws std::runtime_error if there are more
  /// than a million and 250 for each vertex.
  static RestLayers of(const Surface& cloth, const Level& level, double dhat);

  /// d̂ of a self pair [m], 0 for a pair without a barrier.
  double dhat_of(const ContactPair& pair) const;
  /// Names the pairs without a barrier, for messages; empty if there are none.
  std::string remark() const;

 private:
  /// A vertex and a triangle may have the vertices of two edges, in the same order.
  using Key = std::pair<std::array<int, 4>, PairKind>;
  struct RestPair {
    Key key;
    double dhat;  ///< of layers [m], 0 for neighbours
  };
  double dhat_ = 0;              // of all other pairs [m]
  std::vector<RestPair> pairs_;  // ascending by key
};

}  // namespace drape::ipc

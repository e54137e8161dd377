#pragma once

#include <memory>
#include <vector>

#include "core/contact/box.h"
#include "core/mesh/topology.h"

namespace drape {

/// Ways to find overlapping boxes. All find the same pairs.
enum class BroadPhaseKind {
  bvh,  ///< own tree of eights: laid out once, then refitted
  fcl,  ///< FCL's BVHModel, refitted likewise
  cgal  ///< CGAL's box_intersection_d: no memory between calls
};

/// Finds which of many boxes overlap, touching included.
class BroadPhase {
 public:
  virtual ~BroadPhase() = default;

  /// Takes the boxes, none empty, by copy. Cheapest when there are as many as in the last call, and they are
  /// still near to the same others.
  virtual void update(const std::vector<Box>& boxes) = 0;

  /// Row i of `pairs`: the boxes j > i that overlap box i, ascending. False, and no rows, if there are more
  /// than `limit` pairs.
  virtual bool overlaps(long limit, AdjacencyList& pairs) const = 0;

  /// Row i of `pairs`: the other's boxes that overlap box i, ascending. `other` must be of the same kind,
  /// else std::runtime_error.
  virtual bool overlaps(const BroadPhase& other, long limit, AdjacencyList& pairs) const = 0;
};

std::unique_ptr<BroadPhase> make_broad_phase(BroadPhaseKind kind);

}  // namespace drape

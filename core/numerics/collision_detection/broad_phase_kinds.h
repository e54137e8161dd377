#pragma once

#include <stdexcept>
#include <utility>

#include "core/numerics/collision_detection/broad_phase.h"

namespace drape {

// Shared by the implementations of BroadPhase.

std::unique_ptr<BroadPhase> make_fcl_broad_phase(const Stencils& vertices);

using IndexPairs = std::vector<std::pair<int, int>>;

/// Rows of ascending second indices, from lists of pairs in any order.
AdjacencyList rows_of(const std::vector<IndexPairs>& lists, int row_count, int column_count);

/// Downcasts `other` to the class Own.
template <class Own>
const Own& same_kind(const BroadPhase& other) {
  if (const Own* own = dynamic_cast<const Own*>(&other)) return *own;
  throw std::runtime_error("broad phase: boxes of two kinds of broad phase cannot be compared");
}

}  // namespace drape

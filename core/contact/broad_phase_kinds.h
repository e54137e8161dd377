#pragma once

#include <stdexcept>
#include <utility>

#include "core/contact/broad_phase.h"

namespace drape {

// What the implementations of BroadPhase share.

std::unique_ptr<BroadPhase> make_fcl_broad_phase();
std::unique_ptr<BroadPhase> make_cgal_broad_phase();

using IndexPairs = std::vector<std::pair<int, int>>;

/// Rows of ascending second indices from pairs in any order, in lists of any length.
AdjacencyList rows_of(const std::vector<IndexPairs>& lists, int row_count, int column_count);

/// The other as an object of one's own class.
template <class Own>
const Own& same_kind(const BroadPhase& other) {
  if (const Own* own = dynamic_cast<const Own*>(&other)) return *own;
  throw std::runtime_error("broad phase: boxes of two kinds of broad phase cannot be compared");
}

}  // namespace drape

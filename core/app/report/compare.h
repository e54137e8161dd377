#pragma once

#include <string>
#include <vector>

#include "core/app/report/run_collection.h"

namespace drape {

/// What `drape compare` says.
struct Comparison {
  std::string text;     ///< for a terminal: the changes, the entries of one side only, and the broken bounds
  bool broken = false;  ///< a bound is violated, or a run with bounds no longer converges or exists
};

/// Compares two runs or sweeps quantity by quantity, matched by variation and seed (not for single runs),
/// then by method and level. A bound is "seconds=1.1": the largest admissible ratio of a quantity after to
/// before, the inverse ratio where higher is better. Throws std::runtime_error with one line for a bound that
/// says nothing, and if nothing matches, or no match has a bound's quantity.
Comparison compare(const RunCollection& before, const RunCollection& after,
                   const std::vector<std::string>& bounds);

}  // namespace drape

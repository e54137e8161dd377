#pragma once

#include <string>
#include <vector>

#include "core/app/report/run_collection.h"

namespace drape {

/// The largest admissible ratio of a quantity after to before; the inverse ratio where higher is better.
struct Bound {
  std::string key;
  double ratio = 1;
};

/// Reads "seconds=1.1" and the like; the keys are quantities of either side. Throws std::runtime_error with
/// one line that says what is wrong.
std::vector<Bound> parse_bounds(const std::vector<std::string>& texts, const RunCollection& before,
                                const RunCollection& after);

/// One quantity before and after.
struct Change {
  std::string where;  ///< "pcs, level 2", with variation and seed if there are several
  std::string key;
  double before = 0, after = 0;
  Better better = Better::lower;
  /// A released energy has no better and worse where the models differ (model_keys.h).
  /// "faster", "slower", "less work", "more work", "better", "worse", "other", or "" for the same
  std::string verdict = {};
  bool broken = false;  ///< violates a bound
};

/// Compares two runs or sweeps quantity by quantity, matched by variation and seed (not for single runs),
/// then by method and level.
class Comparison {
 public:
  /// Throws std::runtime_error if nothing matches, or no match has a bound's quantity.
  Comparison(const RunCollection& before, const RunCollection& after, const std::vector<Bound>& bounds);

  const std::vector<Change>& changes() const { return changes_; }
  /// Whether a bound is violated, or its run no longer converges or exists.
  bool broken() const { return !broken_.empty(); }
  /// For a terminal: the changes, the entries of one side only, and the broken bounds.
  std::string text() const;

 private:
  std::vector<Change> changes_;
  std::vector<std::string> lost_, gained_, broken_;
  std::vector<std::string> differing_;  // keys of the model, for energies
  std::size_t bounds_ = 0;
};

}  // namespace drape

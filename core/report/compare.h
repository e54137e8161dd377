#pragma once

#include <string>
#include <vector>

#include "core/report/run_collection.h"

namespace drape {

/// What a figure may at most become, as a multiple of what it was; of one where higher is better, the other
/// way round.
struct Bound {
  std::string key;
  double ratio = 1;
};

/// Reads "seconds=1.1" and the like. Throws std::runtime_error with one line that says what is wrong.
std::vector<Bound> parse_bounds(const std::vector<std::string>& texts);

/// One figure before and after.
struct Change {
  std::string where;  ///< "pcs, level 2", after the variation and seed where there are several
  std::string key;
  double before = 0, after = 0;
  std::string
      verdict;  ///< "faster", "slower", "less work", "more work", "better", "worse", or "" for the same
  bool broken = false;  ///< a bound
};

/// Two runs, or two sweeps, figure by figure: matched by variation and seed (of two single runs, without),
/// then by method and level.
class Comparison {
 public:
  /// Throws std::runtime_error when nothing matches and when a bound's figure is in no match.
  Comparison(const RunCollection& before, const RunCollection& after, const std::vector<Bound>& bounds);

  const std::vector<Change>& changes() const { return changes_; }
  /// Whether a bound does not hold, or cannot since what it bounds has stopped converging or gone.
  bool broken() const { return !broken_.empty(); }
  /// For a terminal: what has changed, what is in one of the two alone, and which bounds are broken.
  std::string text() const;

 private:
  std::vector<Change> changes_;
  std::vector<std::string> lost_, gained_, broken_;
  std::size_t bounds_ = 0;
};

}  // namespace drape

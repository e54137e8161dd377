#pragma once

#include "core/kernel/model/solver.h"
#include "core/kernel/solve/newton_state.h"

namespace drape {

/// A Solver that can resume an interrupted solve of the same problem.
class ResumableSolver : public Solver {
 public:
  std::vector<LevelResult> solve(const Problem& problem, Observer& observer) const final {
    return resume(problem, MethodState(), observer);
  }
  /// Continues from a state, with the results of finished levels at the front; bit for bit as if `solve` had
  /// not been interrupted. A state without a finished level or one under way begins its level from the start.
  virtual std::vector<LevelResult> resume(const Problem& problem, const MethodState& from,
                                          Observer& observer) const = 0;
};

}  // namespace drape

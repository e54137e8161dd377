#pragma once

#include "core/kernel/interfaces/solver.h"
#include "core/numerics/solve/newton_state.h"

namespace drape {

/// A Solver that implements `resume`; its `solve` resumes from the beginning.
class ResumableSolver : public Solver {
 public:
  std::vector<LevelResult> solve(const Problem& problem, Observer& observer) const final {
    return resume(problem, MethodState(), observer);
  }
  bool can_resume() const final { return true; }
  std::vector<LevelResult> resume(const Problem& problem, const MethodState& from,
                                  Observer& observer) const override = 0;
};

}  // namespace drape

#include "core/model/solver.h"

#include "core/numerics/newton_state.h"

namespace drape {

Positions Problem::carry_up(const ProlongationMatrix& weights, int level, const Positions& x) const {
  Positions y = weights * x;
  for (const HeldVertex& h : models[level + 1]->held()) y.row(h.vertex) = h.place.transpose();
  return y;
}

std::vector<ProlongationMatrix> Solver::interpolation(const Hierarchy& hierarchy) const {
  return hierarchy.linear;
}

std::vector<LevelResult> ResumableSolver::solve(const Problem& problem, Observer& observer) const {
  return resume(problem, MethodState(), observer);
}

Outcome worse_of(Outcome a, Outcome b) {
  constexpr Outcome rising[] = {Outcome::converged_to_rounding,
                                Outcome::refined_early,
                                Outcome::out_of_steps,
                                Outcome::stalled,
                                Outcome::infeasible,
                                Outcome::cancelled};
  Outcome worst = Outcome::converged;
  for (const Outcome outcome : rising)
    if (a == outcome || b == outcome) worst = outcome;
  return worst;
}

bool has_converged(const std::string& outcome) {
  return outcome == to_string(Outcome::converged) || outcome == to_string(Outcome::converged_to_rounding);
}

bool ended_as_asked(const std::string& outcome) {
  return has_converged(outcome) || outcome == to_string(Outcome::handed_on);
}

const char* to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::converged:
      return "converged";
    case Outcome::out_of_steps:
      return "out_of_steps";
    case Outcome::stalled:
      return "stalled";
    case Outcome::cancelled:
      return "cancelled";
    case Outcome::infeasible:
      return "infeasible";
    case Outcome::refined_early:
      return "refined_early";
    case Outcome::handed_on:
      return "handed_on";
    case Outcome::converged_to_rounding:
      return "converged_to_rounding";
  }
  return "";
}

}  // namespace drape

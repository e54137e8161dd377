#include "core/kernel/model/solver.h"

namespace drape {

Positions Problem::prolong(const ProlongationMatrix& weights, int level, const Positions& x) const {
  Positions y = weights * x;
  const std::shared_ptr<const LevelModel> finer = model(level + 1);
  for (const DirichletVertex& d : finer->dirichlet()) y.row(d.vertex) = d.target.transpose();
  return y;
}

std::vector<ProlongationMatrix> Solver::interpolation(const Hierarchy& hierarchy) const {
  return hierarchy.linear;
}

Outcome worse_of(Outcome a, Outcome b) {
  constexpr Outcome rising[] = {Outcome::converged_to_rounding,
                                Outcome::refined_early_on_request,
                                Outcome::max_steps_reached,
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

bool succeeded(const std::string& outcome) {
  return has_converged(outcome) || outcome == to_string(Outcome::refined_early_at_tolerance);
}

const char* to_string(Outcome outcome) {
  switch (outcome) {
    case Outcome::converged:
      return "converged";
    case Outcome::max_steps_reached:
      return "max_steps_reached";
    case Outcome::stalled:
      return "stalled";
    case Outcome::cancelled:
      return "cancelled";
    case Outcome::infeasible:
      return "infeasible";
    case Outcome::refined_early_on_request:
      return "refined_early_on_request";
    case Outcome::refined_early_at_tolerance:
      return "refined_early_at_tolerance";
    case Outcome::converged_to_rounding:
      return "converged_to_rounding";
  }
  return "";
}

}  // namespace drape

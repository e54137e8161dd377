#include "core/numerics/solve/dirichlet_predictor.h"

#include <cmath>

namespace drape {

namespace {

/// Below this gap, as a fraction of the bounding box diagonal, pins move on only by their penalty: each move
/// takes most of a gap, and gaps far below this one leave the line search no descent.
constexpr double min_gap_of_move = 2e-6;

}  // namespace

void DirichletPredictor::enforce() {
  if (iterate_.objective().enforces_dirichlet()) enforcer_.begin();
  update_constraints();
  if (enforcer_.active()) begin_penalty_unless_moving(predict(false, true));
}

void DirichletPredictor::move_on() {
  // The inertia of steps that contact has made short would hold the cloth back, and the pins would run into
  // it.
  begin_penalty_unless_moving(predict(false, false));
}

void DirichletPredictor::begin_penalty_unless_moving(double fraction) {
  if (fraction == 1) return;
  const bool moves = in_parts_ && enforcer_.note_move(fraction) && !iterate_.has_gap_below(min_gap_of_move);
  if (!moves) begin_penalty();
}

void DirichletPredictor::begin_penalty() {
  enforcer_.begin_penalty();
  update_constraints();
}

void DirichletPredictor::increase_penalty() {
  if (predict(true, true) == 1) return;
  if (enforcer_.is_moving()) {
    begin_penalty();
  } else {
    enforcer_.increase_penalty();
    update_constraints();
  }
}

/// Moves Dirichlet vertices towards their targets and the other vertices by the linearised response, as far
/// as limits and contact allow; with `whole`, only if the whole motion is feasible. Returns the feasible
/// fraction.
double DirichletPredictor::predict(bool whole, bool with_inertia) {
  const double fraction = step_.factorise(with_inertia) ? move(whole) : 0;
  update_constraints();
  return fraction;
}

double DirichletPredictor::move(bool whole) {
  Objective& objective = iterate_.objective();
  const Positions displacement = enforcer_.displacement_to_targets();
  Positions force, response;
  {
    PhaseTimer t(iterate_.result().seconds_by_phase, "solve");
    step_.factor().matrix().multiply(displacement, force);
    for (const DirichletVertex& d : iterate_.model().dirichlet()) force.row(d.vertex).setZero();
    step_.factor().solve(force, response);
  }
  const Positions direction = displacement - response;

  Positions trial = iterate_.x() + direction, gradient;
  iterate_.model().set_dirichlet(trial);
  const StepLimit limit = iterate_.max_step(trial);
  iterate_.set_limited_by(limit.by);
  PhaseTimer t(iterate_.result().seconds_by_phase, "gradient");
  double fraction = limit.fraction;
  while (fraction > LineSearch::min_step_length) {
    if (fraction < 1) trial = iterate_.x() + fraction * direction;
    if (std::isfinite(objective.gradient(trial, gradient))) break;
    fraction *= 0.5;
  }
  if (fraction == 1) {
    enforcer_.set_satisfied();
    iterate_.move_to(trial);
  } else if (!whole && fraction > LineSearch::min_step_length) {
    iterate_.move_to(trial);
  }
  return fraction;
}

}  // namespace drape

#include "core/numerics/solve/dirichlet_enforcer.h"

#include <cmath>
#include <map>

#include "core/kernel/files/message_text.h"

namespace drape {

namespace {

/// A doubling helps only if it leaves less than this fraction of the distance.
constexpr double max_remaining = 0.95;
/// It must also gain more than this fraction of the patch's width: against contact or a strain limit every
/// doubling gains a little, and the target is never reached.
constexpr double min_gain = 1e-4;
/// Idle doublings after which targets count as infeasible, once the penalty exceeds what the cloth can hold.
constexpr int max_idle_doublings = 4;
/// What the cloth can hold, over the membrane's stiffness.
constexpr double excess_stiffness = 10;
/// Smallest initial penalty, as a fraction of the membrane's stiffness: on fine meshes vertices have little
/// mass.
constexpr double min_initial_stiffness = 0.1;

/// A move by less than this fraction of the way gains nothing.
constexpr double min_move = 5e-3;
/// Idle moves in a row after which the penalty takes over.
constexpr int max_idle_moves = 4;
/// Below this gap, as a fraction of the bounding box diagonal, pins move on only by their penalty: each move
/// takes most of a gap, and gaps far below this one leave the line search no descent.
constexpr double min_gap_of_move = 2e-6;

}  // namespace

DirichletEnforcer::DirichletEnforcer(Iterate& iterate, NewtonStep& step, bool in_parts)
    : iterate_(iterate), step_(step), in_parts_(in_parts), fixed_(model().fixed()) {
  update_constraints();
}

void DirichletEnforcer::restore(const State& s) {
  fixed_ = model().fixed();
  s_ = s;
  for (const int k : s_.unsatisfied)
    if (static_cast<std::size_t>(k) >= model().dirichlet().size())
      throw std::runtime_error("the checkpoint has a pinned vertex that its load does not have");
  if (s.released) release();
  update_constraints();
}

void DirichletEnforcer::enforce() {
  if (iterate_.objective().enforces_dirichlet()) {
    set_satisfied();
    const auto& vertices = model().dirichlet();
    for (std::size_t k = 0; k < vertices.size(); ++k)
      if (iterate_.x().row(vertices[k].vertex) != vertices[k].target.transpose())
        s_.unsatisfied.push_back(static_cast<int>(k));
  }
  update_constraints();
  if (active()) begin_penalty_unless_moving(predict(false, true));
}

void DirichletEnforcer::move_on() {
  // The inertia of steps that contact has made short would hold the cloth back, and the pins would run into
  // it.
  begin_penalty_unless_moving(predict(false, false));
}

void DirichletEnforcer::increase_penalty() {
  if (predict(true, true) == 1) return;
  if (is_moving())
    begin_penalty();
  else
    double_penalty();
}

/// Fixes all Dirichlet vertices where x has them, at their targets, and drops the penalty.
void DirichletEnforcer::set_satisfied() {
  s_ = {};
  fixed_ = model().fixed();
  penalty_.reset();
}

/// Moves Dirichlet vertices towards their targets and the other vertices by the linearised response, as far
/// as limits and contact allow; with `whole`, only if the whole motion is feasible. Returns the feasible
/// fraction.
double DirichletEnforcer::predict(bool whole, bool with_inertia) {
  const double fraction = step_.factorise(with_inertia) ? move(whole) : 0;
  update_constraints();
  return fraction;
}

double DirichletEnforcer::move(bool whole) {
  Objective& objective = iterate_.objective();
  const Positions displacement = displacement_to_targets();
  Positions force, response;
  {
    PhaseTimer t(iterate_.result().seconds_by_phase, "solve");
    step_.factor().matrix().multiply(displacement, force);
    for (const DirichletVertex& d : model().dirichlet()) force.row(d.vertex).setZero();
    step_.factor().solve(force, response);
  }
  const Positions direction = displacement - response;

  Positions trial = iterate_.x() + direction, gradient;
  model().set_dirichlet(trial);
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
    set_satisfied();
    iterate_.move_to(trial);
  } else if (!whole && fraction > LineSearch::min_step_length) {
    iterate_.move_to(trial);
  }
  return fraction;
}

/// n×3 [m]: from x to the targets for unsatisfied vertices, zero elsewhere.
Positions DirichletEnforcer::displacement_to_targets() const {
  const Positions& x = iterate_.x();
  Positions displacement = Positions::Zero(x.rows(), 3);
  for (int k : s_.unsatisfied) {
    const DirichletVertex& d = model().dirichlet()[k];
    displacement.row(d.vertex) = d.target.transpose() - x.row(d.vertex);
  }
  return displacement;
}

void DirichletEnforcer::begin_penalty_unless_moving(double fraction) {
  if (fraction == 1) return;
  const bool moves = in_parts_ && note_move(fraction) && !iterate_.has_gap_below(min_gap_of_move);
  if (!moves) begin_penalty();
}

/// Records a move by this fraction of the way that remained. Returns false once moves have long gained
/// nothing.
bool DirichletEnforcer::note_move(double fraction) {
  s_.idle = fraction < min_move ? s_.idle + 1 : 0;
  return s_.idle < max_idle_moves;
}

void DirichletEnforcer::begin_penalty() {
  s_.blocked_by = iterate_.limited_by();
  // The number of the modulus, as in the supplement, but not below what the membrane would notice
  // (departure).
  s_.stiffness = std::max(model().material().mean_membrane_modulus(),
                          min_initial_stiffness * membrane_stiffness() / smallest_mass());
  s_.best = INFINITY;
  s_.idle = 0;
  release();
  update_constraints();
}

/// Once doublings have long stopped reducing the distance, fixes the vertices where they are instead: the
/// targets are infeasible.
void DirichletEnforcer::double_penalty() {
  s_.blocked_by = iterate_.limited_by();
  const double distance = max_violation();
  if (distance <= max_remaining * s_.best && s_.best - distance > min_gain * patch_width()) {
    s_.best = distance;
    s_.idle = 0;
  } else {
    ++s_.idle;
  }
  if (s_.idle >= max_idle_doublings &&
      s_.stiffness * smallest_mass() > excess_stiffness * membrane_stiffness()) {
    s_.infeasible = true;
    fixed_ = model().fixed();
    penalty_.reset();
  } else {
    s_.stiffness *= 2;
    release();
  }
  update_constraints();
}

/// Releases the unsatisfied vertices to a penalty of the present stiffness.
void DirichletEnforcer::release() {
  std::vector<PositionPenalty::Term> terms;
  for (int k : s_.unsatisfied) {
    const DirichletVertex& d = model().dirichlet()[k];
    fixed_[d.vertex] = 0;
    terms.push_back({d.vertex, d.target, s_.stiffness * model().masses()[d.vertex]});
  }
  penalty_ = std::make_unique<PositionPenalty>(std::move(terms));
}

double DirichletEnforcer::membrane_stiffness() const {
  return model().material().mean_membrane_modulus() * model().material().thickness;
}

double DirichletEnforcer::smallest_mass() const {
  double least = INFINITY;
  for (int k : s_.unsatisfied) least = std::min(least, model().masses()[model().dirichlet()[k].vertex]);
  return least;
}

double DirichletEnforcer::patch_width() const {
  return std::sqrt(smallest_mass() / (model().material().density * model().material().thickness));
}

double DirichletEnforcer::violation(int unsatisfied) const {
  const DirichletVertex& d = model().dirichlet()[unsatisfied];
  return (iterate_.x().row(d.vertex) - d.target.transpose()).norm();
}

double DirichletEnforcer::max_violation() const {
  double most = 0;
  for (int k : s_.unsatisfied) most = std::max(most, violation(k));
  return most;
}

std::string DirichletEnforcer::message() const {
  std::map<int, int> worst_of_pin;
  for (int k : s_.unsatisfied) {
    const auto [it, first] = worst_of_pin.try_emplace(model().dirichlet()[k].pin, k);
    if (!first && violation(k) > violation(it->second)) it->second = k;
  }
  std::string text;
  for (const auto& [pin, k] : worst_of_pin) {
    text += (text.empty() ? "" : ", ") + ("pin " + std::to_string(pin)) + " stopped " +
            three_digits(violation(k)) + " m short of its target (vertex " +
            std::to_string(model().dirichlet()[k].vertex) + ")";
  }
  return text + (s_.blocked_by.empty() ? "" : ", blocked by " + s_.blocked_by);
}

}  // namespace drape

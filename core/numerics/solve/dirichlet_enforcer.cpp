#include "core/numerics/solve/dirichlet_enforcer.h"

#include <cmath>
#include <map>

#include "core/kernel/files/message_text.h"

namespace drape {

namespace {

/// A doubling helps only if it leaves less than this fraction of the distance …
constexpr double max_remaining = 0.95;
/// … and gains more than this fraction of the patch's width. Against contact or a strain limit every doubling
/// gains a little, and the target is never reached.
constexpr double min_gain = 1e-4;
/// Idle doublings after which targets count as infeasible, once the penalty exceeds what the cloth can hold …
constexpr int max_idle_doublings = 4;
/// … by this factor over the membrane's stiffness.
constexpr double excess_stiffness = 10;
/// Smallest initial penalty, as a fraction of the membrane's stiffness: on fine meshes vertices have little
/// mass.
constexpr double min_initial_stiffness = 0.1;

/// A move by less than this fraction of the way gains nothing …
constexpr double min_move = 5e-3;
/// … and after so many of them in a row the penalty takes over.
constexpr int max_idle_moves = 4;

}  // namespace

void DirichletEnforcer::begin() {
  set_satisfied();
  const auto& vertices = model().dirichlet();
  for (std::size_t k = 0; k < vertices.size(); ++k)
    if (iterate_.x().row(vertices[k].vertex) != vertices[k].target.transpose())
      s_.unsatisfied.push_back(static_cast<int>(k));
}

Positions DirichletEnforcer::displacement_to_targets() const {
  const Positions& x = iterate_.x();
  Positions displacement = Positions::Zero(x.rows(), 3);
  for (int k : s_.unsatisfied) {
    const DirichletVertex& d = model().dirichlet()[k];
    displacement.row(d.vertex) = d.target.transpose() - x.row(d.vertex);
  }
  return displacement;
}

void DirichletEnforcer::set_satisfied() {
  s_ = {};
  fixed_ = model().fixed();
  penalty_.reset();
}

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

void DirichletEnforcer::restore(const State& s) {
  fixed_ = model().fixed();
  s_ = s;
  for (const int k : s_.unsatisfied)
    if (static_cast<std::size_t>(k) >= model().dirichlet().size())
      throw std::runtime_error("the checkpoint has a pinned vertex that its load does not have");
  if (s.released) release();
}

void DirichletEnforcer::release() {
  std::vector<PositionPenalty::Term> terms;
  for (int k : s_.unsatisfied) {
    const DirichletVertex& d = model().dirichlet()[k];
    fixed_[d.vertex] = 0;
    terms.push_back({d.vertex, d.target, s_.stiffness * model().masses()[d.vertex]});
  }
  penalty_ = std::make_unique<PositionPenalty>(std::move(terms));
}

void DirichletEnforcer::increase_penalty() {
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
    return;
  }
  s_.stiffness *= 2;
  release();
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

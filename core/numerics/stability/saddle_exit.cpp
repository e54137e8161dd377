#include "core/numerics/stability/saddle_exit.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/kernel/files/message_text.h"
#include "core/kernel/threads/stopwatch.h"
#include "core/numerics/linear_algebra/conjugate_gradients.h"

namespace drape {
namespace {

/// Exits of one increment, or of a level without a schedule. Each lowers the energy.
constexpr int most_exits = 10;
/// The force tolerance after an exit, by how much it is below the level's own at least and at most, and for
/// how many steps.
constexpr double tight_tolerance = 1e-6, least_strictness = 10, most_strictness = 1000;
constexpr int most_tight_steps = 100;
/// Amplitudes of a walk along a mode, in diagonals of the rest shape: the first one, up to which one
/// round-off may hide the fall of the energy, and the last one; and the factor from one to the next.
constexpr double first_amplitude = 1e-6, hidden_amplitude = 1e-3, last_amplitude = 1, stride_growth = 2;
/// Newton steps across the mode after a stride, with the matrix of the first.
constexpr int relaxations = 4;
/// Forces along a mode below this fraction of all forces do not choose its sign.
constexpr double clear_slope = 1e-3;

/// Counts all the time of its life as the phase `stability`, but for the seconds that observers take and for
/// the building of collisions, which is a phase of its own and subtracted from the gradient's.
class OwnPhase {
 public:
  OwnPhase(const Iterate& iterate, const double& observed)
      : iterate_(iterate),
        before_(iterate.result().seconds_by_phase),
        built_before_(built()),
        observed_(observed),
        observed_before_(observed) {}
  ~OwnPhase() {
    const double building = built() - built_before_;
    before_["gradient"] += building;
    before_["stability"] += watch_.seconds() - building - (observed_ - observed_before_);
    iterate_.result().seconds_by_phase = std::move(before_);
  }
  OwnPhase(const OwnPhase&) = delete;
  OwnPhase& operator=(const OwnPhase&) = delete;

 private:
  double built() const { return iterate_.objective().contacts().seconds_building(); }

  const Iterate& iterate_;
  std::map<std::string, double> before_;
  const double built_before_;
  const double& observed_;
  const double observed_before_;
  const Stopwatch watch_;
};

}  // namespace

bool SaddleExit::at_saddle() const {
  const std::optional<Stability>& tested = iterate_.result().stability;
  return tested && tested->verdict == Stability::unstable;
}

std::string SaddleExit::text() const {
  const Stability& s = *iterate_.result().stability;
  return "forces balance at a saddle, not at a minimum: the lowest eigenvalue of the Hessian over the masses "
         "is " +
         three_digits(s.lowest_eigenvalue) + " 1/s², the curvature ratio " + three_digits(s.curvature_ratio) +
         (p_.stability == StabilityMode::report
              ? "; with newton.stability: leave the cloth goes on to a minimum"
              : "; it could not be left in " + std::to_string(s_.exits) +
                    " exits: start with a larger perturbation, or apply the load in smaller increments");
}

bool SaddleExit::leave(bool at_end) {
  LevelResult& result = iterate_.result();
  if (p_.stability == StabilityMode::off || !iterate_.objective().has_exact_hessian()) return false;
  const OwnPhase phase(iterate_, observed_);
  const StabilityTest test = test_stability(iterate_, factor_, !at_end);
  const bool is_known = test.fault.empty();
  result.stability.reset();
  fault_ = at_end ? test.fault : "";
  if (is_known && (at_end || test.stability.verdict != Stability::stable)) result.stability = test.stability;
  if (!at_saddle() || s_.exits == most_exits) return false;
  // Both ways are equally good for a symmetric saddle. Forces decide if they are clear, else the largest
  // entry.
  Eigen::Index row = 0, column = 0;
  test.mode.cwiseAbs().maxCoeff(&row, &column);
  double sign = test.mode(row, column) < 0 ? -1 : 1;
  const double slope = iterate_.gradient().cwiseProduct(test.mode).sum();
  if (std::abs(slope) > clear_slope * free_norm(iterate_.gradient(), iterate_.fixed()) * test.mode.norm())
    sign = slope > 0 ? -1 : 1;
  factor_serves_ = false;
  const bool falls = walk(test, sign) || (!stopped_ && walk(test, -sign));
  if (stopped_)
    result.stability.reset();  // a fall may have followed
  else if (!falls)
    result.stability->verdict = Stability::marginal;
  if (!falls || p_.stability == StabilityMode::report) return false;
  ++s_.exits;
  ++result.saddles_left;
  result.stability.reset();
  s_.tightened_at = result.steps;
  check_.tighten(std::clamp(p_.force_tolerance / tight_tolerance, least_strictness, most_strictness));
  return true;
}

bool SaddleExit::walk(const StabilityTest& test, double sign) {
  const bool leaves = p_.stability == StabilityMode::leave;
  const Positions origin = iterate_.x();
  const double begun_at = iterate_.energy(), noise = iterate_.energy_noise(0),
               diagonal = iterate_.rest_diagonal();
  Positions lowest = origin;
  double lowest_energy = begun_at, amplitude = 0;
  // Where the energy can fall by more than its round-off, it has not risen again at this amplitude: to fourth
  // order it is E₀ − c a² / 2 + q a⁴ / 4, c = |vᵀHv|, and falls by c² / 4q at √(c / q).
  const double visible = std::sqrt(4 * noise / std::abs(test.curvature)) / diagonal;
  for (double a = std::clamp(visible, first_amplitude, hidden_amplitude); a <= last_amplitude;
       a *= stride_growth) {
    stopped_ = stopped_ || stop_();
    if (stopped_) break;
    const Positions stride = lowest + sign * (a - amplitude) * diagonal * test.mode;
    const double feasible = iterate_.max_step(stride).fraction;
    iterate_.move_to(lowest + feasible * (stride - lowest));
    iterate_.evaluate();
    if (std::isfinite(iterate_.energy())) relax_across(test.mode);
    const double energy = iterate_.energy();
    const bool is_hidden = a < hidden_amplitude && std::abs(energy - begun_at) <= noise;
    const bool falls = energy < lowest_energy && !is_hidden;
    if (falls) {
      lowest = iterate_.x();
      lowest_energy = energy;
      amplitude = a;
    } else {
      iterate_.move_to(lowest);
    }
    const bool is_known = !leaves && begun_at - lowest_energy > noise;
    if (feasible < 1 || !(falls || is_hidden) || is_known) break;
  }
  const bool has_fallen = !stopped_ && begun_at - lowest_energy > noise;
  return_to(has_fallen && leaves ? lowest : origin);
  return has_fallen;
}

void SaddleExit::return_to(const Positions& x) {
  iterate_.move_to(x);
  iterate_.max_step(x);  // finds the contacts there again
  iterate_.evaluate();
  iterate_.update_residual();
}

/// Lowers the energy across the mode, by Newton steps of the projected Hessian that leave its amplitude.
/// Motions slower than the saddle's own are left to the solver. A factor serves as long as whole steps follow
/// from it.
void SaddleExit::relax_across(const Positions& mode) {
  const double rate = std::abs(iterate_.result().stability->lowest_eigenvalue);
  ImplicitStep step;
  Positions along, direction;
  for (int k = 0; k < relaxations; ++k) {
    const bool is_new = !factor_serves_;
    if (is_new && !factor_.prepare(factor_.hessian(Projection::clamp), rate * iterate_.model().masses()))
      return;
    step.begin(iterate_.x(), 1);
    step.evaluate(iterate_, 0);
    factor_.precondition(mode, along);
    factor_.precondition(step.gradient(), direction);
    direction -= inner_product(mode, direction) / inner_product(mode, along) * along;
    direction *= -1;
    factor_serves_ = true;
    if (-inner_product(step.gradient(), direction) <= iterate_.energy_noise(0)) return;  // nothing to gain
    const bool moves = line_search_.search(iterate_, step, direction);
    factor_serves_ = moves && line_search_.step_length() == 1;
    if (!moves && is_new) return;
    if (moves) note_relaxation();
  }
  factor_serves_ = false;
}

void SaddleExit::note_relaxation() {
  ++iterate_.result().iterations;
  iterate_.update_residual();
  const Stopwatch watch;
  report_();
  observed_ += watch.seconds();
}

bool SaddleExit::end_tightening() {
  check_.tighten(1);
  return std::exchange(s_.tightened_at, std::nullopt).has_value();
}

void SaddleExit::limit_tightening() {
  if (s_.tightened_at && iterate_.result().steps - *s_.tightened_at >= most_tight_steps) end_tightening();
}

void SaddleExit::restart() {
  end_tightening();
  s_.exits = 0;
  iterate_.result().stability.reset();
}

}  // namespace drape

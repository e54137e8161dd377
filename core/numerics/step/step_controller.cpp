#include "core/numerics/step/step_controller.h"

#include <algorithm>

#include "core/numerics/step/hessian_modification.h"

namespace drape {

namespace {

/// A step length below this shows that h was too long.
constexpr double short_step = 0.25;
/// Steps that leave a force residual above this count as stalled.
constexpr double stall_residual = 1e3;
/// Stalled steps in a row after which h is shortened.
constexpr int max_stall_count = 20;
/// But only if they have left more than this part of the residual: steps that carry the cloth on are no
/// stall.
constexpr double stall_remainder = 0.5;
/// h is divided by this after a stall.
constexpr double back_off = 16;
/// h grows again after max_stall_count steps without a stall, or once forces are of the load's size.
constexpr double recovered_residual = 10;
/// h is divided by this where steps repeat each other.
constexpr double cycle_reduction = 4;
/// StepController::min_step_size for the mass of the static form, as 1/h² [1/s²].
constexpr double max_added_mass = 1 / (StepController::min_step_size * StepController::min_step_size);

}  // namespace

double StepController::inverse_h2() const {
  const double h = is_static() ? s_.cycle_limit : s_.step_size;
  return 1 / (h * h);
}

void StepController::begin_step() {
  begun_with_ = s_.step_size;
  shortest_step_length_ = 1;
}

bool StepController::damp() {
  if (is_static()) {
    // In free fall the matrix is positive definite only by round-off, and the direction so long that contact
    // cuts the step to nothing.
    added_mass_ = std::max(10 * added_mass_, first_mass_shift(p_));
    return added_mass_ < max_added_mass;
  }
  s_.step_size /= 4;
  return !(s_.step_size < min_step_size);
}

void StepController::end_iteration(double step_length) {
  added_mass_ = 0;
  shortest_step_length_ = std::min(shortest_step_length_, step_length);
}

void StepController::end_step(double force_residual) {
  if (is_static()) return;  // has no h to adapt
  int& stalls = s_.stall_count;
  double& h = s_.step_size;
  stalls = force_residual > stall_residual ? std::max(stalls, 0) + 1 : std::min(stalls, 0) - 1;
  if (stalls == 1) s_.stall_residual = force_residual;
  if (stalls == max_stall_count) {
    stalls = 0;
    if (force_residual > stall_remainder * s_.stall_residual) {
      s_.backed_off = h > min_step_size;
      h = s_.backed_off ? std::max(h / back_off, min_step_size)
                        : std::min(p_.step_size, s_.cycle_limit);  // the smallest has not helped
    }
  }
  if (force_residual < recovered_residual || stalls == -max_stall_count) s_.backed_off = false;
  if (s_.backed_off) return;
  if (shortest_step_length_ == 1)
    h = std::max(h, std::min({h * p_.step_growth, max_step_size, s_.cycle_limit}));
  if (shortest_step_length_ < short_step) h = std::max(h / p_.step_growth, min_step_size);
}

void StepController::limit_step_size() {
  const double h = is_static() ? std::min(s_.cycle_limit, max_step_size) : s_.step_size;
  s_.cycle_limit = std::max(h / cycle_reduction, min_step_size);
  if (!is_static()) s_.step_size = s_.cycle_limit;
}

void StepController::abandon_step() {
  s_.step_size = begun_with_;
  added_mass_ = 0;
}

}  // namespace drape

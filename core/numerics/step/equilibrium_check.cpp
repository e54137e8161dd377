#include "core/numerics/step/equilibrium_check.h"

#include <algorithm>

namespace drape {

bool EquilibriumCheck::is_within(double times) const {
  if (!(iterate_.force_residual() <= times * force_tolerance())) return false;  // also false for NaN
  return p_.decrement_tolerance == 0 || *std::ranges::max_element(s_.decrements) <= p_.decrement_tolerance;
}

bool EquilibriumCheck::in_tolerance() {
  if (!is_within(1)) return false;
  iterate_.update_friction();
  return iterate_.force_residual() <= force_tolerance();
}

bool EquilibriumCheck::is_at_rounding_floor(FactorCache& factor) {
  s_.idle = {};
  iterate_.update_friction();
  const RoundingFloor floor =
      rounding_floor(factor.hessian(Projection::none), iterate_.x(), iterate_.gradient(), iterate_.fixed());
  rounding_residual_ = floor.norm / iterate_.residual_scale();
  return floor.reached;
}

void EquilibriumCheck::note_step(double inertia) {
  s_.idle.note(iterate_.energy(), iterate_.force_residual(), iterate_.energy_noise(inertia));
  s_.cycle.note(iterate_.energy_without_friction(), iterate_.force_residual());
  ++s_.steps_since_lowest;
  if (iterate_.force_residual() < s_.lowest_residual) {
    s_.lowest_residual = iterate_.force_residual();
    s_.steps_since_lowest = 0;
  }
}

}  // namespace drape

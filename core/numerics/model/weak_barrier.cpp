#include "core/numerics/model/weak_barrier.h"

#include <cmath>

#include "core/kernel/files/message_text.h"
#include "core/kernel/interfaces/gaps.h"

namespace drape {

namespace {

/// Gaps below this fraction of d̂ indicate a weak barrier.
constexpr double weak_gap_fraction = 1e-3;
/// Stiffness over the load's pressure: a barrier with a ratio of 1 leaves a gap of d̂ / 2, with 10 of 5 d̂ / 6
/// (core/numerics/contact_forces/contact_stiffness.h).
constexpr double suitable_ratio = 10;

}  // namespace

std::string weak_barrier(const LevelModel& model, const Positions& x) {
  for (const auto& contact : model.contacts()) {
    const SmallestGap smallest = contact->smallest_gap(x);
    if (!(smallest.gap < weak_gap_fraction * smallest.dhat)) continue;
    const double pressure = model.load_pressure(x);
    if (smallest.stiffness >= pressure) continue;
    return "the barrier is too weak for the load: its stiffness is " + three_digits(smallest.stiffness) +
           " Pa but the load's pressure is " + three_digits(pressure) + " Pa, and the gap between " +
           smallest.between + " is " + three_digits(smallest.gap) + " m, " +
           three_digits(smallest.gap / smallest.dhat) +
           " of the contact's dhat; set its stiffness to about " + three_digits(suitable_ratio * pressure) +
           " (null chooses it from the cloth's weight)";
  }
  return "";
}

}  // namespace drape

#include "core/model/weak_barrier.h"

#include <cmath>

#include "core/mesh/message_text.h"
#include "core/model/smallest_gap.h"

namespace drape {

namespace {

/// Part of the range below which a gap is far below it.
constexpr double far_below = 1e-3;
/// A barrier as stiff as the load presses leaves half of the range for a gap, one ten times as stiff five
/// sixths (core/contact/stiffness.h).
constexpr double suitable = 10;

/// The external forces a unit of area, root mean square over free vertices [Pa].
double pressure_of_load(const LevelModel& model, const Positions& x) {
  double square = 0;
  for (int i = 0; i < model.level().vertex_count(); ++i)
    if (!model.fixed()[i]) square += std::pow(model.level().vertex_area[i], 2);
  return square > 0 ? model.load_norm(x) / std::sqrt(square) : 0;
}

}  // namespace

std::string weak_barrier(const LevelModel& model, const Positions& x) {
  for (const auto& contact : model.contacts()) {
    const auto* named = dynamic_cast<const NamesSmallestGap*>(contact.get());
    if (!named) continue;
    const SmallestGap smallest = named->smallest_gap(x);
    if (!(smallest.gap < far_below * smallest.range)) continue;
    const double pressure = pressure_of_load(model, x);
    if (smallest.stiffness >= pressure) continue;
    return "the barrier is too weak for the load: its stiffness is " + three_digits(smallest.stiffness) +
           " Pa where the load presses with " + three_digits(pressure) + " Pa, so that the gap between " +
           smallest.between + " is " + three_digits(smallest.gap) + " m, " +
           three_digits(smallest.gap / smallest.range) +
           " of the contact's range; set its stiffness to about " + three_digits(suitable * pressure) +
           " (null chooses it from the cloth's weight)";
  }
  return "";
}

}  // namespace drape

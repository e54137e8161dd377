#include "core/numerics/solve/newton_report.h"

#include <algorithm>

#include "core/kernel/files/message_text.h"
#include "core/numerics/collision_detection/components.h"

namespace drape {
namespace {

/// Gaps below this fraction of d̂ indicate a weak barrier.
constexpr double weak_gap_fraction = 1e-3;
/// Stiffness over the load's pressure: a barrier with a ratio of 1 leaves a gap of d̂ / 2, with 10 of 5 d̂ / 6
/// (core/numerics/contact_forces/contact_stiffness.h).
constexpr double suitable_ratio = 10;
/// A residual that was lowest within this fraction of max_steps still falls.
constexpr double falling_fraction = 0.1;

bool misses_decrement_alone(const LevelResult& so_far, const NewtonParameters& p) {
  return so_far.force_residual <= p.force_tolerance && p.decrement_tolerance > 0;
}

/// Which tolerance is not met.
std::string unmet(const LevelResult& so_far, const NewtonParameters& p) {
  if (misses_decrement_alone(so_far, p))
    return "the decrement, " + three_digits(so_far.decrement) +
           " m/s at last, was above decrement_tolerance = " + three_digits(p.decrement_tolerance) +
           " in one of the last three iterations";
  return "the force residual is " + three_digits(so_far.force_residual) +
         ", above force_tolerance = " + three_digits(p.force_tolerance);
}

}  // namespace

IterationRow iteration_row(const Iterate& iterate, const NewtonStep& step, const LoadStepper& load,
                           int iteration, double seconds) {
  Objective& objective = iterate.objective();
  const LevelResult& so_far = iterate.result();
  IterationRow row;
  row.level = so_far.level;
  row.step = so_far.steps;
  row.iteration = iteration;
  row.energy = iterate.energy_without_friction() - objective.penalty(iterate.x());
  if (objective.is_proxy()) {
    row.proxy_energy = row.energy;
    row.energy = objective.plain_energy(iterate.x());
  }
  if (objective.contacts().any()) {
    row.contacts = objective.contacts().count();
    row.smallest_gap = objective.contacts().smallest_gap();
  }
  row.decrement = so_far.decrement;
  row.force_residual = so_far.force_residual;
  row.step_length = step.step_length();
  row.step_size = step.step_size();
  row.time = load.time();
  row.seconds = seconds;
  row.flops = so_far.flops;
  return row;
}

void record_contacts(const ActiveContacts& contacts, LevelResult& result) {
  result.contact_stiffness = contacts.stiffness();
  if (!contacts.any()) return;
  result.smallest_gap = contacts.smallest_gap();
  // Collisions are built while energies are evaluated.
  result.seconds_by_phase["collisions"] = contacts.seconds_building();
  result.seconds_by_phase["gradient"] -= contacts.seconds_building();
}

std::string max_steps_text(const LevelResult& so_far, const NewtonParameters& p,
                           const EquilibriumCheck& check) {
  const std::string begin = "no equilibrium within max_steps = " + std::to_string(p.max_steps) + "; ";
  if (misses_decrement_alone(so_far, p) && !check.is_within(1)) return begin + unmet(so_far, p);
  const int steps = check.state().steps_since_lowest;
  const bool falls = steps < falling_fraction * p.max_steps;
  return begin + "force residual " + three_digits(so_far.force_residual) +
         (falls ? ", which still falls: raise max_steps"
                : ", which was lowest " + std::to_string(steps) + " steps before, at " +
                      three_digits(check.state().lowest_residual) + ": more steps are unlikely to help");
}

/// The first vertex of a part of the cloth none of whose vertices is pinned, where others are; -1 without
/// one.
int first_unpinned_part(const LevelModel& model) {
  const std::vector<int> part = component_numbers(model.level().topology);
  const std::vector<char>& fixed = model.fixed();
  std::vector<char> pinned(part.size(), 0);
  for (std::size_t v = 0; v < part.size(); ++v)
    if (fixed[v]) pinned[part[v]] = 1;
  const auto loose = std::ranges::find_if(part, [&](int p) { return !pinned[p]; });
  const bool any = std::ranges::find(pinned, 1) != pinned.end();
  return any && loose != part.end() ? static_cast<int>(loose - part.begin()) : -1;
}

std::string drift_text(double drift, double most, const LevelModel& model) {
  const double diagonal = bounding_box_diagonal(model.level().rest.vertices);
  const bool is_held = model.is_held();
  const int loose = first_unpinned_part(model);
  const std::string begin = loose >= 0 ? "no pin is on the part of the cloth that has vertex " +
                                             std::to_string(loose) + ", and nothing holds it"
                            : is_held ? "its pins or springs do not hold the cloth"
                                      : "nothing holds the cloth";
  return begin + " within " + three_digits(most) + " of its diagonals: it has drifted by " +
         three_digits(drift) + " of them, " + three_digits(drift * diagonal) +
         " m, and does not come to rest; " +
         (is_held && loose < 0
              ? "an energy that is unbounded below has no state of rest: check the signs in formulas and "
                "the energies' parameters; or pin every part of the cloth"
              : "pin it, put something under it, start it nearer to what is there, or raise the friction");
}

std::string rounding_text(const LevelResult& so_far, const NewtonParameters& p, double rounding) {
  return unmet(so_far, p) + ": round-off alone accounts for up to " + three_digits(rounding) +
         (misses_decrement_alone(so_far, p) ? " of the force residual here" : " here") +
         ", and no step lowers it";
}

std::string weak_barrier(const LevelModel& model, const Positions& x) {
  for (const auto& contact : model.contacts()) {
    const SmallestGap smallest = contact->smallest_gap(x);
    if (!(smallest.gap < weak_gap_fraction * contact->dhat())) continue;
    const double pressure = model.load_pressure(x);
    if (contact->stiffness() >= pressure) continue;
    return "the barrier is too weak for the load: its stiffness is " + three_digits(contact->stiffness()) +
           " Pa but the load's pressure is " + three_digits(pressure) + " Pa, and the gap between " +
           smallest.between + " is " + three_digits(smallest.gap) + " m, " +
           three_digits(smallest.gap / contact->dhat()) +
           " of the contact's dhat; set its stiffness to about " + three_digits(suitable_ratio * pressure) +
           " (null chooses it from the cloth's weight)";
  }
  return "";
}

}  // namespace drape

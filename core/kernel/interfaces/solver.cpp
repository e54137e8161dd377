#include "core/kernel/interfaces/solver.h"

#include <utility>

namespace drape {

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

namespace {

constexpr std::pair<Outcome, const char*> names[] = {
    {Outcome::converged, "converged"},
    {Outcome::max_steps_reached, "max_steps_reached"},
    {Outcome::stalled, "stalled"},
    {Outcome::cancelled, "cancelled"},
    {Outcome::infeasible, "infeasible"},
    {Outcome::refined_early_on_request, "refined_early_on_request"},
    {Outcome::converged_to_rounding, "converged_to_rounding"}};

}  // namespace

bool has_converged(const std::string& outcome) {
  for (const auto& [value, name] : names)
    if (name == outcome) return has_converged(value);
  return false;
}

const char* to_string(Outcome outcome) {
  for (const auto& [value, name] : names)
    if (value == outcome) return name;
  return "";
}

}  // namespace drape

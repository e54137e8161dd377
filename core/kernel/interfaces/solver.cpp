#include "core/kernel/interfaces/solver.h"

#include <iterator>

namespace drape {

const char* to_string(Outcome outcome) {
  constexpr const char* names[] = {"converged",
                                   "converged_to_rounding",
                                   "refined_early_on_request",
                                   "max_steps_reached",
                                   "stalled",
                                   "infeasible",
                                   "cancelled"};
  const auto index = static_cast<std::size_t>(outcome);
  return index < std::size(names) ? names[index] : "";
}

bool has_converged(const std::string& outcome) {
  return outcome == to_string(Outcome::converged) || outcome == to_string(Outcome::converged_to_rounding);
}

}  // namespace drape

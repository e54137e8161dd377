#include "core/kernel/interfaces/solver.h"

#include <iterator>

namespace drape {

const char* to_string(Outcome outcome) {
  constexpr const char* names[] = {"converged",
                                   "converged_to_rounding",
                                   "refined_early_on_request",
                                   "saddle",
                                   "max_steps_reached",
                                   "stalled",
                                   "infeasible",
                                   "cancelled"};
  const auto index = static_cast<std::size_t>(outcome);
  return index < std::size(names) ? names[index] : "";
}

}  // namespace drape

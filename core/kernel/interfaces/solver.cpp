#include "core/kernel/interfaces/solver.h"

#include <array>

namespace drape {

const char* to_string(Outcome outcome) {
  constexpr auto names =
      std::to_array<const char*>({"converged", "converged_to_rounding", "refined_early_on_request", "saddle",
                                  "max_steps_reached", "stalled", "infeasible", "cancelled"});
  const auto index = static_cast<std::size_t>(outcome);
  return index < names.size() ? names[index] : "";
}

const char* to_string(Stability::Verdict verdict) {
  constexpr const char* names[] = {"stable", "marginal", "unstable"};
  const auto index = static_cast<std::size_t>(verdict);
  return index < std::size(names) ? names[index] : "";
}

const char* stability_word(const LevelResult& result) {
  if (result.stability) return to_string(result.stability->verdict);
  return has_converged(result.outcome) ? "untested" : "";
}

}  // namespace drape

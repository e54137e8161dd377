#include "core/kernel/interfaces/solver.h"

#include <catch2/catch.hpp>

using namespace drape;

TEST_CASE("the worst outcome of a method's levels does not depend on their order") {
  const Outcome rising[] = {Outcome::converged,
                            Outcome::converged_to_rounding,
                            Outcome::refined_early_on_request,
                            Outcome::max_steps_reached,
                            Outcome::stalled,
                            Outcome::infeasible,
                            Outcome::cancelled};
  for (std::size_t i = 0; i < std::size(rising); ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      INFO(to_string(rising[j]) << ", " << to_string(rising[i]));
      CHECK(worse_of(rising[j], rising[i]) == rising[i]);
      CHECK(worse_of(rising[i], rising[j]) == rising[i]);
    }
}

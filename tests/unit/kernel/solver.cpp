#include "core/kernel/interfaces/solver.h"

#include <catch2/catch.hpp>

using namespace drape;

TEST_CASE("the worst outcome of a method's levels does not depend on their order") {
  const auto check = [](Outcome better, Outcome worse, Outcome expected) {
    INFO(to_string(better) << ", " << to_string(worse));
    CHECK(worse_of(better, worse) == expected);
    CHECK(worse_of(worse, better) == expected);
  };
  const Outcome rising[] = {Outcome::converged,
                            Outcome::converged_to_rounding,
                            Outcome::refined_early_on_request,
                            Outcome::max_steps_reached,
                            Outcome::stalled,
                            Outcome::infeasible,
                            Outcome::cancelled};
  for (std::size_t worse = 0; worse < std::size(rising); ++worse)
    for (std::size_t better = 0; better <= worse; ++better)
      check(rising[better], rising[worse], rising[worse]);
}

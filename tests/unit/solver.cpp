#include "core/kernel/model/solver.h"

#include <catch2/catch.hpp>

using namespace drape;

TEST_CASE("the worst outcome of a method's levels does not depend on their order") {
  CHECK(worse_of(Outcome::converged, Outcome::refined_early_at_tolerance) == Outcome::converged);
  CHECK(worse_of(Outcome::converged_to_rounding, Outcome::converged) == Outcome::converged_to_rounding);
  CHECK(worse_of(Outcome::stalled, Outcome::refined_early_on_request) == Outcome::stalled);
  CHECK(worse_of(Outcome::max_steps_reached, Outcome::infeasible) == Outcome::infeasible);
  CHECK(worse_of(Outcome::cancelled, Outcome::infeasible) == Outcome::cancelled);
}

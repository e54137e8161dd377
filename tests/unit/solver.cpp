#include "core/model/solver.h"

#include <catch2/catch.hpp>

using namespace drape;

TEST_CASE("the worst outcome of a method's levels is told, whatever their order") {
  CHECK(worse_of(Outcome::converged, Outcome::handed_on) == Outcome::converged);
  CHECK(worse_of(Outcome::converged_to_rounding, Outcome::converged) == Outcome::converged_to_rounding);
  CHECK(worse_of(Outcome::stalled, Outcome::refined_early) == Outcome::stalled);
  CHECK(worse_of(Outcome::out_of_steps, Outcome::infeasible) == Outcome::infeasible);
  CHECK(worse_of(Outcome::cancelled, Outcome::infeasible) == Outcome::cancelled);
}

#include "core/numerics/step/equilibrium_check.h"

#include <catch2/catch.hpp>

#include "tests/support/newton_problem.h"
#include "tests/support/test_energies.h"

using namespace drape;

TEST_CASE("The tolerances ask for a small residual, and for three small decrements if they are limited") {
  const NewtonParameters p{.decrement_tolerance = 1e-3};
  NewtonProblem problem({energy_of(Wells(NewtonProblem::rest(), 10, 0))});  // at the minimum of a bowl
  EquilibriumCheck check(problem.iterate, p);
  for (const double decrement : {1.0, 1e-4, 1e-4}) {
    CHECK(!check.in_tolerance());
    check.note_decrement(decrement);
    ++problem.result.iterations;
  }
  CHECK(!check.in_tolerance());
  EquilibriumCheck restored(problem.iterate, p);
  restored.restore(check.state());
  CHECK(!restored.in_tolerance());
  for (EquilibriumCheck* each : {&check, &restored}) {
    each->note_decrement(1e-4);
    CHECK(each->in_tolerance());
  }
  restored.restart();  // for another objective, to which earlier decrements say nothing
  CHECK(!restored.in_tolerance());
  problem.move_to(NewtonProblem::rest().array() + 0.1);
  CHECK(!check.in_tolerance());
}

#include "core/numerics/step/equilibrium_check.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/newton_problem.h"
#include "tests/support/wells.h"

using namespace drape;

namespace {

/// At the minimum of a bowl.
NewtonProblem at_minimum() { return NewtonProblem({std::make_shared<Wells>(NewtonProblem::rest(), 10, 0)}); }

}  // namespace

TEST_CASE("The tolerances ask for a small residual, and for three small decrements if they are limited") {
  NewtonParameters p;
  p.decrement_tolerance = 1e-3;
  NewtonProblem problem = at_minimum();
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

TEST_CASE("The drift is the displacement of the free vertices' centroid, in diagonals of the sheet") {
  const NewtonParameters p;
  NewtonProblem problem = at_minimum();
  EquilibriumCheck check(problem.iterate, p);
  check.restart_drift();
  CHECK(check.drift() == 0);
  Positions x = NewtonProblem::rest();
  x.col(0).array() += 3;
  problem.move_to(x);
  CHECK(check.drift() == Approx(3 / std::sqrt(2.0)));
  EquilibriumCheck restored(problem.iterate, p);
  restored.restore(check.state());
  CHECK(restored.drift() == check.drift());
  check.restart_drift();
  CHECK(check.drift() == 0);
}

TEST_CASE("Forces within their round-off bounds are at the rounding floor, which restarts the idle steps") {
  const NewtonParameters p;
  NewtonProblem problem({std::make_shared<Wells>(NewtonProblem::rest(), 1e7, 0.1)});
  EquilibriumCheck check(problem.iterate, p);
  FactorCache factor(problem.iterate, p);
  Positions x = NewtonProblem::rest();
  x.col(2).array() += 0.1 + 1e-6;
  problem.move_to(x);
  for (int k = 0; k < 11; ++k) {
    CHECK(!check.is_idle());
    check.note_step(0);
  }
  CHECK(check.is_idle());
  CHECK(!check.is_at_rounding_floor(factor));
  CHECK(!check.is_idle());

  x.col(2) = NewtonProblem::rest().col(2).array() + 0.1;
  problem.move_to(x);
  CHECK(check.is_at_rounding_floor(factor));
  CHECK(check.rounding_residual() > 0);
}

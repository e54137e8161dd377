#include "core/numerics/step/implicit_step.h"

#include <catch2/catch.hpp>

#include "tests/support/evaluate.h"
#include "tests/support/newton_problem.h"
#include "tests/support/test_energies.h"

using namespace drape;

TEST_CASE("The gradient of an implicit step is that of its energy, without fixed vertices") {
  const Positions rest = NewtonProblem::rest();
  NewtonProblem problem({energy_of(Wells(rest.array() + 0.3, 10, 0.1))}, {{0, rest.row(0), 0}});
  ImplicitStep step;
  step.begin(rest, 4);
  CHECK(step.max_iterations() == 4);
  Positions x = rest;
  x.bottomRows(15) += 0.1 * Positions::Random(15, 3);
  problem.move_to(x);
  const double inverse_h2 = 100;
  step.evaluate(problem.iterate, inverse_h2);

  const auto energy = [&](const Positions& y) {
    return problem.model.value(y) + step.inertia_at(y, problem.model.masses());
  };
  REQUIRE(step.gradient().norm() > 0);
  CHECK(step.gradient().row(0).norm() == 0);
  const Eigen::MatrixXd slopes = differences(energy, x, 1e-5);
  for (const int vertex : {1, 7, 15})
    for (int c = 0; c < 3; ++c)
      CHECK(step.gradient()(vertex, c) == Approx(slopes(0, 3 * vertex + c)).epsilon(1e-6));

  CHECK(step.inertia() > 0);
  CHECK(step.inertia_at(x, problem.model.masses()) == Approx(step.inertia()));
  CHECK(step.inertia_at(rest, problem.model.masses()) == 0);
  CHECK(step.gradient_norm_at(x, problem.iterate.gradient(), problem.iterate) ==
        Approx(step.gradient().norm()));
}

#include "core/numerics/step/line_search.h"

#include <catch2/catch.hpp>

#include "tests/support/newton_problem.h"
#include "tests/support/test_energies.h"

using namespace drape;

namespace {

/// Wells on top of a large constant, against which changes of the energy are round-off.
struct HighWells : Wells {
  using Wells::Wells;
  double value(const Positions& x) const override { return 1e6 + Wells::value(x); }
};

/// Forces that push uphill.
struct WrongForces : Wells {
  using Wells::Wells;
  double add_gradient(const Positions& x, Positions& g) const override {
    Positions own = Positions::Zero(g.rows(), 3);
    const double energy = Wells::add_gradient(x, own);
    g -= own;
    return energy;
  }
};

Positions centres() { return NewtonProblem::rest().array() + 0.3; }

/// A search in the static form, where the step's energy is F.
struct Search {
  NewtonProblem problem;
  ImplicitStep step;
  LineSearch line_search;

  Search() : Search({energy_of(Wells(centres(), 10, 0))}) {}
  explicit Search(const std::vector<std::shared_ptr<Energy>>& energies) : problem(energies) {}

  bool along(const Positions& direction, double inverse_h2 = 0) {
    step.begin(problem.iterate.x(), 1);
    step.evaluate(problem.iterate, inverse_h2);
    return line_search.search(problem.iterate, step, direction);
  }
  Positions to_centres() const { return centres() - problem.iterate.x(); }
};

}  // namespace

TEST_CASE("A full step that decreases the energy is taken, with the energy and forces at its end") {
  Search s;
  const Positions x = s.problem.iterate.x(), direction = 0.5 * s.to_centres();
  REQUIRE(s.along(direction));
  CHECK(s.line_search.step_length() == 1);
  CHECK(s.line_search.slope() < 0);
  CHECK(s.problem.iterate.x() == x + direction);
  CHECK(s.problem.iterate.limited_by() == "");
  Positions g;
  CHECK(s.problem.iterate.energy() == s.problem.objective.gradient(x + direction, g));
  CHECK(s.problem.iterate.gradient() == g);
}

TEST_CASE("A step that overshoots is halved until the decrease is sufficient, inertia counted") {
  const auto step_length = [](double factor, double inverse_h2 = 0) {
    Search s;
    REQUIRE(s.along(factor * s.to_centres(), inverse_h2));
    return s.line_search.step_length();
  };
  CHECK(step_length(3.9) == 0.5);
  CHECK(step_length(3.9999) == 0.25);  // half decreases the energy by 2e-4 of it, Armijo asks for 8e-4
  CHECK(step_length(0.5) == 1);
  CHECK(step_length(0.5, 1e4) < 1);
}

TEST_CASE("No step is taken uphill, or where no step length decreases the energy") {
  Search uphill;
  const Positions x = uphill.problem.iterate.x();
  const double energy = uphill.problem.iterate.energy();
  REQUIRE(!uphill.along(-uphill.to_centres()));
  CHECK(uphill.line_search.slope() > 0);
  CHECK(uphill.line_search.step_length() == 1);
  CHECK(uphill.problem.iterate.x() == x);

  Search wrong({energy_of(WrongForces(centres(), 10, 0))});
  REQUIRE(!wrong.along(-0.1 * wrong.problem.iterate.gradient()));
  CHECK(wrong.line_search.slope() < 0);
  CHECK(wrong.line_search.step_length() < LineSearch::min_step_length);
  CHECK(wrong.problem.iterate.x() == x);
  CHECK(wrong.problem.iterate.energy() == energy);
}

TEST_CASE("The search starts from the largest step that a limit allows, and names the limit") {
  Search s({energy_of(Wells(centres(), 10, 0)), energy_of(Limiter(0.3), EnergyRole::limit)});
  const Positions x = s.problem.iterate.x(), direction = s.to_centres();
  REQUIRE(s.along(direction));
  CHECK(s.line_search.step_length() == 0.3);
  CHECK((s.problem.iterate.x() - x - 0.3 * direction).norm() < 1e-15);
  CHECK(s.problem.iterate.limited_by() == "the limiter");
  REQUIRE_FALSE(s.along(s.problem.iterate.gradient()));
  CHECK(s.problem.iterate.limited_by().empty());
}

TEST_CASE("Where the energy changes by round-off only, the gradient's norm decides") {
  const double width = 0.1, off = 1e-9;
  Positions x = centres();
  x.col(2).array() += width + off;
  Positions towards = Positions::Zero(x.rows(), 3);
  towards.col(2).setConstant(-off);
  for (const double overshoot : {1.0, 3.0}) {
    Search s({energy_of(HighWells(centres(), 1, width))});
    s.problem.move_to(x);
    const double energy = s.problem.iterate.energy(), norm = s.problem.iterate.gradient().norm();
    REQUIRE(norm > 0);
    REQUIRE(s.along(overshoot * towards));
    CHECK(s.line_search.step_length() == (overshoot == 1 ? 1 : 0.5));
    CHECK(s.problem.iterate.energy() == energy);
    CHECK(s.problem.iterate.gradient().norm() < norm);
  }
}

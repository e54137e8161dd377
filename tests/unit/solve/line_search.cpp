#include "core/numerics/step/line_search.h"

#include <catch2/catch.hpp>

#include "tests/support/evaluate.h"
#include "tests/support/newton_problem.h"
#include "tests/support/test_energies.h"

using namespace drape;

namespace {

/// Wells on top of a constant, whose forces are multiplied by a factor.
struct FalseWells : Wells {
  double constant, factor;
  FalseWells(const Wells& wells, double constant, double factor)
      : Wells(wells), constant(constant), factor(factor) {}
  double value(const Positions& x) const override { return constant + Wells::value(x); }
  double add_gradient(const Positions& x, Positions& g) const override {
    Positions own = Positions::Zero(g.rows(), 3);
    Wells::add_gradient(x, own);
    g += factor * own;
    return value(x);
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

TEST_CASE("A step is full, or halved until the decrease is sufficient, inertia counted") {
  const auto step_length = [](double factor, double inverse_h2 = 0) {
    Search s;
    REQUIRE(s.along(factor * s.to_centres(), inverse_h2));
    CHECK(s.line_search.slope() < 0);
    Positions g;
    CHECK(s.problem.iterate.energy() == s.problem.objective.gradient(s.problem.iterate.x(), g));
    CHECK(s.problem.iterate.gradient() == g);
    return s.line_search.step_length();
  };
  CHECK(step_length(3.9) == 0.5);
  CHECK(step_length(3.9999) == 0.25);  // half decreases the energy by 2e-4 of it, Armijo asks for 8e-4
  CHECK(step_length(0.5) == 1);
  CHECK(step_length(0.5, 1e4) < 1);
}

TEST_CASE("No step is taken uphill, or where no step length decreases the energy") {
  for (const bool uphill : {true, false}) {
    Search s({energy_of(FalseWells({centres(), 10, 0}, 0, uphill ? 1 : -1))});
    const Positions x = s.problem.iterate.x();
    const double energy = s.problem.iterate.energy();
    REQUIRE(!s.along(-0.1 * s.to_centres()));
    CHECK((s.line_search.slope() > 0) == uphill);
    CHECK((s.line_search.step_length() < LineSearch::min_step_length) == !uphill);
    CHECK(s.problem.iterate.x() == x);
    CHECK(s.problem.iterate.energy() == energy);
  }
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
  const Eigen::RowVector3d up(0, 0, 1);
  for (const double overshoot : {1.0, 3.0}) {
    Search s({energy_of(FalseWells({centres(), 1, width}, 1e6, 1))});
    s.problem.move_to(centres().rowwise() + (width + off) * up);
    const double energy = s.problem.iterate.energy(), norm = s.problem.iterate.gradient().norm();
    REQUIRE(norm > 0);
    REQUIRE(s.along((-overshoot * off * up).replicate(16, 1)));
    CHECK(s.line_search.step_length() == (overshoot == 1 ? 1 : 0.5));
    CHECK(s.problem.iterate.energy() == energy);
    CHECK(s.problem.iterate.gradient().norm() < norm);
  }
}

TEST_CASE("What counts as round-off of the energy grows with weight and length, as energies do") {
  const auto noise = [](double side) {
    const Level level = Level::of(0, grid({side, side}, 4, 4, Diagonals::one_way));
    const std::vector<NamedEnergy> at_rest = {{"wells", energy_of(Wells(level.rest.vertices, 1, 0))}};
    const LevelModel model(level, Material(), at_rest, {});
    PlainObjective objective(model);
    LevelResult result;
    Iterate iterate(objective, result);
    iterate.move_to(level.rest.vertices);
    iterate.set_constraints(model.fixed(), nullptr);
    iterate.evaluate();
    iterate.update_residual();
    return iterate.energy_noise(0);
  };
  CHECK(noise(10) == Approx(1000 * noise(1)));  // a hundred times the weight, ten times as far
}

TEST_CASE("The gradient of an implicit step is that of its energy, without fixed vertices") {
  const Positions rest = NewtonProblem::rest();
  NewtonProblem problem({energy_of(Wells(rest.array() + 0.3, 10, 0.1))}, {{0, rest.row(0), 0}});
  ImplicitStep step;
  step.begin(rest, 4);
  CHECK(step.max_iterations() == 4);
  Positions x = rest;
  x.bottomRows(15) += 0.1 * Positions::Random(15, 3);
  problem.move_to(x);
  step.evaluate(problem.iterate, 100);

  const Eigen::VectorXd& masses = problem.model.masses();
  const auto energy = [&](const Positions& y) { return problem.model.value(y) + step.inertia_at(y, masses); };
  REQUIRE(step.gradient().norm() > 0);
  CHECK(step.gradient().row(0).norm() == 0);
  const Eigen::VectorXd slopes = differences(energy, x, 1e-5).transpose();
  CHECK((slopes - flat(step.gradient())).tail(45).norm() <= 1e-6 * step.gradient().norm());
  CHECK(step.inertia() > 0);
  CHECK(step.inertia_at(x, masses) == Approx(step.inertia()));
  CHECK(step.inertia_at(rest, masses) == 0);
  CHECK(step.gradient_norm_at(x, problem.iterate.gradient(), problem.iterate) ==
        Approx(step.gradient().norm()));
}

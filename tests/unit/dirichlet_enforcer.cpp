#include "core/numerics/solve/dirichlet_enforcer.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/numerics/solve/dirichlet_predictor.h"
#include "tests/support/limiter.h"
#include "tests/support/newton_problem.h"
#include "tests/support/wells.h"

using namespace drape;

namespace {

const Eigen::Vector3d lift(0, 0, 0.1);

/// Two pins: vertex 0 is to be lifted, vertex 3 stays.
std::vector<DirichletVertex> pins() {
  return {{0, NewtonProblem::rest().row(0).transpose() + lift, 0}, {3, NewtonProblem::rest().row(3), 1}};
}

/// Σ k/2 ‖(x_a − x_b) − (X_a − X_b)‖² over a chain of all vertices: a quadratic energy that every rigid
/// translation leaves at 0.
class Chain : public Energy, public BoundEnergy {
 public:
  explicit Chain(bool broken = false) : broken_(broken), rest_(NewtonProblem::rest()) {}

  EnergyRole role() const override { return EnergyRole::membrane; }
  std::unique_ptr<BoundEnergy> bind(const Level&, const Material&) const override {
    return std::make_unique<Chain>(*this);
  }
  double value(const Positions& x) const override {
    double sum = 0;
    for (int i = 0; i < 15; ++i) sum += 0.5 * k * stretch(x, i).squaredNorm();
    return sum;
  }
  double add_gradient(const Positions& x, Positions& g) const override {
    for (int i = 0; i < 15; ++i) {
      g.row(i) += k * stretch(x, i);
      g.row(i + 1) -= k * stretch(x, i);
    }
    return value(x);
  }
  Stencils stencils() const override {
    Stencils s(15, 2);
    for (int i = 0; i < 15; ++i) s.row(i) << i, i + 1;
    return s;
  }
  void add_hessian(const Positions&, Projection, BlockSink& sink) const override {
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> h =
        (broken_ ? std::nan("") : k) * Eigen::Matrix<double, 3, 3, Eigen::RowMajor>::Identity();
    const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> minus = -h;
    for (int i = 0; i < 15; ++i) {
      sink.add(i, 0, 0, h.data());
      sink.add(i, 0, 1, minus.data());
      sink.add(i, 1, 1, h.data());
    }
  }

 private:
  static constexpr double k = 10;
  Eigen::RowVector3d stretch(const Positions& x, int i) const {
    return x.row(i) - x.row(i + 1) - rest_.row(i) + rest_.row(i + 1);
  }
  bool broken_;
  Positions rest_;
};

/// A predictor in the static form.
struct Prediction {
  NewtonProblem problem;
  NewtonParameters p = statics();
  EquilibriumCheck check{problem.iterate, p};
  NewtonStep step{problem.iterate, check, p, [](int) {}, [] { return false; }};
  DirichletEnforcer enforcer{problem.model};
  DirichletPredictor predictor;

  Prediction(const std::vector<std::shared_ptr<Energy>>& energies, std::vector<DirichletVertex> dirichlet,
             bool in_parts = false)
      : problem(energies, std::move(dirichlet)), predictor{enforcer, problem.iterate, step, in_parts} {}
  static NewtonParameters statics() {
    NewtonParameters p;
    p.form = NewtonForm::statics;
    return p;
  }
};

}  // namespace

TEST_CASE("Only Dirichlet vertices away from their targets are unsatisfied") {
  NewtonProblem problem({std::make_shared<Wells>(NewtonProblem::rest(), 10, 0)}, pins());
  DirichletEnforcer enforcer(problem.model);
  CHECK(!enforcer.active());
  enforcer.begin(NewtonProblem::rest());
  CHECK(enforcer.active());
  Positions expected = Positions::Zero(16, 3);
  expected.row(0) = lift.transpose();
  CHECK((enforcer.displacement_to_targets(NewtonProblem::rest()) - expected).norm() < 1e-15);
  CHECK(enforcer.max_violation(NewtonProblem::rest()) == Approx(0.1));
  CHECK(enforcer.fixed()[0] == 1);
  CHECK(enforcer.penalty() == nullptr);
  enforcer.set_satisfied();
  CHECK(!enforcer.active());
  CHECK(!enforcer.infeasible());
}

TEST_CASE("The penalty pulls released vertices to their targets and doubles") {
  NewtonProblem problem({std::make_shared<Wells>(NewtonProblem::rest(), 10, 0)}, pins());
  DirichletEnforcer enforcer(problem.model);
  enforcer.begin(NewtonProblem::rest());
  enforcer.begin_penalty("the post");
  CHECK(enforcer.fixed()[0] == 0);
  CHECK(enforcer.fixed()[3] == 1);
  REQUIRE(enforcer.penalty());
  const auto pull = [&] {
    Positions g = Positions::Zero(16, 3);
    enforcer.penalty()->add_gradient(NewtonProblem::rest(), g);
    CHECK(g.bottomRows(15).norm() == 0);
    return -g.row(0).dot(lift);
  };
  const double before = pull();
  CHECK(before > 0);
  CHECK(enforcer.increase_penalty(NewtonProblem::rest(), "the post"));
  CHECK(pull() == Approx(2 * before));
  enforcer.set_satisfied();
  CHECK(enforcer.penalty() == nullptr);
  CHECK(enforcer.fixed()[0] == 1);
}

TEST_CASE("Targets that doublings bring no nearer are infeasible, and named") {
  NewtonProblem problem({std::make_shared<Wells>(NewtonProblem::rest(), 10, 0)}, pins());
  DirichletEnforcer enforcer(problem.model);
  enforcer.begin(NewtonProblem::rest());
  enforcer.begin_penalty("the post");
  int doublings = 0;
  while (enforcer.increase_penalty(NewtonProblem::rest(), "the post")) {
    REQUIRE(++doublings < 100);
    // A restored enforcer is in the same state.
    DirichletEnforcer restored(problem.model);
    restored.restore(enforcer.state());
    CHECK(restored.fixed() == enforcer.fixed());
    CHECK(restored.penalty()->value(NewtonProblem::rest()) ==
          enforcer.penalty()->value(NewtonProblem::rest()));
  }
  CHECK(doublings >= 4);
  CHECK(enforcer.infeasible());
  CHECK(!enforcer.active());
  CHECK(enforcer.fixed()[0] == 1);
  CHECK(enforcer.message(NewtonProblem::rest()) ==
        "pin 0 stopped 0.1 m short of its target (vertex 0), blocked by the post");
}

TEST_CASE("The predictor moves the whole cloth by its linearised response") {
  std::vector<DirichletVertex> both = pins();
  both[1].target += lift;
  Prediction c({std::make_shared<Chain>()}, both);
  c.predictor.enforce();
  CHECK(!c.enforcer.active());
  const Positions moved = c.problem.iterate.x() - NewtonProblem::rest();
  CHECK(c.problem.iterate.x().row(0) == both[0].target.transpose());
  CHECK((moved.rowwise() - lift.transpose()).norm() < 1e-12);
  CHECK(c.problem.iterate.gradient().norm() < 1e-11);  // evaluated there
}

TEST_CASE("Where a limit blocks the motion, the cloth moves as far as it may and the penalty takes over") {
  Prediction c({std::make_shared<Chain>(), std::make_shared<Limiter>(0.25)}, pins());
  c.predictor.enforce();
  CHECK(c.enforcer.active());
  CHECK(c.enforcer.penalty());
  CHECK(c.problem.iterate.fixed()[0] == 0);
  CHECK((c.problem.iterate.x() - NewtonProblem::rest()).row(0).norm() == Approx(0.025));
  CHECK(c.problem.iterate.limited_by() == "the limiter");

  // Near equilibrium only the whole motion counts.
  const Positions x = c.problem.iterate.x();
  c.predictor.increase_penalty();
  CHECK(c.problem.iterate.x() == x);
  CHECK(c.enforcer.active());
}

TEST_CASE("In parts, pins that a limit stops are held and move on") {
  Prediction c({std::make_shared<Chain>(), std::make_shared<Limiter>(0.25)}, pins(), true);
  c.predictor.enforce();
  CHECK(c.enforcer.is_moving());
  CHECK(!c.enforcer.penalty());
  CHECK(c.problem.iterate.fixed()[0] == 1);
  CHECK(c.enforcer.max_violation(c.problem.iterate.x()) == Approx(0.075));

  // A restored enforcer is held as well.
  DirichletEnforcer restored(c.problem.model);
  restored.restore(c.enforcer.state());
  CHECK(restored.is_moving());
  CHECK(restored.fixed() == c.enforcer.fixed());

  for (int k = 0; k < 20; ++k) c.predictor.move_on();
  CHECK(c.enforcer.is_moving());
  CHECK(c.enforcer.max_violation(c.problem.iterate.x()) == Approx(0.1 * std::pow(0.75, 21)));

  // Where progress has stopped for another reason, the penalty takes over.
  c.predictor.increase_penalty();
  CHECK(c.enforcer.penalty());
  CHECK(!c.enforcer.is_moving());
}

TEST_CASE("In parts, the penalty takes over from moves that gain nothing") {
  Prediction c({std::make_shared<Chain>(), std::make_shared<Limiter>(1e-3)}, pins(), true);
  c.predictor.enforce();
  int moves = 1;
  for (; c.enforcer.is_moving(); ++moves) {
    REQUIRE(moves < 10);
    c.predictor.move_on();
  }
  CHECK(moves == 4);
  CHECK(c.enforcer.penalty());
  CHECK(c.enforcer.state().idle == 0);
  CHECK(c.problem.iterate.fixed()[0] == 0);
}

TEST_CASE("The inertia of short steps does not hold the cloth back where pins move on") {
  std::vector<DirichletVertex> both = pins();
  both[1].target += lift;
  Prediction c({std::make_shared<Chain>(), std::make_shared<Limiter>(0.25)}, both, true);
  c.p.form = NewtonForm::quasistatic;
  c.p.step_size = 1e-6;
  NewtonStep step(
      c.problem.iterate, c.check, c.p, [](int) {}, [] { return false; });
  DirichletPredictor predictor(c.enforcer, c.problem.iterate, step, true);
  const auto moved = [&] { return (c.problem.iterate.x() - NewtonProblem::rest()).row(10).norm(); };
  predictor.enforce();
  CHECK(moved() < 1e-6);
  predictor.move_on();
  CHECK(moved() > 0.01);
}

TEST_CASE("Without a factor nothing moves, and the cache says why") {
  Prediction c({std::make_shared<Chain>(true)}, pins());
  c.predictor.enforce();
  CHECK(c.problem.iterate.x() == NewtonProblem::rest());
  CHECK_THAT(c.step.factor().fault(), Catch::Contains("not finite"));
}

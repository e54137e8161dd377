#include "core/numerics/solve/newton.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/kernel/files/message_text.h"
#include "core/numerics/patterns/generate.h"
#include "core/numerics/solve/newton_state.h"
#include "tests/support/fake_loads.h"
#include "tests/support/keeping_observer.h"
#include "tests/support/test_energies.h"

using namespace drape;

namespace {

/// An energy with a NaN in its Hessian at one vertex.
struct BrokenHessian : Wells {
  BrokenHessian(const Positions& centres, int vertex) : Wells(centres, 10, 0.4), broken(vertex) {}
  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override {
    Wells::add_hessian(x, projection, sink);
    double block[9] = {};
    block[4] = std::nan("");
    sink.add(broken, 0, 0, block);
  }
  int broken;
};

/// Wells in which no vertex but the first may leave its place: no step that moves another one has an energy.
struct Frozen : Wells {
  Frozen(const Positions& centres, const Positions& at) : Wells(centres, 10, 0), place(at) {}
  double value(const Positions& x) const override {
    return x.bottomRows(15) == place.bottomRows(15) ? Wells::value(x)
                                                    : std::numeric_limits<double>::infinity();
  }
  Positions place;
};

/// Allows half of the first motion and all others.
struct LimitsOnce : NoEnergy {
  StepLimit max_step(const Positions&, const Positions&) const override {
    return asked++ == 0 ? StepLimit{0.5, "the limiter"} : StepLimit();
  }
  mutable int asked = 0;
};

const std::vector<NamedEnergy> only_weight = {{"weight", energy_of(Weight(), EnergyRole::external)}};

/// Minimisations that begin at the rest shape of a sheet of 4×4 vertices.
struct NewtonCase {
  Level level = Level::of(0, grid({1, 1}, 4, 4, Diagonals::one_way));
  Positions centres = level.rest.vertices.array() + 0.3;
  KeepingObserver observer;

  /// One with its first vertex held.
  LevelResult solve(const NewtonParameters& p, double width = 0) {
    return solve(p, {{"wells", energy_of(Wells(centres, 10, width))}}, pinned());
  }
  LevelResult solve(const NewtonParameters& p, const std::vector<NamedEnergy>& energies,
                    const std::vector<DirichletVertex>& dirichlet = {}) {
    const LevelModel model(level, Material(), energies, dirichlet);
    PlainObjective objective(model);
    return minimise(objective, level.rest.vertices, p, {Stopwatch(), observer});
  }
  /// The first vertex, whose target is this far above it.
  std::vector<DirichletVertex> pinned(double lift = 0) const {
    return {{0, level.rest.vertices.row(0).transpose() + Eigen::Vector3d(0, 0, lift), 0}};
  }
};

constexpr double tight = 1e-9;  // as force_tolerance

}  // namespace

TEST_CASE("Newton finds the ring of minima around a hump, in both forms and with any projection",
          "[newton]") {
  for (NewtonForm form : {NewtonForm::quasistatic, NewtonForm::statics})
    for (Projection::Kind projection : {Projection::clamp, Projection::none}) {
      NewtonCase c;
      c.centres = c.level.rest.vertices.array() + 0.05;  // the start is on the hump
      const LevelResult r =
          c.solve({.form = form, .step_growth = 2, .force_tolerance = tight, .projection = projection}, 0.4);
      CAPTURE(int(form), int(projection), r.message);
      REQUIRE(r.outcome == Outcome::converged);
      REQUIRE(r.force_residual <= 1e-9);
      for (int i = 1; i < 16; ++i) REQUIRE((r.x - c.centres).row(i).norm() == Approx(0.4).epsilon(1e-4));
      REQUIRE(r.x.row(0) == c.level.rest.vertices.row(0));
    }
}

TEST_CASE("Energy never rises from one implicit step to the next", "[newton]") {
  NewtonCase c;
  c.solve({.step_size = 0.05, .force_tolerance = tight}, 0.4);
  REQUIRE(c.observer.rows.size() > 3);
  for (std::size_t i = 1; i < c.observer.rows.size(); ++i)
    REQUIRE(c.observer.rows[i].energy <= c.observer.rows[i - 1].energy * (1 + 1e-12) + 1e-15);
}

TEST_CASE("The decrement is the mean speed of the step", "[newton]") {
  NewtonCase c;
  const LevelResult r = c.solve({.step_size = 0.2, .max_steps = 1, .force_tolerance = tight});
  const double alpha = c.observer.rows.at(0).step_length;
  const double moved = (r.x - c.level.rest.vertices).norm();
  REQUIRE(moved > 1e-3);
  REQUIRE(r.decrement == Approx(moved / alpha / (0.2 * std::sqrt(15.0))));
}

TEST_CASE("The decrement is that of the first step size, or a bound of it, whatever h has become",
          "[newton]") {
  // Otherwise a tolerance of decrements would get looser as h grows, and be met because h has shrunk.
  struct : KeepingObserver {
    std::vector<Positions> x;
    void iteration(const IterationRow& row, const Positions& at) override {
      KeepingObserver::iteration(row, at);
      x.push_back(at);
    }
  } observer;
  const NewtonParameters p = {.step_size = 3, .step_growth = 3, .max_steps = 20, .force_tolerance = tight};
  NewtonCase c;
  c.centres = c.level.rest.vertices.array() + 0.05;  // the start is on the hump, where steps are cut
  const LevelModel model(c.level, Material(), {{"wells", energy_of(Wells(c.centres, 10, 0.4))}}, c.pinned());
  PlainObjective objective(model);
  minimise(objective, c.level.rest.vertices, p, {Stopwatch(), observer});
  int longer = 0, shorter = 0;
  for (std::size_t k = 1; k < observer.rows.size(); ++k) {
    const IterationRow& row = observer.rows[k];
    const double length = (observer.x[k] - observer.x[k - 1]).norm() / row.step_length / std::sqrt(15.0);
    const double ratio = p.step_size / row.step_size;
    CHECK(row.decrement == Approx(length / p.step_size * std::max(1.0, ratio * ratio)));
    ++(ratio < 1 ? longer : shorter);
  }
  CHECK(longer > 0);
  CHECK(shorter > 0);
}

TEST_CASE("The step size stays the same within an implicit step, and altogether without growth", "[newton]") {
  NewtonCase several;
  several.solve({.iterations_per_step = 3, .force_tolerance = tight}, 0.4);
  int within = 0, between = 0;
  const auto& rows = several.observer.rows;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const bool same = rows[i].step_size == rows[i - 1].step_size;
    if (rows[i].step == rows[i - 1].step) {
      ++within;
      REQUIRE(same);
    } else {
      between += !same;
    }
  }
  REQUIRE(within > 3);
  REQUIRE(between > 0);

  NewtonCase constant;
  const double size = 2 * StepController::max_step_size;
  constant.solve({.step_size = size, .step_growth = 1, .force_tolerance = tight}, 0.4);
  REQUIRE(constant.observer.rows.size() > 2);
  for (const IterationRow& row : constant.observer.rows) REQUIRE(row.step_size == size);
}

TEST_CASE(
    "A Newton matrix with NaN ends the level as stalled, names the vertex and a pin short of its target",
    "[newton]") {
  for (const NewtonForm form : {NewtonForm::quasistatic, NewtonForm::statics})
    for (const PsdBlend blend : {PsdBlend::adaptive, PsdBlend::full})
      for (const double lift : {0.0, 0.1}) {  // of the pin's target: the predictor needs a factor too
        NewtonCase c;
        const LevelResult r = c.solve({.form = form, .force_tolerance = tight, .psd_blend = blend},
                                      {{"broken", energy_of(BrokenHessian(c.centres, 5))}}, c.pinned(lift));
        CAPTURE(int(form), int(blend), lift);
        CHECK(r.outcome == Outcome::stalled);
        CHECK(r.message ==
              std::string("the Newton matrix holds entries that are not finite, first in the block of vertex "
                          "5") +
                  (lift > 0 ? "; pin 0 stopped 0.1 m short of its target (vertex 0)" : ""));
        CHECK(r.x == c.level.rest.vertices);
        CHECK(r.iterations == 0);
      }
}

TEST_CASE("NaN in the Hessian at a fixed vertex is not part of the Newton matrix", "[newton]") {
  NewtonCase c;
  const LevelResult r =
      c.solve({.force_tolerance = tight}, {{"broken", energy_of(BrokenHessian(c.centres, 0))}}, c.pinned());
  INFO(r.message);
  CHECK(r.outcome == Outcome::converged);
}

TEST_CASE("A stop ends an implicit step between its iterations", "[newton]") {
  NewtonCase stopped;
  stopped.observer.stop_after = 3;
  const LevelResult r = stopped.solve({.iterations_per_step = 1000, .force_tolerance = tight}, 0.4);
  CHECK(r.outcome == Outcome::cancelled);
  CHECK(r.iterations == 3);
  CHECK(r.steps <= 1);
}

TEST_CASE("An implicit step ends when it is solved, whatever its iterations; a level ends at max_steps",
          "[newton]") {
  NewtonCase patient;
  const LevelResult r = patient.solve({.step_size = 0.01,
                                       .step_growth = 1,
                                       .iterations_per_step = 50,
                                       .max_steps = 20,
                                       .force_tolerance = tight},
                                      0.4);
  REQUIRE(r.outcome == Outcome::max_steps_reached);  // strong damping: not yet converged
  CHECK(r.steps == 20);
  CHECK_THAT(r.message, Catch::Contains("max_steps = 20"));
  for (const IterationRow& row : patient.observer.rows) {
    REQUIRE(row.step_size == 0.01);
    REQUIRE(row.iteration < 10);
  }
}

TEST_CASE("A level that ends without descent names what limits the step", "[newton]") {
  for (const NewtonForm form : {NewtonForm::quasistatic, NewtonForm::statics}) {
    NewtonCase c;
    const LevelResult r = c.solve(
        {.form = form, .force_tolerance = tight},
        {{"wells", energy_of(Wells(c.centres, 10, 0))}, {"limit", energy_of(Limiter(0), EnergyRole::limit)}});
    CHECK(r.outcome == Outcome::stalled);
    CHECK_THAT(r.message, Catch::StartsWith("the line search found no descent") &&
                              Catch::EndsWith("; the step is limited by the limiter"));
  }
}

TEST_CASE("A cloth that nothing holds is detected, in both forms and within an implicit step", "[newton]") {
  // Constant forces on a cloth without pins: it falls without end.
  for (const auto& [form, iterations] :
       {std::pair(NewtonForm::quasistatic, 1), {NewtonForm::statics, 1}, {NewtonForm::statics, 1000}}) {
    NewtonCase c;
    const LevelResult r = c.solve({.form = form, .iterations_per_step = iterations}, only_weight);
    CAPTURE(int(form), iterations, r.steps);
    CHECK(r.outcome == Outcome::infeasible);
    const double drift = (r.x - c.level.rest.vertices).colwise().mean().norm();
    CHECK_THAT(r.message,
               Catch::StartsWith("nothing holds the cloth within 100 of its diagonals: it has drifted by ") &&
                   Catch::Contains(" of them, " + three_digits(drift) + " m, and does not come to rest"));
    CHECK(r.iterations < 100);
  }
}

TEST_CASE("A cloth that is pinned and falls without end has an energy that is unbounded below", "[newton]") {
  NewtonCase c;
  const LevelResult r = c.solve({}, only_weight, c.pinned());
  CHECK(r.outcome == Outcome::infeasible);
  CHECK_THAT(r.message, Catch::StartsWith("its pins or springs do not hold the cloth within 100 of its ") &&
                            Catch::Contains("; an energy that is unbounded below has no state of rest: "));
}

TEST_CASE("A cloth without any force is at equilibrium: the residual scale has a lower bound") {
  NewtonCase c;
  c.centres = c.level.rest.vertices;  // the Dirichlet vertex is at its target
  c.centres.bottomRows(15).array() += 0.01;
  c.centres(0, 2) += 1e-12;  // but for round-off
  const LevelModel model(c.level, Material(), {{"bowl", energy_of(Wells(c.centres, 10, 0))}}, c.pinned());
  PlainObjective objective(model);
  const LevelResult r =
      minimise(objective, c.level.rest.vertices, {.max_steps = 300}, {Stopwatch(), c.observer});
  CAPTURE(r.message, r.steps);
  CHECK(r.outcome == Outcome::converged);
  const double weight = 9.81 * model.masses().tail(15).norm();
  CHECK(model.residual_scale(r.x, Positions::Zero(16, 3)) == Approx(1e-3 * weight));
}

TEST_CASE("A minimisation resumed at any step continues bit for bit", "[newton]") {
  const LinearSolver solver = GENERATE(LinearSolver::mixed, LinearSolver::supernodal, LinearSolver::cholmod);
  for (const int iterations : {1, 2})
    for (const NewtonForm form : {NewtonForm::quasistatic, NewtonForm::statics}) {
      const NewtonParameters p{.form = form,
                               .iterations_per_step = iterations,
                               .force_tolerance = tight,
                               .decrement_tolerance = 1e-7,
                               .linear_solver = solver};
      NewtonCase c;
      c.centres = c.level.rest.vertices.array() + 0.05;
      const LevelModel model(c.level, Material(), {{"wells", energy_of(Wells(c.centres, 10, 0.4))}},
                             c.pinned());
      KeepingObserver whole;
      whole.keeps_states = true;
      LevelResult before;
      before.seconds = 2;
      before.seconds_by_phase = {{"before", 2}};
      PlainObjective first(model);
      const LevelResult expected =
          minimise(first, c.level.rest.vertices, p, {Stopwatch(), whole, false, before});
      CAPTURE(int(solver), iterations, int(form), expected.message);
      REQUIRE(expected.outcome == Outcome::converged);
      REQUIRE(whole.states.size() > 4);
      for (const NewtonState& state : whole.states) {
        PlainObjective again(model);
        KeepingObserver rest;
        const LevelResult r = minimise(again, {}, p, {Stopwatch(), rest, false, {}, &state});
        REQUIRE(r.x == expected.x);
        REQUIRE(r.force_residual == expected.force_residual);
        REQUIRE(r.decrement == expected.decrement);
        REQUIRE(r.iterations == expected.iterations);
        REQUIRE(r.factorisations == expected.factorisations);
        REQUIRE(r.analyses == expected.analyses);
        REQUIRE(r.flops == expected.flops);
        REQUIRE(r.seconds > 2);
        REQUIRE(r.seconds_by_phase.at("before") == 2);
        REQUIRE(rest.rows.size() + state.so_far.iterations == whole.rows.size());
        for (std::size_t i = 0; i < rest.rows.size(); ++i) {
          const IterationRow &a = rest.rows[i], &b = whole.rows[state.so_far.iterations + i];
          REQUIRE(a.energy == b.energy);
          REQUIRE(a.step == b.step);
          REQUIRE(a.step_size == b.step_size);
          REQUIRE(a.step_length == b.step_length);
          REQUIRE(a.force_residual == b.force_residual);
        }
      }
    }
}

TEST_CASE("The energy of a row is the level's own, without the penalty of pins under way") {
  struct Kept : Observer {
    void iteration(const IterationRow& row, const Positions& x) override {
      energies.push_back(row.energy);
      states.push_back(x);
    }
    std::vector<double> energies;
    std::vector<Positions> states;
  } kept;
  NewtonCase c;
  const LevelModel model(
      c.level, Material(),
      {{"wells", energy_of(Wells(c.centres, 10, 0))}, {"limit", energy_of(Limiter(0.5), EnergyRole::limit)}},
      c.pinned(0.1));
  PlainObjective objective(model);
  minimise(objective, c.level.rest.vertices, {.max_steps = 5}, {Stopwatch(), kept});
  REQUIRE(kept.states.size() > 2);
  for (std::size_t k = 0; k < kept.states.size(); ++k)
    CHECK(kept.energies[k] == Approx(model.energy(kept.states[k])));
}

TEST_CASE("A step without descent is no equilibrium although the pins reach their targets after it") {
  NewtonCase c;
  c.centres.row(0).array() += 1;  // the pin carries far more than the free vertices lack
  const std::vector<DirichletVertex> pins = c.pinned(0.1);
  const LevelModel model(c.level, Material(),
                         {{"wells", energy_of(Frozen(c.centres, c.level.rest.vertices))},
                          {"limit", energy_of(LimitsOnce(), EnergyRole::limit)}},
                         pins);
  PlainObjective objective(model);
  FakeLoads loads;
  loads.increments = 0;  // a schedule at its end
  const Stopwatch clock;
  LevelRun run{clock, c.observer};
  run.load_stepping = &loads;
  const LevelResult r = minimise(objective, c.level.rest.vertices, {.force_tolerance = tight}, run);
  INFO(r.message);
  CHECK(r.x.row(0) == pins[0].target.transpose());
  CHECK(r.outcome == Outcome::stalled);
  CHECK_THAT(r.message, Catch::StartsWith("the line search found no descent"));
}

TEST_CASE("A cloth that rests where its load vanishes is at equilibrium") {
  NewtonCase c;
  c.centres = c.level.rest.vertices;
  c.centres.bottomRows(15).array() += 0.01;
  const LevelResult r = c.solve(
      {.max_steps = 300}, {{"well", energy_of(Wells(c.centres, 10, 0), EnergyRole::external)}}, c.pinned());
  INFO(r.message);
  CHECK(r.outcome == Outcome::converged);
}

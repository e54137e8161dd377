#include "core/numerics/solve/newton.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <set>

#include "core/kernel/files/message_text.h"
#include "core/numerics/patterns/generate.h"
#include "core/numerics/solve/newton_state.h"
#include "tests/support/fake_loads.h"
#include "tests/support/test_energies.h"
#include "tests/unit/solve/resumed.h"

using namespace drape;

namespace {

/// Wells in which no vertex but the first may leave its place: no step that moves another one has an energy.
struct Frozen : Wells {
  Frozen(const Positions& centres, const Positions& at) : Wells(centres, 10, 0), place(at) {}
  double value(const Positions& x) const override {
    return x.bottomRows(15) == place.bottomRows(15) ? Wells::value(x) : HUGE_VAL;
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

struct StateKeeper : KeepingObserver {
  std::vector<Positions> x;
  void iteration(const IterationRow& row, const Positions& at) override {
    KeepingObserver::iteration(row, at);
    x.push_back(at);
  }
};

/// A minimisation that begins at the rest shape of a sheet of 4×4 vertices.
struct NewtonCase {
  Level level = Level::of(0, grid({1, 1}, 4, 4, Diagonals::one_way));
  const Positions& rest = level.rest.vertices;
  Positions centres;
  std::unique_ptr<LevelModel> model;
  StateKeeper observer;

  explicit NewtonCase(double to_centres = 0.3) : centres(rest.array() + to_centres) {}

  Wells wells(double width = 0) const { return {centres, 10, width}; }
  /// Wells with NaN in the Hessian at one vertex.
  std::vector<NamedEnergy> broken(int vertex) const {
    return {{"wells", energy_of(wells(0.4))},
            {"broken", energy_of(PairSprings({{vertex, -1, std::nan("")}}))}};
  }
  NamedEnergy limit(double allowed) const {
    return {"limit", energy_of(Limiter(allowed), EnergyRole::limit)};
  }
  /// The first vertex, whose target is this far above it.
  std::vector<DirichletVertex> pinned(double lift = 0) const {
    return {{0, rest.row(0).transpose() + Eigen::Vector3d(0, 0, lift), 0}};
  }
  /// In wells, with the first vertex held.
  LevelResult solve(const NewtonParameters& p, double width = 0) {
    return solve(p, {{"wells", energy_of(wells(width))}}, pinned());
  }
  LevelResult solve(const NewtonParameters& p, const std::vector<NamedEnergy>& energies,
                    const std::vector<DirichletVertex>& dirichlet = {}, LoadStepping* loads = nullptr) {
    model = std::make_unique<LevelModel>(level, Material(), energies, dirichlet);
    PlainObjective objective(*model);
    return minimise(objective, rest, p, {.clock = Stopwatch(), .observer = observer, .load_stepping = loads});
  }
};

constexpr NewtonForm forms[] = {NewtonForm::quasistatic, NewtonForm::statics};
constexpr double tight = 1e-9;    // as force_tolerance
constexpr double on_hump = 0.05;  // from the start to the centres of wells of width 0.4
const std::vector<NamedEnergy> only_weight = {{"weight", energy_of(Weight(), EnergyRole::external)}};

}  // namespace

TEST_CASE("Newton finds the ring of minima around a hump, in both forms and with any projection") {
  for (const NewtonForm form : forms)
    for (const Projection::Kind projection : {Projection::clamp, Projection::none}) {
      NewtonCase c(on_hump);
      const LevelResult r =
          c.solve({.form = form, .step_growth = 2, .force_tolerance = tight, .projection = projection}, 0.4);
      CAPTURE(int(form), int(projection), r.message);
      REQUIRE(r.outcome == Outcome::converged);
      REQUIRE(r.force_residual <= 1e-9);
      for (int i = 1; i < 16; ++i) REQUIRE((r.x - c.centres).row(i).norm() == Approx(0.4).epsilon(1e-4));
      REQUIRE(r.x.row(0) == c.rest.row(0));
    }
}

TEST_CASE("Energy never rises from one implicit step to the next, and three small decrements end a level") {
  NewtonCase c;
  const double small = 1e-4;
  c.solve({.step_size = 0.05, .force_tolerance = 1e6, .decrement_tolerance = small}, 0.4);
  const auto& rows = c.observer.rows;
  REQUIRE(rows.size() > 3);
  for (std::size_t i = 1; i < rows.size(); ++i)
    REQUIRE(rows[i].energy <= rows[i - 1].energy * (1 + 1e-12) + 1e-15);
  for (std::size_t k = 1; k <= 4; ++k) CHECK((rows[rows.size() - k].decrement <= small) == (k <= 3));
}

TEST_CASE("The decrement is the mean speed for the first h, or a bound of it, whatever h has become") {
  // Otherwise a tolerance of decrements would get looser as h grows, and be met because h has shrunk.
  NewtonCase c(on_hump);  // where steps are cut
  const NewtonParameters p = {.step_size = 3, .step_growth = 3, .max_steps = 20, .force_tolerance = tight};
  const LevelResult r = c.solve(p, 0.4);
  int longer = 0, others = 0;
  Positions before = c.rest;
  for (std::size_t k = 0; k < c.observer.rows.size(); ++k) {
    const IterationRow& row = c.observer.rows[k];
    const double length = (c.observer.x[k] - before).norm() / row.step_length / std::sqrt(15.0);
    const double ratio = p.step_size / row.step_size;
    CHECK(row.decrement == Approx(length / p.step_size * std::max(1.0, ratio * ratio)));
    ++(ratio < 1 ? longer : others);
    before = c.observer.x[k];
  }
  CHECK(longer > 0);
  CHECK(others > 0);
  CHECK(r.decrement == c.observer.rows.back().decrement);
}

TEST_CASE("The step size stays the same within an implicit step, and altogether without growth") {
  NewtonCase several;
  several.solve({.iterations_per_step = 3, .force_tolerance = tight}, 0.4);
  std::map<int, std::set<double>> sizes;  // of each step
  std::set<double> all;
  for (const IterationRow& row : several.observer.rows) {
    sizes[row.step].insert(row.step_size);
    all.insert(row.step_size);
  }
  for (const auto& [step, of_step] : sizes) REQUIRE(of_step.size() == 1);
  REQUIRE(several.observer.rows.size() > sizes.size() + 3);
  REQUIRE(all.size() > 1);

  NewtonCase constant;
  const double size = 2 * StepController::max_step_size;
  constant.solve({.step_size = size, .step_growth = 1, .force_tolerance = tight}, 0.4);
  REQUIRE(constant.observer.rows.size() > 2);
  for (const IterationRow& row : constant.observer.rows) REQUIRE(row.step_size == size);
}

TEST_CASE("A Newton matrix with NaN stalls the level, which names the vertex and a pin short of its target") {
  const std::string fault =
      "the Newton matrix holds entries that are not finite, first in the block of vertex 5; check that the "
      "moduli, the density and the loads are in SI units, and an energy of your own by drape check-energy";
  for (const NewtonForm form : forms)
    for (const PsdBlend blend : {PsdBlend::adaptive, PsdBlend::full})
      for (const double lift : {0.0, 0.1}) {  // of the pin's target: the predictor needs a factor too
        NewtonCase c;
        const LevelResult r = c.solve({.form = form, .force_tolerance = tight, .psd_blend = blend},
                                      c.broken(5), c.pinned(lift));
        CAPTURE(int(form), int(blend), lift);
        CHECK(r.outcome == Outcome::stalled);
        CHECK(r.message == fault + (lift > 0 ? "; pin 0 stopped 0.1 m short of its target (vertex 0)" : ""));
        CHECK(r.x == c.rest);
        CHECK(r.iterations == 0);
      }
  NewtonCase fixed;  // the vertex is not part of the Newton matrix
  const LevelResult r = fixed.solve({.force_tolerance = tight}, fixed.broken(0), fixed.pinned());
  INFO(r.message);
  CHECK(r.outcome == Outcome::converged);
}

TEST_CASE("An implicit step ends when it is solved or stopped, at any iteration; a level ends at max_steps") {
  NewtonCase stopped;
  stopped.observer.stop_after = 3;
  const LevelResult r = stopped.solve({.iterations_per_step = 1000, .force_tolerance = tight}, 0.4);
  CHECK(r.outcome == Outcome::cancelled);
  CHECK(r.iterations == 3);
  CHECK(r.steps <= 1);

  NewtonParameters p{.step_size = 0.01, .step_growth = 1, .iterations_per_step = 50, .max_steps = 20};
  p.force_tolerance = tight;
  NewtonCase patient;
  const LevelResult late = patient.solve(p, 0.4);
  REQUIRE(late.outcome == Outcome::max_steps_reached);  // strong damping: not yet converged
  CHECK(late.steps == 20);
  CHECK_THAT(late.message, Catch::Contains("max_steps = 20"));
  for (const IterationRow& row : patient.observer.rows) REQUIRE(row.iteration < 10);
}

TEST_CASE("A level that ends without descent names what limits the step") {
  for (const NewtonForm form : forms) {
    NewtonCase c;
    const LevelResult r =
        c.solve({.form = form, .force_tolerance = tight}, {{"wells", energy_of(c.wells())}, c.limit(0)});
    CHECK(r.outcome == Outcome::stalled);
    CHECK_THAT(r.message, Catch::StartsWith("the line search found no descent") &&
                              Catch::EndsWith("; the step is limited by the limiter"));
  }
}

TEST_CASE("A cloth that nothing holds is detected, in both forms and within an implicit step") {
  // Constant forces on a cloth without pins: it falls without end.
  for (const auto& [form, iterations] :
       {std::pair(NewtonForm::quasistatic, 1), {NewtonForm::statics, 1}, {NewtonForm::statics, 1000}}) {
    NewtonCase c;
    const LevelResult r = c.solve({.form = form, .iterations_per_step = iterations}, only_weight);
    CAPTURE(int(form), iterations, r.steps);
    CHECK(r.outcome == Outcome::infeasible);
    const double drift = (r.x - c.rest).colwise().mean().norm();
    CHECK_THAT(r.message,
               Catch::StartsWith("nothing holds the cloth within 100 of its diagonals: it has drifted by ") &&
                   Catch::Contains(" of them, " + three_digits(drift) + " m, and does not come to rest"));
    CHECK(r.iterations < 100);
  }
  NewtonCase c;
  const LevelResult pinned = c.solve({}, only_weight, c.pinned());
  CHECK(pinned.outcome == Outcome::infeasible);
  CHECK_THAT(pinned.message,
             Catch::StartsWith("its pins or springs do not hold the cloth within 100 of its ") &&
                 Catch::Contains("; an energy that is unbounded below has no state of rest: "));
}

TEST_CASE("A cloth that rests where its load or every force vanishes is at equilibrium") {
  for (const EnergyRole role : {EnergyRole::membrane, EnergyRole::external}) {
    NewtonCase c(0);  // the Dirichlet vertex is at its target
    c.centres.bottomRows(15).array() += 0.01;
    c.centres(0, 2) += 1e-12;  // but for round-off
    const LevelResult r = c.solve({.max_steps = 300}, {{"bowl", energy_of(c.wells(), role)}}, c.pinned());
    CAPTURE(int(role), r.message, r.steps);
    CHECK(r.outcome == Outcome::converged);
    // The residual scale has a lower bound.
    const double weight = 9.81 * c.model->masses().tail(15).norm();
    if (role == EnergyRole::membrane)
      CHECK(c.model->residual_scale(r.x, Positions::Zero(16, 3)) == Approx(1e-3 * weight));
  }
}

TEST_CASE("A minimisation resumed at any step continues bit for bit") {
  const LinearSolver solver = GENERATE(LinearSolver::mixed, LinearSolver::supernodal, LinearSolver::cholmod);
  const int iterations = GENERATE(1, 2);
  for (const NewtonForm form : forms) {
    const NewtonParameters p{.form = form,
                             .iterations_per_step = iterations,
                             .force_tolerance = tight,
                             .decrement_tolerance = 1e-7,
                             .linear_solver = solver};
    NewtonCase c(on_hump);
    const LevelModel model(c.level, Material(), {{"wells", energy_of(c.wells(0.4))}}, c.pinned());
    KeepingObserver whole;
    whole.keeps_states = true;
    LevelResult before;
    before.seconds = 2;
    before.seconds_by_phase = {{"before", 2}};
    PlainObjective first(model);
    const LevelResult expected = minimise(first, c.rest, p, {Stopwatch(), whole, false, before});
    CAPTURE(int(solver), iterations, int(form), expected.message);
    REQUIRE(expected.outcome == Outcome::converged);
    REQUIRE(whole.states.size() > 4);
    check_resumed(whole, expected, [&](const NewtonState& state, Observer& observer) {
      PlainObjective again(model);
      const LevelResult r = minimise(again, {}, p, {Stopwatch(), observer, false, {}, &state});
      REQUIRE(r.seconds > 2);
      REQUIRE(r.seconds_by_phase.at("before") == 2);
      return r;
    });
  }
}

TEST_CASE("The energy of a row is the level's own, without the penalty of pins under way") {
  NewtonCase c;
  c.solve({.max_steps = 5}, {{"wells", energy_of(c.wells())}, c.limit(0.5)}, c.pinned(0.1));
  REQUIRE(c.observer.x.size() > 2);
  for (std::size_t k = 0; k < c.observer.x.size(); ++k)
    CHECK(c.observer.rows[k].energy == Approx(c.model->energy(c.observer.x[k])));
}

TEST_CASE("A step without descent is no equilibrium although the pins reach their targets after it") {
  NewtonCase c;
  c.centres.row(0).array() += 1;  // the pin carries far more than the free vertices lack
  FakeLoads loads;
  loads.increments = 0;  // a schedule at its end
  const LevelResult r = c.solve({.force_tolerance = tight},
                                {{"wells", energy_of(Frozen(c.centres, c.rest))},
                                 {"limit", energy_of(LimitsOnce(), EnergyRole::limit)}},
                                c.pinned(0.1), &loads);
  INFO(r.message);
  CHECK(r.x.row(0) == c.pinned(0.1)[0].target.transpose());
  CHECK(r.outcome == Outcome::stalled);
  CHECK_THAT(r.message, Catch::StartsWith("the line search found no descent"));
}

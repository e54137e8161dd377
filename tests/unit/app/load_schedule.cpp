#include "core/app/scene/load_schedule.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/support/solve.h"

using namespace drape;

namespace {

/// Two levels whose pin, gravity, bending modulus and obstacle change; the membrane and `ipc` do not.
const std::string two_levels = R"(name: loads
cloth: {shape: square, side: 0.4, columns: 5, rows: 5}
levels: 2
pins: [{region: nearest, point: [0, 0, 0]}]
handles: [{region: nearest, point: [0.4, 0.4, 0]}]
energies: [neo_hookean, hinge, {type: gravity, acceleration: [0, 0, -9.81]}]
contact: [ipc, shapes]
obstacles: [{name: ball, shape: sphere, radius: 0.1, translate: [0.2, 0.2, -0.2]}]
friction: 0.1
methods: {newton: {}}
schedule:
  steps: 4
  keys:
    - {parameter: pins.0.translate, times: [0, 4], values: [[0, 0, 0], [0, 0, 0.4]]}
    - {parameter: energies.gravity.acceleration.2, times: [0, 4], values: [-9.81, -1.81]}
    - {parameter: material.bending_modulus, times: [2, 4], values: [8e4, 8e2], interpolation: log}
    - {parameter: obstacles.ball.translate, times: [0, 4], values: [[0.2, 0.2, -0.2], [0.2, 0.2, -0.12]]}
)";

/// A scene and its schedule.
struct Scheduled : Solved {
  explicit Scheduled(const std::string& yaml = two_levels) : Solved(scene_from(yaml)) {}
  LoadSchedule schedule{experiment, *scene};

  std::shared_ptr<const LevelModel> model_of(const std::vector<double>& values, int level = 0) const {
    return model_under(*schedule.at(values), *scene, level, *scene->models[level]);
  }
  std::shared_ptr<const LevelModel> model_at(double time) const {
    return model_of(schedule.keys().values_at(time));
  }
};

/// What a model gives, for comparison.
struct Figures {
  std::vector<double> energies;
  Positions gradient, obstacle;
  std::vector<Eigen::Vector3d> targets;
  bool operator==(const Figures&) const = default;
};

Figures figures_of(const LevelModel& model) {
  Positions x = model.level().rest.vertices;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    x.row(i) *= 1 + 1e-2 * std::sin(7.0 * static_cast<double>(i));
    x(i, 2) = 1e-2 * std::cos(static_cast<double>(i * i));
  }
  Figures figures;
  for (const auto& [name, energy] : model.energy_parts(x)) figures.energies.push_back(energy);
  model.gradient(x, figures.gradient);
  figures.obstacle = model.contacts().back()->obstacles().back().vertices;
  for (const DirichletVertex& d : model.dirichlet()) figures.targets.push_back(d.target);
  return figures;
}

}  // namespace

TEST_CASE("The keys' values follow the pseudo-time, one after another") {
  const Scheduled s;
  CHECK(s.schedule.keys().steps == 4);
  CHECK(s.schedule.keys().time(3) == 3);
  CHECK(s.schedule.values(0) == s.schedule.first()->values);
  const std::vector<double> expected = {0, 0, 0.3, -3.81, 8e3, 0.2, 0.2, -0.14},
                            values = s.schedule.values(3);
  REQUIRE(values.size() == expected.size());
  for (std::size_t c = 0; c < values.size(); ++c) CHECK(values[c] == Approx(expected[c]));
}

TEST_CASE("A step is made at its key's time, also where increments are not numbers that a double has") {
  for (const auto& [duration, steps, at, increment] :
       {std::tuple(0.9, 9, 0.9, 9), {0.7, 12, 0.7, 12}, {0.7, 7, 0.1, 1}}) {
    ScheduleParameters p;
    p.duration = duration, p.steps = steps;
    ScheduleKey key;
    key.times = {0, at}, key.values = {{1}, {2}}, key.interpolation = KeyInterpolation::step;
    p.keys = {key};
    CHECK(p.values_at(p.time(increment)) == std::vector<double>{2});
    CHECK(p.values_at(p.time(increment - 1)) == std::vector<double>{1});
  }
}

TEST_CASE("A load is a value: equal when asked for twice, from whatever load, and never changed") {
  const Scheduled s;
  const LoadSchedule& schedule = s.schedule;
  const auto half = schedule.at(schedule.values(2)), again = schedule.at(schedule.values(2));
  const auto end = schedule.at(schedule.values(4), *half), back = schedule.at(schedule.values(2), *end);
  const auto height = [](const LoadState& load) { return load.parameters->pins[0].translate.value().z(); };
  CHECK(height(*half) == 0.2);
  CHECK(height(*end) == 0.4);
  CHECK(end->parameters->material.bending_modulus == 800);
  CHECK(height(*schedule.first()) == 0);
  for (int level = 0; level < 2; ++level) {
    const LevelModel& first = *s.scene->models[level];
    const Figures at_first = figures_of(first);
    const auto model = model_under(*half, *s.scene, level, first);
    const Figures at_half = figures_of(*model);
    const auto last = model_under(*end, *s.scene, level, *model);
    const Figures at_end = figures_of(*last);
    CHECK(figures_of(*model_under(*again, *s.scene, level, first)) == at_half);
    CHECK(figures_of(*model_under(*back, *s.scene, level, *last)) == at_half);
    // All that is keyed has changed, and the earlier models have not.
    CHECK(at_half.obstacle != at_first.obstacle);
    CHECK(at_end.obstacle != at_half.obstacle);
    CHECK(at_end.targets != at_half.targets);
    CHECK(at_end.gradient != at_half.gradient);
    CHECK(at_end.energies[0] == at_half.energies[0]);  // neo_hookean
    REQUIRE(at_half.energies[1] > 0);
    CHECK(at_end.energies[1] == Approx(0.01 * at_half.energies[1]));
    CHECK(at_end.energies[2] == Approx(1.81 / 5.81 * at_half.energies[2]));
    CHECK(figures_of(*model) == at_half);
    CHECK(figures_of(first) == at_first);
  }
}

TEST_CASE("Loads share what is equal in them") {
  const Scheduled s;
  const LoadState& first = *s.schedule.first();
  std::vector<double> values = first.values;
  values[7] += 0.01;  // the ball's height
  const auto moved = s.schedule.at(values);
  CHECK(moved->parameters == first.parameters);
  for (std::size_t k = 0; k < first.energies.size(); ++k)
    CHECK(moved->energies[k].energy == first.energies[k].energy);
  const LevelModel& before = *s.scene->models[1];
  const auto model = model_under(*moved, *s.scene, 1, before);
  CHECK(model->pattern() == before.pattern());
  for (const int k : {0, 1}) {  // ipc, which has no obstacle, is shared
    CHECK((moved->contacts[k] == first.contacts[k]) == (k == 0));
    CHECK((model->contacts()[k] == before.contacts()[k]) == (k == 0));
  }
  CHECK(s.schedule.at(values, *moved)->contacts == moved->contacts);
}

TEST_CASE("Load stepping passes models on, and coarser levels keep theirs") {
  const Scheduled s;
  LoadStepping& stepping = *s.scene->load_stepping;
  const auto expected = [&](int increment, int level) {
    return figures_of(*s.model_of(s.schedule.values(increment), level));
  };
  const auto advance = [&] { REQUIRE(stepping.advance(0, s.scene->starts[0]).fraction == 1); };
  stepping.begin(0, true);
  const auto first = stepping.model(0);
  CHECK(figures_of(*first) == expected(0, 0));
  CHECK(stepping.model(0) == first);
  advance();
  advance();
  CHECK(stepping.increment() == 2);
  CHECK(stepping.complete());
  CHECK(stepping.model(0) != first);
  CHECK(figures_of(*first) == expected(0, 0));
  for (const int level : {0, 1}) CHECK(figures_of(*stepping.model(level)) == expected(2, level));
  CHECK(s.scene->model(1) == stepping.model(1));

  advance();
  const LoadSteppingState third = stepping.state();
  const Figures at_third = figures_of(*stepping.model(0));
  stepping.begin(1, true);
  CHECK(stepping.increment() == 0);
  CHECK(figures_of(*stepping.model(1)) == expected(0, 1));
  CHECK(figures_of(*stepping.model(0)) == at_third);
  stepping.restore(0, third);
  CHECK(stepping.increment() == 3);
  CHECK(figures_of(*stepping.model(0)) == at_third);
  CHECK(figures_of(*stepping.model(1)) == expected(3, 1));
}

TEST_CASE("A fraction of an increment that no number expresses counts as none") {
  const Scheduled s;
  LoadStepping& stepping = *s.scene->load_stepping;
  stepping.begin(0, true);
  REQUIRE(stepping.advance(0, s.scene->starts[0]).fraction == 1);
  LoadSteppingState near = stepping.state();
  near.increment = 2;
  near.values = s.schedule.values(2);
  double& last = near.values.back();  // the ball's height
  last = std::nextafter(last, -1);
  stepping.restore(0, near);
  CHECK_FALSE(stepping.complete());
  CHECK_FALSE(stepping.advance_by(0.25, 0, s.scene->starts[0]));
  CHECK(stepping.state().values == near.values);
  CHECK(stepping.advance_by(1, 0, s.scene->starts[0]));
  CHECK(stepping.complete());
}

namespace {

/// An item of a schedule's keys.
std::string key(const std::string& parameter, const std::string& times, const std::string& values) {
  return "{parameter: " + parameter + ", times: [" + times + "], values: [" + values + "]}, ";
}

/// A sheet with two pins and a handle, and a schedule with these keys.
std::string with_keys(const std::string& keys) {
  return R"(name: regions
cloth: {shape: square, side: 0.4, triangulation: one_way, columns: 5, rows: 5}
levels: 2
pins:
  - {region: box, lower: [-0.05, -0.05, -1], upper: [0.05, 0.05, 1]}
  - {region: ball, point: [0.4, 0, 0], radius: 0.15}
handles: [{region: box, lower: [-1, 0.35, -1], upper: [1, 1, 1]}]
energies: [neo_hookean, {type: midedge_bending, correction_tolerance: 1}, gravity]
methods: {newton: {}}
contact: ipc
obstacles: [{meshed_shape: sphere, radius: 0.1, subdivisions: 1, translate: [0.2, 0.2, -1]}]
schedule: {steps: 4, keys: [)" +
         keys + "]}\n";
}

}  // namespace

TEST_CASE("Each key is checked with the values of the others at that time") {
  // The bounds of this box move together.
  CHECK_NOTHROW(scene_from(with_keys(key("pins.0.lower.0", "0, 1", "-0.05, 0.15") +
                                     key("pins.0.upper.0", "0, 1", "0.05, 0.25") +
                                     key("pins.1.radius", "0, 1", "0.15, 0.25"))));
}

TEST_CASE("A load at which a pin has no vertex, or two pins meet, is refused between the keys' times too") {
  // The box passes between two vertices of the border.
  const Scheduled passing(
      with_keys(key("pins.0.lower.0", "0, 1", "-0.02, 0.08") + key("pins.0.upper.0", "0, 1", "0.02, 0.12")));
  CHECK(passing.model_at(0)->dirichlet().size() == passing.model_at(1)->dirichlet().size());
  CHECK_THROWS_WITH(passing.model_at(0.5), "pin 0 selects no vertex of level 0");
  // A lifted box passes over a row that the other pin holds.
  const Scheduled crossing(R"(name: crossing
cloth: {shape: square, side: 1, triangulation: one_way, columns: 11, rows: 11}
levels: 1
pins:
  - {region: box, lower: [0.45, -1, -1], upper: [0.55, 2, 1]}
  - {region: box, lower: [-0.05, -1, -1], upper: [0.05, 2, 1], translate: [0, 0, 0.1]}
energies: [neo_hookean, gravity]
methods: {newton: {}}
schedule: {steps: 10, keys: [)" +
                           key("pins.1.lower.0", "0, 1", "-0.05, 0.95") +
                           key("pins.1.upper.0", "0, 1", "0.05, 1.05") + "]}\n");
  CHECK(crossing.model_at(0.4)->dirichlet().size() == 22);
  CHECK_THROWS_WITH(crossing.model_at(0.5), Catch::Contains("pin 1 and pin 0 both select vertex"));
}

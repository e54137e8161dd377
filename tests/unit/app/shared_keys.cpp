// Keys of an experiment that its methods share (`newton`), or its contact models.

#include <catch2/catch.hpp>

#include "core/app/experiment/read_experiment.h"
#include "core/app/scene/load_schedule.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

const std::string methods = R"(name: e
energies: [gravity]
methods:
  plain: newton
  empty: {type: newton, newton: ~}
  own: {type: newton, newton: {step_size: 0.2, psd_blend: full}}
)";

/// A method's value, which its resolved section has only where it differs from the experiment's.
std::string value(const Experiment& e, const std::string& method, const std::string& key) {
  const ConfigNode* own = e.resolved.find("methods")->find(method)->find("newton");
  const ConfigNode* value = own ? own->find(key) : nullptr;
  return (value ? value : e.resolved.find("newton")->find(key))->scalar;
}

/// Two models, whose obstacles are mixed in the list.
const std::string mixed = R"(name: mixed
cloth: {shape: square, side: 0.4, columns: 3, rows: 3}
levels: 1
start: {translate: [0, 0, 1]}
energies: [neo_hookean, gravity]
contact: [shapes, {type: ipc, dhat: 2e-3}]
obstacles:
  - {name: plate, meshed_shape: box, size: [0.1, 0.1, 0.1]}
  - {name: ball, shape: sphere, radius: 0.1}
  - {name: floor, shape: half_space, translate: [0, 0, -1], friction: 0}
  - {name: shell, meshed_shape: sphere, subdivisions: 1, translate: [1, 0, 0]}
friction: 0.25
methods: {newton: {}}
)";

std::vector<std::string> names_in(const ConfigNode& obstacles) {
  std::vector<std::string> names;
  for (const ConfigNode& obstacle : obstacles.items) names.push_back(obstacle.find("name")->scalar);
  return names;
}

}  // namespace

TEST_CASE("Every method has the experiment's newton, but for what it sets itself, also once it is saved") {
  const Experiment e = experiment_from(methods + "newton: {step_size: 0.5, max_steps: 70}\n");
  CHECK(e.resolved.find("methods")->one_line() ==
        "{plain: {type: newton}, empty: {type: newton}, own: {type: newton, newton: {step_size: 0.2, "
        "psd_blend: full}}}");
  const std::string saved = to_yaml(e.resolved);
  CHECK(to_yaml(experiment_from(saved).resolved) == saved);
  const Experiment again = experiment_from(replaced(saved, "step_size: 0.5", "step_size: 0.25"));
  for (const char* method : {"plain", "empty"}) {
    INFO(method);
    CHECK(value(e, method, "step_size") == "0.5");
    CHECK(value(again, method, "step_size") == "0.25");
    CHECK(value(e, method, "max_steps") == "70");
    CHECK(value(e, method, "psd_blend") == "adaptive");
  }
  for (const Experiment* either : {&e, &again}) CHECK(value(*either, "own", "step_size") == "0.2");
  CHECK(value(e, "own", "max_steps") == "70");
  CHECK(value(e, "own", "psd_blend") == "full");
}

TEST_CASE("Each contact model gets the obstacles that have its keys, in the list's order, and the friction") {
  Experiment e = experiment_from(mixed);
  REQUIRE(e.obstacles_of.size() == 2);
  CHECK((e.obstacles_of[0] == std::vector<std::size_t>{1, 2}));
  CHECK((e.obstacles_of[1] == std::vector<std::size_t>{0, 3}));
  ConfigErrors errors;
  const auto section = [&](std::size_t k) { return contact_section(e, e.parameters, k, errors); };
  CHECK((names_in(*section(0).find("obstacles")) == std::vector<std::string>{"ball", "floor"}));
  CHECK((names_in(*section(1).find("obstacles")) == std::vector<std::string>{"plate", "shell"}));
  for (const std::size_t k : {0, 1}) CHECK(section(k).find("friction")->scalar == "0.25");

  const Level level = Level::of(0, grid({0.1, 0.1}, 3, 3, Diagonals::one_way));
  CHECK(e.contacts[0]->bind(level, Material())->obstacles().size() == 2);
  CHECK(e.contacts[1]->bind(level, Material())->obstacles()[1].vertices.rows() == 42);

  // Their names are in the order of their meshes, model by model.
  CHECK((e.obstacle_order() == std::vector<std::size_t>{1, 2, 0, 3}));
  e.parameters.obstacles[2].entries.erase(e.parameters.obstacles[2].entries.begin());
  CHECK((e.obstacle_names() == std::vector<std::string>{"ball", "", "plate", "shell"}));
}

TEST_CASE("Without the key, or with an empty list, there is no contact") {
  const std::string free = "name: free\nenergies: [neo_hookean, gravity]\nmethods: {newton: {}}\n";
  for (const std::string none : {"", "contact: []\n", "contact: ~\n", "friction: 0\n"}) {
    const Experiment e = experiment_from(free + none);
    CHECK(e.contacts.empty());
    CHECK(e.resolved.find("contact")->one_line() == "[]");
    CHECK(experiment_from(to_yaml(e.resolved)).resolved.one_line() == e.resolved.one_line());
  }
}

TEST_CASE("A saved experiment has obstacles and friction once, and reads back the same") {
  const Experiment e = experiment_from(mixed);
  const ConfigNode *obstacles = e.resolved.find("obstacles"), *models = e.resolved.find("contact");
  CHECK((names_in(*obstacles) == std::vector<std::string>{"plate", "ball", "floor", "shell"}));
  CHECK(obstacles->items[1].find("translate"));  // a default
  CHECK(e.resolved.find("friction")->scalar == "0.25");
  REQUIRE(models->items.size() == 2);
  CHECK(models->items[1].find("dhat")->scalar == "0.002");
  for (const ConfigNode& model : models->items) {
    CHECK(!model.find("friction"));
    CHECK(!model.find("obstacles"));
  }
  CHECK(experiment_from(to_yaml(e.resolved)).resolved.one_line() == e.resolved.one_line());
}

TEST_CASE("A key of the friction changes every contact model") {
  const Solved s =
      scene_from(mixed + "schedule: {keys: [{parameter: friction, times: [0, 1], values: [0.25, 0.5]}]}\n");
  const LoadSchedule schedule(s.experiment, *s.scene);
  const LoadState& first = *schedule.first();
  REQUIRE((first.values == std::vector<double>{0.25}));
  for (int k = 0; k < 2; ++k) CHECK(schedule.at({0.5})->contacts[k] != first.contacts[k]);
}

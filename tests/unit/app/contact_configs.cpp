#include <catch2/catch.hpp>

#include "core/app/experiment/experiment.h"
#include "core/app/scene/load_schedule.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"
#include "tests/support/solve.h"

using namespace drape;
using Catch::Contains;

namespace {

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

TEST_CASE("Each contact model gets the obstacles that have its keys, in the list's order, and the friction") {
  const Experiment e = experiment_from(mixed);
  const std::vector<ContactConfig>& configs = e.contact_configs;
  REQUIRE(configs.size() == 2);
  CHECK((configs[0].obstacles == std::vector<std::size_t>{1, 2}));
  CHECK((configs[1].obstacles == std::vector<std::size_t>{0, 3}));
  const auto written = [](const ContactConfig& config) {
    return config.parameters.entry->schema.write(config.parameters.values.get());
  };
  CHECK((names_in(*written(configs[0]).find("obstacles")) == std::vector<std::string>{"ball", "floor"}));
  CHECK((names_in(*written(configs[1]).find("obstacles")) == std::vector<std::string>{"plate", "shell"}));
  for (const ContactConfig& config : configs) CHECK(written(config).find("friction")->scalar == "0.25");

  const Level level = Level::of(0, grid({0.1, 0.1}, 3, 3, Diagonals::one_way));
  CHECK(e.contacts[0]->bind(level, Material())->obstacles().size() == 2);
  CHECK(e.contacts[1]->bind(level, Material())->obstacles()[1].vertices.rows() == 42);
}

TEST_CASE("The obstacles' names are in the order of their meshes, model by model") {
  Experiment e = experiment_from(mixed);
  CHECK((e.obstacle_order() == std::vector<std::size_t>{1, 2, 0, 3}));
  e.parameters.obstacles[2].entries.erase(e.parameters.obstacles[2].entries.begin());
  CHECK((e.obstacle_names() == std::vector<std::string>{"ball", "", "plate", "shell"}));
}

TEST_CASE("Two obstacles of one name are refused, whichever model takes them") {
  CHECK_THROWS_WITH(
      experiment_from(replaced(mixed, "name: shell", "name: ball")),
      Contains(":11:12: \"ball\" is also the name of obstacles[1]; give each obstacle its own"));
  CHECK_THROWS_WITH(experiment_from(replaced(mixed, "name: shell", "name: 1")),
                    Contains(":11:12: \"1\" cannot be an obstacle's name"));
}

TEST_CASE("Without the key, or with an empty list, there is no contact") {
  for (const char* none : {"", "contact: []\n", "contact: ~\n"}) {
    const Experiment e =
        experiment_from("name: free\nenergies: [gravity]\nmethods: {newton: {}}\n" + std::string(none));
    CHECK(e.contacts.empty());
    CHECK(e.resolved.find("contact")->one_line() == "[]");
    CHECK(experiment_from(to_yaml(e.resolved)).resolved.one_line() == e.resolved.one_line());
  }
}

TEST_CASE("A contact model is listed once") {
  CHECK_THROWS_WITH(experiment_from(replaced(mixed, "[shapes,", "[shapes, shapes,")),
                    Contains("\"contact\" lists shapes twice; list each model once"));
}

TEST_CASE("Friction is refused where no contact model has it, also where only a schedule's key sets it") {
  const std::string free = R"(name: free
cloth: {shape: square, side: 1, columns: 3, rows: 3}
energies: [neo_hookean, gravity]
methods: {newton: {}}
)";
  const std::string refused =
      "no contact model of this experiment has friction; set \"friction\" to 0, or add";
  CHECK_NOTHROW(experiment_from(free + "friction: 0\n"));
  CHECK_THROWS_WITH(experiment_from(free + "friction: 0.1\n"), Contains(refused));
  CHECK_THROWS_WITH(experiment_from(free + "schedule: {keys: [{parameter: friction, times: [0, 1], "
                                           "values: [0, 0.1]}]}\n"),
                    Contains(refused));
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

TEST_CASE("A key of the friction changes every contact model, one of an obstacle only its own") {
  const Solved s = scene_from(mixed + R"(schedule:
  steps: 2
  keys:
    - {parameter: friction, times: [0, 1], values: [0.25, 0.5]}
    - {parameter: obstacles.shell.translate.0, times: [0, 1], values: [1, 2]}
)");
  const LoadSchedule schedule(s.experiment, *s.scene);
  const LoadState& first = *schedule.first();
  REQUIRE((first.values == std::vector<double>{0.25, 1}));
  const auto rougher = schedule.at({0.5, 1});
  CHECK(rougher->contacts[0] != first.contacts[0]);
  CHECK(rougher->contacts[1] != first.contacts[1]);
  const auto moved = schedule.at({0.25, 1.5});
  CHECK(moved->contacts[0] == first.contacts[0]);
  CHECK(moved->contacts[1] != first.contacts[1]);
  const LevelModel& before = *s.scene->models[0];
  const auto after = schedule.model(*moved, 0, before);
  const std::vector<TriangleMesh> meshes = after->contacts()[1]->obstacles();
  CHECK(meshes[0].vertices == before.contacts()[1]->obstacles()[0].vertices);
  CHECK(meshes[1].vertices.col(0).mean() == Approx(1.5));
}

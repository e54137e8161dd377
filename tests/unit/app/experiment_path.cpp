#include "core/app/experiment/experiment_path.h"

#include <catch2/catch.hpp>

#include "core/app/files/yaml_file.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// The experiment's map after a value was set, in one line, or the error.
std::string after_setting(const std::string& yaml, const std::string& path, const std::string& value) {
  ConfigErrors errors;
  ConfigNode experiment = parse_yaml(yaml, "e.yaml", errors);
  REQUIRE(errors.empty());
  if (set_parameter(experiment, path, value, "--set", errors)) return experiment.one_line();
  REQUIRE(errors.size() == 1);
  return errors[0].text();
}

}  // namespace

TEST_CASE("A plugin goes by its type in a path, in a list or alone") {
  CHECK(after_setting("contact: [ipc, shapes]", "contact.shapes.dhat", "2") ==
        "{contact: [ipc, {type: shapes, dhat: 2}]}");
  for (const char* path : {"contact.shapes.dhat", "contact.dhat"})
    for (const char* contact : {"contact: shapes", "contact: {type: shapes, dhat: 1}"})
      CHECK(after_setting(contact, path, "2") == "{contact: {type: shapes, dhat: 2}}");
  CHECK(after_setting("refiner: loop", "refiner.loop.corner_angle", "10") ==
        "{refiner: {type: loop, corner_angle: 10}}");
  // A method's own section may have the name of its type.
  CHECK(after_setting("methods: {newton: {type: newton}}", "methods.newton.newton.step_size", "1") ==
        "{methods: {newton: {type: newton, newton: {step_size: 1}}}}");
}

TEST_CASE("The words of a path are equal for equal parameters") {
  ConfigErrors errors;
  const ConfigNode alone = parse_yaml("contact: {type: shapes}", "e.yaml", errors),
                   list = parse_yaml("contact: [shapes]", "e.yaml", errors);
  CHECK(words_of_path(alone, "contact.shapes.dhat") == words_of_path(alone, "contact.dhat"));
  CHECK(words_of_path(alone, "contact.ipc.dhat") == std::vector<std::string>{"contact", "ipc", "dhat"});
  CHECK(words_of_path(list, "contact.shapes.dhat") == std::vector<std::string>{"contact", "shapes", "dhat"});
}

TEST_CASE("The refiner has a default, whose parameters can be set") {
  for (const char* yaml : {"name: e", "{name: e, refiner: }"})
    CHECK_THAT(after_setting(yaml, "refiner.corner_angle", "10"),
               Catch::Contains("refiner: {type: loop, corner_angle: 10}"));
  CHECK(after_setting("name: e", "refiner.type", "midpoint") == "{name: e, refiner: {type: midpoint}}");
  CHECK(after_setting("name: e", "refiner", "midpoint") == "{name: e, refiner: midpoint}");
}

TEST_CASE("What a path needs and the experiment does not have is named") {
  const std::string list = "; write that list first";
  for (const char* yaml : {"name: e", "pins: []", "{pins: }"})
    CHECK(after_setting(yaml, "pins.0.radius", "2") == "--set: the experiment has no \"pins\"" + list);
  CHECK(after_setting("name: e", "obstacles.plate.translate.2", "1") ==
        "--set: the experiment has no \"obstacles\"" + list);
  CHECK(after_setting("schedule: {steps: 2}", "schedule.keys.0.times", "[0]") ==
        "--set: the experiment has no \"schedule.keys\"" + list);
  CHECK(after_setting("name: e", "contact.dhat", "1") ==
        "--set: the experiment has no \"contact\"; name its plugin first");
  CHECK(after_setting("name: e", "pins", "[{radius: 2}]") == "{name: e, pins: [{radius: 2}]}");
  CHECK(after_setting("name: e", "start.scale", "2") == "{name: e, start: {scale: 2}}");
}

TEST_CASE("A path sets one number of a list that is not written") {
  const Experiment e = experiment_from("name: e\nenergies: [gravity]\nmethods: {newton: {}}\n",
                                       {{"energies.gravity.acceleration.2", "-1"}});
  CHECK(e.resolved.find("energies")->items[0].find("acceleration")->one_line() == "[0, 0, -1]");
}

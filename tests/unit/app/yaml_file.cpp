// YAML as it is read and written, and values that are set in it by their paths.

#include "core/app/files/yaml_file.h"

#include <catch2/catch.hpp>

#include "core/app/experiment/experiment_path.h"
#include "tests/support/command.h"
#include "tests/support/solve.h"
#include "tests/unit/kernel/config_faults.h"

using namespace drape;

namespace {

/// The map after an option has set a value, or its error.
std::string after_option(const std::string& yaml, const std::string& path, const std::string& value) {
  ConfigNode node = node_of_yaml(yaml);
  ConfigErrors errors;
  const Location option{"--set " + path};
  const std::optional<ConfigNode> written = value_of_option(value, option.file, errors);
  REQUIRE(written);
  const bool done = set_path(node, path, *written, option, errors);
  REQUIRE(done == errors.empty());
  return done ? node.one_line() : texts_of_errors(errors);
}

/// The experiment's map after a value was set, in one line, or the error.
std::string after_setting(const std::string& yaml, const std::string& path, const std::string& value) {
  ConfigErrors errors;
  ConfigNode experiment = node_of_yaml(yaml);
  const bool done = set_parameter(experiment, path, value, "--set", errors);
  return done ? experiment.one_line() : texts_of_errors(errors);
}

}  // namespace

TEST_CASE("aliases, and null, quoted and tagged scalars are told apart") {
  const ConfigNode node =
      node_of_yaml("a:\nb: ~\nc: null\nd: \"\"\ne: 'null'\ng: !!str 5\nh: |\n  text\ni: &i {r: 1}\nj: *i\n");
  for (const char* key : {"a", "b", "c"}) CHECK(node.find(key)->kind == ConfigNode::Kind::null);
  for (const char* key : {"d", "e", "g", "h"}) {
    CHECK(node.find(key)->kind == ConfigNode::Kind::text);
  }
  CHECK(node.find("h")->scalar == "text\n");
  CHECK(node.find("j")->one_line() == "{r: 1}");
}

TEST_CASE("invalid configs are reported with the location") {
  const std::string invalid = "not valid YAML: ", second = "a second document begins here; a config is one";
  const std::pair<std::string, std::string> faults[] = {
      {"a: 1\nb: [1, 2\nc: 3\n", "3:2: " + invalid + "end of sequence flow not found"},
      {"a: 1\n  b: 2\n", "2:4: " + invalid + "illegal map value"},
      {"a:\n\tb: 2\n", "2:3: " + invalid + "illegal map value; tabs cannot indent, use spaces"},
      {"a: &a {b: 1}\nc:\n  <<: *a\n", "3:3: merging maps by << is not supported; write the keys out"},
      {"word", "1:1: a config must begin with a map of keys and values"},
      {"a: 1\n---\nb: 2\n", "3:1: " + second},
      {"!:,", "1:3: " + second},  // YAML::LoadAll makes documents of these for ever
      {",", "1:1: " + second},
      {",0],[a", "1:1: " + second},
      {"[1, 2]: 3\n", "1:1: a key must be a word"},
      {"a: !color 5\n", "1:4: tag \"!color\" is not supported; take it out"},
      {"a: &a [*a, *a]\n",
       "1:4: the file has more than 200,000 values or 100 levels of nesting, those that aliases repeat "
       "included; shorten its lists, or check its aliases"}};
  for (const auto& [yaml, fault] : faults) CHECK(fault_of_yaml(yaml) == "f:" + fault);
  CHECK_THAT(fault_of_yaml("{\"a\": \"\\ud83d\\ude00\"}"),
             Catch::Contains("invalid unicode") && Catch::EndsWith("; write the character itself"));
  CHECK(fault_of_yaml("# only a comment\n") == "f: is empty; a config is a map of keys and values");
  // Newer versions of yaml-cpp name it.
  CHECK_THAT(fault_of_yaml("a: *none\n"),
             Catch::StartsWith("f:1:4: " + invalid + "the referenced anchor is not defined"));
  std::string laughs = "a0: &a0 [x]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string n = std::to_string(i), m = "*a" + std::to_string(i - 1);
    laughs += "a" + n + ": &a" + n + " [" + m + ", " + m + ", " + m + ", " + m + "]\n";
  }
  CHECK_THAT(fault_of_yaml(laughs),
             Catch::Contains("the file has more than 200,000 values or 100 levels of nesting"));
}

TEST_CASE("a config in UTF-16 is refused by its encoding") {
  const Scratch folder;
  folder.write("e.yaml", {"\xFF\xFE"
                          "a\0:\0",
                          6});
  ConfigErrors errors;
  read_yaml(folder / "e.yaml", errors);
  CHECK(texts_of_errors(errors) ==
        (folder / "e.yaml").string() + ": is in UTF-16 or UTF-32; save it as UTF-8");
}

TEST_CASE("a byte of a text is found in its file, however the text is written") {
  const Scratch folder;
  const std::pair<std::string, std::string> texts[] = {
      {"text: ab + $c\n", "1:12"},        {"text: \"ab + $c\"\n", "1:13"},
      {"text: 'ab + $c'\n", "1:13"},      {"other: 1\ntext: \"ab\n   + $c\"\n", "3:6"},
      {"text: |\n  ab\n  + $c\n", "3:5"}, {"text: >-\n  ab\n\n  + $c\n", "4:5"}};
  for (const auto& [yaml, place] : texts) {
    folder.write("e.yaml", yaml);
    ConfigErrors errors;
    const ConfigNode config = read_yaml(folder / "e.yaml", errors), &text = *config.find("text");
    CHECK_THAT(location_in_text(text, text.scalar.find('$')).text(), Catch::EndsWith("e.yaml:" + place));
  }
  ConfigNode text = ConfigNode::of("ab");
  for (const Location& own : {Location{"--set text", 0, 0}, Location{"no such file", 2, 3}}) {
    text.where = own;
    CHECK(location_in_text(text, 1).text() == own.text());
  }
}

TEST_CASE("a node is written in block style, and reads back the same") {
  const std::string yaml =
      "name: sphere\nnote: \"a: b, \\\"c\\\" \\\\ # d\\n\"\nnumber_like: \"12\"\n"
      "h: 1.0e-05\nempty: {}\nnone: null\ncenter: [0, 0.5, -1]\nenergies:\n  - gravity\n  - type: membrane\n "
      "   moduli:\n      young: 80000\n"
      "  - - [1, 2]\n    - [3, 4]\n  - []\n";
  CHECK(to_yaml(node_of_yaml(yaml)) == yaml);
  // Plain text with commas or braces survives being put on one line.
  CHECK(to_yaml(node_of_yaml("list:\n  - a, b\n  - c}\n  - it's\n  - --\n  - 10%\n")) ==
        "list: [\"a, b\", \"c}\", \"it's\", \"--\", \"10%\"]\n");
}

TEST_CASE("a path sets a value in maps and lists, making missing maps") {
  CHECK(after_option("a: {b: 1}", "a.b", "2") == "{a: {b: 2}}");
  CHECK(after_option("a: {b: 1}", "a.c", "[1, x]") == "{a: {b: 1, c: [1, x]}}");
  CHECK(after_option("a: 1", "b.c.d", "{e: 3}") == "{a: 1, b: {c: {d: {e: 3}}}}");
  CHECK(after_option("a:", "a.b", "") == "{a: {b: null}}");
  CHECK(after_option("list: [x, {k: 1}]", "list.1.k", "2") == "{list: [x, {k: 2}]}");
  CHECK(after_option("refiner: loop", "refiner.corner_angle", "30") ==
        "{refiner: {type: loop, corner_angle: 30}}");
}

TEST_CASE("a path that does not exist, or leads to several items, is reported") {
  const std::string list = "list: [{type: a}, {type: b, name: a}, {name: c}, a]";
  CHECK(after_option(list, "list.c.k", "2") == "{list: [{type: a}, {type: b, name: a}, {name: c, k: 2}, a]}");
  CHECK(after_option(list, "list.a.k", "2") ==
        "--set list.a.k: \"a\" is the type or name of several items of a list of 4, counted from 0: write "
        "the index, 0 or 1 or 3");
  CHECK(after_option("a: 1", "a..b", "2") == "--set a..b: the path has an empty name");
  CHECK(after_option("a: 1", "", "2") == "--set : the path has an empty name");
  CHECK(after_option("list: [x]", "list.1", "2") ==
        "--set list.1: \"1\" is not an index of a list of 1, counted from 0");
  CHECK(after_option("list: [x]", "list.k", "2") ==
        "--set list.k: \"k\" is neither an index of a list of 1, counted from 0, nor the type or name of an "
        "item");
}

TEST_CASE("every location knows the path of its key, as --set takes it") {
  ConfigNode node = node_of_yaml("a: {b: 1, list: [2, {c: 3}]}");
  node.name_keys();
  const ConfigNode& a = *node.find("a");
  CHECK(node.where.key.empty());
  CHECK(a.find("b")->where.key == "a.b");
  CHECK(a.key_locations[1].key == "a.list");
  CHECK(a.find("list")->items[1].find("c")->where.key == "a.list.1.c");
  CHECK(Location{"", 0, 0, "a.b"}.text() == "a.b");
  CHECK(Location{"f", 2, 0, "a.b"}.text() == "f:2");
}

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
  const ConfigNode alone = node_of_yaml("contact: {type: shapes}"), list = node_of_yaml("contact: [shapes]");
  CHECK(words_of_path(alone, "contact.shapes.dhat") == words_of_path(alone, "contact.dhat"));
  CHECK(words_of_path(alone, "contact.ipc.dhat") == std::vector<std::string>{"contact", "ipc", "dhat"});
  CHECK(words_of_path(list, "contact.shapes.dhat") == std::vector<std::string>{"contact", "shapes", "dhat"});
}

TEST_CASE("What a path needs and the experiment does not have is a default, or named") {
  for (const char* yaml : {"name: e", "{name: e, refiner: }"})
    CHECK_THAT(after_setting(yaml, "refiner.corner_angle", "10"),
               Catch::Contains("refiner: {type: loop, corner_angle: 10}"));
  CHECK(after_setting("name: e", "refiner.type", "midpoint") == "{name: e, refiner: {type: midpoint}}");
  CHECK(after_setting("name: e", "pins", "[{radius: 2}]") == "{name: e, pins: [{radius: 2}]}");
  CHECK(after_setting("name: e", "start.scale", "2") == "{name: e, start: {scale: 2}}");
  const std::string list = "; write that list first";
  for (const char* yaml : {"name: e", "pins: []", "{pins: }"})
    CHECK(after_setting(yaml, "pins.0.radius", "2") == "--set: the experiment has no \"pins\"" + list);
  CHECK(after_setting("schedule: {steps: 2}", "schedule.keys.0.times", "[0]") ==
        "--set: the experiment has no \"schedule.keys\"" + list);
  CHECK(after_setting("name: e", "contact.dhat", "1") ==
        "--set: the experiment has no \"contact\"; name its plugin first");
}

TEST_CASE("A path sets one number of a list that is not written") {
  const Experiment e = experiment_from("name: e\nenergies: [gravity]\nmethods: {newton: {}}\n",
                                       {{"energies.gravity.acceleration.2", "-1"}});
  CHECK(e.resolved.find("energies")->items[0].find("acceleration")->one_line() == "[0, 0, -1]");
}

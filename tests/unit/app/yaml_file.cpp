#include "core/app/files/yaml_file.h"

#include <catch2/catch.hpp>

using namespace drape;

namespace {

ConfigNode parsed(const std::string& yaml) {
  ConfigErrors errors;
  const ConfigNode node = parse_yaml(yaml, "f", errors);
  REQUIRE(errors.empty());
  REQUIRE(node.kind == ConfigNode::Kind::map);
  return node;
}

std::string parse_fault(const std::string& yaml) {
  ConfigErrors errors;
  CHECK(parse_yaml(yaml, "f", errors).kind == ConfigNode::Kind::null);
  REQUIRE(errors.size() == 1);
  return errors[0].text();
}

std::string set(const std::string& yaml, const std::string& path, const std::string& value) {
  ConfigNode node = parsed(yaml);
  ConfigErrors errors;
  const Location option{"--set " + path};
  const std::optional<ConfigNode> written = value_of_option(value, option.file, errors);
  REQUIRE(written);
  const bool done = set_path(node, path, *written, option, errors);
  REQUIRE(done == errors.empty());
  return done ? node.one_line() : errors[0].text();
}

}  // namespace

TEST_CASE("anchors and aliases work") {
  CHECK(parsed("a: &ball {r: 1}\nb: *ball\n").find("b")->one_line() == "{r: 1}");
}

TEST_CASE("null, quoted and tagged scalars are told apart") {
  const ConfigNode node = parsed("a:\nb: ~\nc: null\nd: \"\"\ne: 'null'\ng: !!str 5\nh: |\n  text\n");
  for (const char* key : {"a", "b", "c"}) CHECK(node.find(key)->kind == ConfigNode::Kind::null);
  for (const char* key : {"d", "e", "g", "h"}) {
    CHECK(node.find(key)->kind == ConfigNode::Kind::scalar);
    CHECK(node.find(key)->quoted);
  }
  CHECK(node.find("h")->scalar == "text\n");
}

TEST_CASE("invalid configs are reported with the location") {
  CHECK(parse_fault("a: 1\nb: [1, 2\nc: 3\n") == "f:3:2: not valid YAML: end of sequence flow not found");
  CHECK(parse_fault("a: 1\n  b: 2\n") == "f:2:4: not valid YAML: illegal map value");
  CHECK(parse_fault("a:\n\tb: 2\n") ==
        "f:2:3: not valid YAML: illegal map value; tabs cannot indent, use spaces");
  CHECK(parse_fault("a: &a {b: 1}\nc:\n  <<: *a\n") ==
        "f:3:3: merging maps by << is not supported; write the keys out");
  // Newer versions of yaml-cpp name it.
  CHECK_THAT(parse_fault("a: *none\n"),
             Catch::StartsWith("f:1:4: not valid YAML: the referenced anchor is not defined"));
  CHECK(parse_fault("# only a comment\n") == "f: is empty; a config is a map of keys and values");
  CHECK(parse_fault("word") == "f:1:1: a config must begin with a map of keys and values");
  CHECK(parse_fault("a: 1\n---\nb: 2\n") == "f:3:1: a second document begins here; a config is one");
  // YAML::LoadAll makes documents of these for ever.
  CHECK(parse_fault("!:,") == "f:1:3: a second document begins here; a config is one");
  CHECK(parse_fault(",") == "f:1:1: a second document begins here; a config is one");
  CHECK(parse_fault(",0],[a") == "f:1:1: a second document begins here; a config is one");
  CHECK(parse_fault("[1, 2]: 3\n") == "f:1:1: a key must be a word");
  CHECK(parse_fault("a: !color 5\n") == "f:1:4: tag \"!color\" is not supported; take it out");
}

TEST_CASE("infinite and huge aliases are refused") {
  CHECK(parse_fault("a: &a [*a, *a]\n") == "f:1:4: too many nested or repeated nodes; check the aliases");
  std::string laughs = "a0: &a0 [x]\n";
  for (int i = 1; i < 12; ++i) {
    const std::string n = std::to_string(i), m = "*a" + std::to_string(i - 1);
    laughs += "a" + n + ": &a" + n + " [" + m + ", " + m + ", " + m + ", " + m + "]\n";
  }
  CHECK(parse_fault(laughs).find("too many nested or repeated nodes; check the aliases") !=
        std::string::npos);
}

TEST_CASE("a node is written in block style, and reads back the same") {
  const std::string yaml =
      "name: sphere\n"
      "note: \"a: b, \\\"c\\\" \\\\ # d\\n\"\n"
      "number_like: \"12\"\n"
      "h: 1.0e-05\n"
      "empty: {}\n"
      "none: null\n"
      "center: [0, 0.5, -1]\n"
      "energies:\n"
      "  - gravity\n"
      "  - type: membrane\n"
      "    moduli:\n"
      "      young: 80000\n"
      "  - - [1, 2]\n"
      "    - [3, 4]\n"
      "  - []\n";
  CHECK(to_yaml(parsed(yaml)) == yaml);
}

TEST_CASE("plain text with commas or braces survives being put on one line") {
  const ConfigNode node = parsed("list:\n  - a, b\n  - c}\n  - it's\n  - --\n  - 10%\n");
  REQUIRE(node.find("list")->items.size() == 5);
  CHECK(to_yaml(node) == "list: [\"a, b\", \"c}\", \"it's\", \"--\", \"10%\"]\n");
}

TEST_CASE("a path sets a value in maps and lists, making missing maps") {
  CHECK(set("a: {b: 1}", "a.b", "2") == "{a: {b: 2}}");
  CHECK(set("a: {b: 1}", "a.c", "[1, x]") == "{a: {b: 1, c: [1, x]}}");
  CHECK(set("a: 1", "b.c.d", "{e: 3}") == "{a: 1, b: {c: {d: {e: 3}}}}");
  CHECK(set("a:", "a.b", "") == "{a: {b: null}}");
  CHECK(set("list: [x, {k: 1}]", "list.1.k", "2") == "{list: [x, {k: 2}]}");
  CHECK(set("refiner: loop", "refiner.corner_angle", "30") == "{refiner: {type: loop, corner_angle: 30}}");
}

TEST_CASE("a path that leads to several items is reported, not set in the first of them") {
  const std::string two = "list: [{type: a}, {type: b, name: a}, {name: c}, a]";
  CHECK(set(two, "list.a.k", "2") ==
        "--set list.a.k: \"a\" is the type or name of several items of a list of 4, counted from 0: write "
        "the index, 0 or 1 or 3");
  CHECK(set(two, "list.c.k", "2") == "{list: [{type: a}, {type: b, name: a}, {name: c, k: 2}, a]}");
}

TEST_CASE("a path that does not exist is reported") {
  CHECK(set("a: 1", "a..b", "2") == "--set a..b: the path has an empty name");
  CHECK(set("a: 1", "", "2") == "--set : the path has an empty name");
  CHECK(set("list: [x]", "list.1", "2") ==
        "--set list.1: \"1\" is not an index of a list of 1, counted from 0");
  CHECK(set("list: [x]", "list.k", "2") ==
        "--set list.k: \"k\" is neither an index of a list of 1, counted from 0, nor the type or name of an "
        "item");
}

TEST_CASE("every location knows the path of its key, as --set takes it") {
  ConfigNode node = parsed("a: {b: 1, list: [2, {c: 3}]}");
  node.name_keys();
  const ConfigNode& a = *node.find("a");
  CHECK(node.where.key.empty());
  CHECK(a.find("b")->where.key == "a.b");
  CHECK(a.key_locations[1].key == "a.list");
  CHECK(a.find("list")->items[1].find("c")->where.key == "a.list.1.c");
  CHECK(Location{"", 0, 0, "a.b"}.text() == "a.b");
  CHECK(Location{"f", 2, 0, "a.b"}.text() == "f:2");
}

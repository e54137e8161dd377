#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "core/app/experiment/describe.h"
#include "core/app/files/yaml_file.h"
#include "core/kernel/plugin/number_parameters.h"

using namespace drape;

namespace {

enum class Mode { clamp, absolute };

struct Ball {
  double radius = 0.3;
  static void declare(Declaration<Ball>& d) { d.add("radius", &Ball::radius).unit("m").above(0); }
};

DRAPE_PARAMETERS(Spring, (stiffness, 100, "N/m", 0, 1e9, "force"), (length, 0.1, "1", 0, 1e3, "ratio"));
struct DampedSpring : Spring {};

struct Everything {
  double step_size = 0.5;
  double fraction = 0.25;
  int count = 3;
  bool on = true;
  std::string label = "plain";
  std::string word = "left";
  std::vector<double> numbers = {1, 2.5};
  std::vector<int> counts;
  std::vector<std::string> labels = {"a", "1"};
  Eigen::Vector2d pair{0, 0};
  Eigen::Vector3d center{1, 2, 3};
  std::optional<double> limit;
  Mode mode = Mode::absolute;
  Ball ball;
  std::vector<Ball> balls = {Ball()};
  ConfigNode raw;

  static void declare(Declaration<Everything>& d) {
    using E = Everything;
    d.add("step_size", &E::step_size, "step of the flow").unit("s").above(0).source("PCS eq. 2");
    d.add("fraction", &E::fraction).unit("1").at_least(0).below(1);
    d.add("count", &E::count).between(1, 10);
    d.add("on", &E::on);
    d.add("label", &E::label);
    d.add("word", &E::word).choices({"left", "right", "middle"});
    d.add("numbers", &E::numbers).at_most(100);
    d.add("counts", &E::counts);
    d.add("labels", &E::labels);
    d.add("pair", &E::pair);
    d.add("center", &E::center).unit("m");
    d.add("limit", &E::limit).above(1);
    d.add_choice("mode", &E::mode, {{"clamp", Mode::clamp}, {"absolute", Mode::absolute}});
    d.add_section("ball", &E::ball);
    d.add_sections("balls", &E::balls);
    d.add("raw", &E::raw);
  }
};

std::vector<std::string> faults(const Schema& schema, void* object, const std::string& yaml) {
  ConfigErrors errors;
  const ConfigNode node = parse_yaml(yaml, "f", errors);
  REQUIRE(errors.empty());
  schema.read(object, node, errors);
  std::vector<std::string> texts;
  for (const ConfigError& error : errors) texts.push_back(error.text());
  return texts;
}

/// The one error that the text gives.
std::string fault(const std::string& yaml) {
  Everything object;
  const auto texts = faults(schema_of<Everything>("newton"), &object, yaml);
  REQUIRE(texts.size() == 1);
  return texts[0];
}

Everything read(const std::string& yaml) {
  Everything object;
  const auto texts = faults(schema_of<Everything>(), &object, yaml);
  REQUIRE(texts == std::vector<std::string>());
  return object;
}

/// As it is written, on one line.
std::string line_of(Everything object) { return schema_of<Everything>().write(&object).one_line(); }

}  // namespace

TEST_CASE("every type of parameter is read") {
  CHECK(line_of(read(R"(
step_size: 25e-2
fraction: +.5
count: +7
on: false
label: 12
word: middle
numbers: [5E1, -2, 3.]
counts: [1, -2]
labels: [x, "y z"]
pair: [1, 2]
center: [4, 5, 6]
limit: 1.5
mode: clamp
ball: {radius: 2}
balls: [{radius: 3}, {}]
raw: {type: any, of: [it]}
)")) == "{step_size: 0.25, fraction: 0.5, count: 7, \"on\": false, label: \"12\", word: middle, "
        "numbers: [50, -2, 3], counts: [1, -2], labels: [x, y z], pair: [1, 2], center: [4, 5, 6], "
        "limit: 1.5, mode: clamp, ball: {radius: 2}, balls: [{radius: 3}, {radius: 0.3}], "
        "raw: {type: any, of: [it]}}");
}

TEST_CASE("omitted parameters keep their defaults") {
  Everything expected;
  expected.count = 4;
  CHECK(line_of(read("count: 4\nball:\nlimit:\n")) == line_of(expected));
}

TEST_CASE("unknown keys are reported with the nearest known one") {
  CHECK(fault("stepsize: 1") == "f:1:1: unknown key \"stepsize\" in newton; did you mean \"step_size\"?");
  CHECK(fault("count: 1\nStep-Size: 1") ==
        "f:2:1: unknown key \"Step-Size\" in newton; did you mean \"step_size\"?");
  CHECK(fault("cuont: 1") == "f:1:1: unknown key \"cuont\" in newton; did you mean \"count\"?");
  CHECK(fault("ball: {diameter: 1}") == "f:1:8: unknown key \"diameter\" in ball; known keys are radius");
  Everything object;
  CHECK(faults(schema_of<Everything>(), &object, "step: 1") ==
        std::vector<std::string>{
            "f:1:1: unknown key \"step\"; known keys are step_size, fraction, count, on, label, word, "
            "numbers, counts, labels, pair, center, limit, mode, ball, balls, raw"});
  struct Nothing {
    static void declare(Declaration<Nothing>&) {}
  } nothing;
  CHECK(faults(schema_of<Nothing>("air"), &nothing, "a: 1") ==
        std::vector<std::string>{"f:1:1: unknown key \"a\" in air; it takes no keys"});
}

TEST_CASE("wrong types are reported with the written value") {
  CHECK(fault("step_size: abc") == "f:1:12: \"step_size\" must be a number, not \"abc\"");
  CHECK(fault("step_size: 1s") == "f:1:12: \"step_size\" must be a number, not \"1s\"");
  CHECK(fault("step_size: \"1\"") == "f:1:12: \"step_size\" must be a number, not the text \"1\"");
  CHECK(fault("step_size:") == "f:1:1: \"step_size\" must be a number, not empty");
  CHECK(fault("step_size: [1]") == "f:1:12: \"step_size\" must be a number, not a list");
  CHECK(fault("step_size: +-1") == "f:1:12: \"step_size\" must be a number, not \"+-1\"");
  CHECK(fault("step_size: 0x10") == "f:1:12: \"step_size\" must be a number, not \"0x10\"");
  CHECK(fault("count: 1.5") == "f:1:8: \"count\" must be an integer, not 1.5");
  CHECK(fault("count: 99999999999") == "f:1:8: \"count\" must be an integer, not 99999999999");
  CHECK(fault("on: yes") == "f:1:5: \"on\" must be true or false, not \"yes\"");
  CHECK(fault("on: \"true\"") == "f:1:5: \"on\" must be true or false, not the text \"true\"");
  CHECK(fault("label: {a: 1}") == "f:1:8: \"label\" must be text, not a map");
  CHECK(fault("word: rihgt") ==
        "f:1:7: \"word\" must be \"left\", \"right\" or \"middle\", not \"rihgt\"; did you mean \"right\"?");
  CHECK(fault("mode: 3") == "f:1:7: \"mode\" must be \"clamp\" or \"absolute\", not 3");
  CHECK(fault("ball: 3") == "f:1:7: \"ball\" must be a map of keys and values, not 3");
  CHECK(fault("balls: {radius: 3}") == "f:1:8: \"balls\" must be a list of maps, not a map");
  CHECK(fault("balls: [3]") == "f:1:9: \"balls\" must be a map of keys and values, not 3");
}

TEST_CASE("numbers out of range are reported with the bound and its unit") {
  CHECK(fault("step_size: -1") == "f:1:12: \"step_size\" must be above 0 s, not -1");
  CHECK(fault("step_size: 0") == "f:1:12: \"step_size\" must be above 0 s, not 0");
  CHECK(fault("fraction: -0.1") == "f:1:11: \"fraction\" must be at least 0, not -0.1");
  CHECK(fault("fraction: 1") == "f:1:11: \"fraction\" must be below 1, not 1");
  CHECK(fault("count: 11") == "f:1:8: \"count\" must be at most 10, not 11");
  CHECK(fault("limit: 1") == "f:1:8: \"limit\" must be above 1, not 1");
  CHECK(fault("ball: {radius: 0}") == "f:1:16: \"radius\" must be above 0 m, not 0");
  CHECK(read("fraction: 0").fraction == 0);
  CHECK(read("count: 10").count == 10);
}

TEST_CASE("numbers must be finite") {
  for (const std::string word : {"nan", "inf", "-inf"})
    CHECK(fault("step_size: " + word) == "f:1:12: \"step_size\" must be a finite number, not " + word);
  for (const std::string word : {".nan", ".inf", "-.inf"})
    CHECK(fault("step_size: " + word) ==
          "f:1:12: \"step_size\" must be a finite number, not \"" + word + "\"");
}

TEST_CASE("lists are checked for their size and each item") {
  CHECK(fault("center: [1, 2]") == "f:1:9: \"center\" must be a list of 3 numbers, not of 2");
  CHECK(fault("center: 1") == "f:1:9: \"center\" must be a list of 3 numbers, not 1");
  CHECK(fault("pair: [1, x]") == "f:1:11: item 2 of \"pair\" must be a number, not \"x\"");
  CHECK(fault("numbers: [1, 101]") == "f:1:14: item 2 of \"numbers\" must be at most 100, not 101");
  CHECK(fault("counts: [1, 0.5]") == "f:1:13: item 2 of \"counts\" must be an integer, not 0.5");
  CHECK(fault("labels: [[]]") == "f:1:10: item 1 of \"labels\" must be text, not a list");
}

TEST_CASE("repeated and missing keys are reported, and all errors together") {
  CHECK(fault("count: 1\non: true\ncount: 2") ==
        "f:3:1: repeated key \"count\" in newton; it is first set at f:1:1");
  struct Needed {
    double density = 0, thickness = 0;
    static void declare(Declaration<Needed>& d) {
      d.add("density", &Needed::density).required();
      d.add("thickness", &Needed::thickness).required().above(0).unit("m");
    }
  } needed;
  CHECK(faults(schema_of<Needed>("material"), &needed, "thickness: -1\nthicknes: 3\n") ==
        std::vector<std::string>{"f:1:12: \"thickness\" must be above 0 m, not -1",
                                 "f:2:1: unknown key \"thicknes\" in material; did you mean \"thickness\"?",
                                 "f:1:1: \"density\" in material is required and missing"});
}

TEST_CASE("a refused value leaves the default") {
  Everything object;
  CHECK(faults(schema_of<Everything>(), &object, "step_size: -1\ncount: 5").size() == 1);
  CHECK(object.step_size == 0.5);
  CHECK(object.count == 5);
}

TEST_CASE("a declaration cannot use a name twice") {
  struct Twice {
    double a = 0;
    static void declare(Declaration<Twice>& d) {
      d.add("a", &Twice::a);
      d.add("a", &Twice::a);
    }
  };
  CHECK_THROWS_WITH(schema_of<Twice>(), "parameter \"a\" is declared twice");
}

TEST_CASE("numbers of one line each are declared in full, also for a struct that derives from theirs") {
  const Schema spring = schema_of<Spring>();
  REQUIRE(spring.parameters.size() == 2);
  CHECK(spring.parameters[0].unit == "N/m");
  CHECK(spring.parameters[0].description == "force");
  CHECK(spring.parameters[1].maximum == 1e3);
  DampedSpring damped;
  CHECK(damped.stiffness == 100);
  CHECK(faults(schema_of<DampedSpring>(), &damped, "stiffness: 7\nlength: 2e3") ==
        std::vector<std::string>{"f:2:9: \"length\" must be at most 1000, not 2e3"});
  CHECK(damped.stiffness == 7);
}

TEST_CASE("a struct is written with everything in it, and reads back") {
  Everything e;
  e.step_size = 0.1 + 0.2;
  e.limit = 1.25;
  e.label = "yes: no";
  e.mode = Mode::clamp;
  e.raw = ConfigNode::of("loop");
  CHECK(line_of(e) ==
        "{step_size: 0.30000000000000004, fraction: 0.25, count: 3, \"on\": true, label: \"yes: no\", "
        "word: left, numbers: [1, 2.5], counts: [], labels: [a, \"1\"], pair: [0, 0], center: [1, 2, 3], "
        "limit: 1.25, mode: clamp, ball: {radius: 0.3}, balls: [{radius: 0.3}], raw: loop}");
  CHECK(line_of(read(to_yaml(schema_of<Everything>().write(&e)))) == line_of(e));
}

TEST_CASE("doubles are written short and read back the same") {
  CHECK(ConfigNode::of(0.1).scalar == "0.1");
  CHECK(ConfigNode::of(8e4).scalar == "80000");
  CHECK(ConfigNode::of(1e-5).scalar == "1.0e-05");
  CHECK(ConfigNode::of(-2.5e-9).scalar == "-2.5e-09");
  std::mt19937_64 random(7);
  int tried = 0;
  while (tried < 10000) {
    const std::uint64_t bits = random();
    double value;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    ++tried;
    if (parse_number(ConfigNode::of(value).scalar) != value) FAIL("not the same: " << value);
  }
}

TEST_CASE("a page describes a shared section once, unless its defaults differ") {
  struct Small {
    Ball ball{.radius = 0.1};
    static void declare(Declaration<Small>& d) { d.add_section("ball", &Small::ball); }
  };
  struct Usual {
    Ball ball;
    static void declare(Declaration<Usual>& d) { d.add_section("ball", &Usual::ball, "thrown"); }
  };
  const SharedSection ball{schema_of<Ball>("ball"), "[Ball](#ball)"};
  const std::string usual = describe_markdown(schema_of<Usual>(), &ball);
  CHECK(usual.ends_with("\n| `ball` | section |  |  |  | thrown; see [Ball](#ball) |  |\n"));
  const std::string small = describe_markdown(schema_of<Small>(), &ball);
  CHECK(small.find("| `ball.radius` | number | `0.1` |") != std::string::npos);
  CHECK(small.find("[Ball]") == std::string::npos);
}

TEST_CASE("a schema describes sections and lists of them") {
  struct Top {
    Ball ball;
    std::vector<Ball> balls;
    std::string word = "left";
    Eigen::Vector3d center{0, 0, 0};
    std::optional<double> limit;
    double density = 0;
    static void declare(Declaration<Top>& d) {
      d.add_section("ball", &Top::ball, "the obstacle");
      d.add_sections("balls", &Top::balls);
      d.add("word", &Top::word).choices({"left", "right"});
      d.add("center", &Top::center).unit("m");
      d.add("limit", &Top::limit).unit("1");
      d.add("density", &Top::density).unit("kg/m³").required();
    }
  };
  CHECK(describe(schema_of<Top>()) ==
        "  name      type              default    unit   range\n"
        "  ball      section\n"
        "      the obstacle\n"
        "    radius  number            0.3        m      > 0\n"
        "  balls     list of sections  []\n"
        "    radius  number            0.3        m      > 0\n"
        "  word      text              left              left, right\n"
        "  center    3 numbers         [0, 0, 0]  m\n"
        "  limit     number or null    null\n"
        "  density   number            required   kg/m³\n");
  const std::string page = describe_markdown(schema_of<Top>());
  CHECK(page.find("| `ball.radius` | number | `0.3` | m | > 0 |  |  |\n") != std::string::npos);
  CHECK(page.find("| `balls[].radius` | number |") != std::string::npos);
  CHECK(json_schema(schema_of<Top>()) == nlohmann::ordered_json::parse(R"({
    "type": "object",
    "properties": {
      "ball": {"type": "object",
               "properties": {"radius": {"type": "number", "exclusiveMinimum": 0.0,
                                         "description": "[m]", "default": 0.3}},
               "additionalProperties": false, "description": "the obstacle"},
      "balls": {"type": "array",
                "items": {"type": "object",
                          "properties": {"radius": {"type": "number", "exclusiveMinimum": 0.0,
                                                    "description": "[m]", "default": 0.3}},
                          "additionalProperties": false},
                "default": []},
      "word": {"type": "string", "enum": ["left", "right"], "default": "left"},
      "center": {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3,
                 "description": "[m]", "default": [0, 0, 0]},
      "limit": {"anyOf": [{"type": "number"}, {"type": "null"}], "default": null},
      "density": {"type": "number", "description": "[kg/m³]"}},
    "additionalProperties": false, "required": ["density"]})"));
}

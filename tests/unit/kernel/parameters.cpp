#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <random>

#include "core/app/experiment/describe.h"
#include "core/kernel/files/number_text.h"
#include "tests/unit/kernel/config_faults.h"

using namespace drape;

namespace {

enum class Mode { clamp, absolute };

struct Ball {
  double radius = 0.3;
  static void declare(Declaration<Ball>& d) { d.add("radius", &Ball::radius).unit("m").above(0); }
};

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

/// All errors of reading the text into an object whose section has this name.
template <class Object>
std::string faults_in(Object& object, const std::string& yaml, const std::string& section = "") {
  ConfigErrors errors;
  schema_of<Object>(section).read(&object, node_of_yaml(yaml), errors);
  return texts_of_errors(errors);
}

struct KeyFault {
  std::string yaml, place, message;
};

/// Each text gives one error, at this line and column of the file "f".
void check_faults(const std::vector<KeyFault>& faults) {
  for (const auto& [yaml, place, message] : faults) {
    Everything object;
    CHECK(faults_in(object, yaml, "newton") == "f:" + place + ": " + message);
  }
}

Everything everything_from(const std::string& yaml) {
  Everything object;
  CHECK(faults_in(object, yaml) == "");
  return object;
}

/// As it is written, on one line.
std::string line_of(Everything object) { return schema_of<Everything>().write(&object).one_line(); }

}  // namespace

TEST_CASE("every type of parameter is read") {
  CHECK(line_of(everything_from(
            "{step_size: 25e-2, fraction: +.5, count: +7, on: false, label: 12, word: middle, "
            "numbers: [5E1, -2, 3.], counts: [1, -2], labels: [x, \"y z\"], pair: [1, 2], center: [4, 5, 6], "
            "limit: 1.5, mode: clamp, ball: {radius: 2}, balls: [{radius: 3}, {}], "
            "raw: {type: any, of: [it]}}")) ==
        "{step_size: 0.25, fraction: 0.5, count: 7, \"on\": false, label: \"12\", word: middle, "
        "numbers: [50, -2, 3], counts: [1, -2], labels: [x, y z], pair: [1, 2], center: [4, 5, 6], "
        "limit: 1.5, mode: clamp, ball: {radius: 2}, balls: [{radius: 3}, {radius: 0.3}], "
        "raw: {type: any, of: [it]}}");
}

TEST_CASE("omitted and refused parameters keep their defaults") {
  Everything expected, object;
  expected.count = 4;
  CHECK(line_of(everything_from("count: 4\nball:\nlimit:\n")) == line_of(expected));
  CHECK(faults_in(object, "step_size: -1\ncount: 4") == "f:1:12: \"step_size\" must be above 0 s, not -1");
  CHECK(line_of(object) == line_of(expected));
}

TEST_CASE("unknown keys are reported with the nearest known one") {
  check_faults({
      {"count: 1\nStep-Size: 1", "2:1", "unknown key \"Step-Size\" in newton; did you mean \"step_size\"?"},
      {"cuont: 1", "1:1", "unknown key \"cuont\" in newton; did you mean \"count\"?"},
      {"ball: {diameter: 1}", "1:8", "unknown key \"diameter\" in ball; known keys are radius"},
      {"step: 1", "1:1",
       "unknown key \"step\" in newton; known keys are step_size, fraction, count, on, label, word, "
       "numbers, counts, labels, pair, center, limit, mode, ball, balls, raw"},
  });
  struct Nothing {
    static void declare(Declaration<Nothing>&) {}
  } nothing;
  CHECK(faults_in(nothing, "a: 1", "air") == "f:1:1: unknown key \"a\" in air; it takes no keys");
  CHECK(faults_in(nothing, "a: 1") == "f:1:1: unknown key \"a\"; it takes no keys");
  CHECK(describe(schema_of<Nothing>()) == "  no parameters\n");
}

TEST_CASE("wrong types are reported with the written value") {
  const auto check_word = [](const std::string& word, const std::string& message) {
    check_faults({{"step_size: " + word, "1:12", "\"step_size\" must be " + message}});
  };
  for (const std::string word : {"1s", "+-1", "0x10"}) check_word(word, "a number, not \"" + word + "\"");
  for (const std::string word : {"nan", "inf", "-inf", "1e400", "-1e999999"})
    check_word(word, "a finite number, not " + word);
  check_word("1e-400", "above 0 s, not 1e-400");
  for (const std::string word : {".nan", ".inf", "-.inf"})
    check_word(word, "a finite number, not \"" + word + "\"");
  check_faults({
      {"step_size: \"1\"", "1:12", "\"step_size\" must be a number, not the text \"1\""},
      {"step_size:", "1:1", "\"step_size\" must be a number, not empty"},
      {"step_size: [1]", "1:12", "\"step_size\" must be a number, not a list"},
      {"count: 1.5", "1:8", "\"count\" must be an integer, not 1.5"},
      {"count: 99999999999", "1:8", "\"count\" must be an integer, not 99999999999"},
      {"on: yes", "1:5", "\"on\" must be true or false, not \"yes\""},
      {"label: {a: 1}", "1:8", "\"label\" must be text, not a map"},
      {"word: rihgt", "1:7",
       "\"word\" must be \"left\", \"right\" or \"middle\", not \"rihgt\"; did you mean \"right\"?"},
      {"mode: 3", "1:7", "\"mode\" must be \"clamp\" or \"absolute\", not 3"},
      {"ball: 3", "1:7", "\"ball\" must be a map of keys and values, not 3"},
      {"balls: {radius: 3}", "1:8", "\"balls\" must be a list of maps, not a map"},
  });
}

TEST_CASE("numbers out of range are reported with the bound and its unit, and lists item by item") {
  check_faults({
      {"step_size: 0", "1:12", "\"step_size\" must be above 0 s, not 0"},
      {"fraction: -0.1", "1:11", "\"fraction\" must be at least 0, not -0.1"},
      {"fraction: 1", "1:11", "\"fraction\" must be below 1, not 1"},
      {"count: 11", "1:8", "\"count\" must be at most 10, not 11"},
      {"limit: 1", "1:8", "\"limit\" must be above 1, not 1"},
      {"ball: {radius: 0}", "1:16", "\"radius\" must be above 0 m, not 0"},
      {"center: [1, 2]", "1:9", "\"center\" must be a list of 3 numbers, not of 2"},
      {"center: 1", "1:9", "\"center\" must be a list of 3 numbers, not 1"},
      {"pair: [1, x]", "1:11", "item 2 of \"pair\" must be a number, not \"x\""},
      {"numbers: [1, 101]", "1:14", "item 2 of \"numbers\" must be at most 100, not 101"},
      {"counts: [1, 0.5]", "1:13", "item 2 of \"counts\" must be an integer, not 0.5"},
  });
  CHECK(everything_from("fraction: 0").fraction == 0);
  CHECK(everything_from("count: 10").count == 10);
}

TEST_CASE("repeated and missing keys are reported, and all errors together") {
  check_faults({{"count: 1\non: true\ncount: 2", "3:1",
                 "repeated key \"count\" in newton; it is first set at f:1:1"}});
  struct Needed {
    double density = 0, thickness = 0;
    static void declare(Declaration<Needed>& d) {
      d.add("density", &Needed::density).required();
      d.add("thickness", &Needed::thickness).required().above(0).unit("m");
    }
  } needed;
  CHECK(faults_in(needed, "thickness: -1\nthicknes: 3\n", "material") ==
        "f:1:12: \"thickness\" must be above 0 m, not -1\n"
        "f:2:1: unknown key \"thicknes\" in material; did you mean \"thickness\"?\n"
        "f:1:1: \"density\" in material is required and missing");
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
  CHECK(line_of(everything_from(to_yaml(schema_of<Everything>().write(&e)))) == line_of(e));
}

TEST_CASE("doubles are written short and read back the same") {
  CHECK(ConfigNode::of(0.1).scalar == "0.1");
  CHECK(ConfigNode::of(8e4).scalar == "80000");
  CHECK(ConfigNode::of(-2.5e-9).scalar == "-2.5e-09");
  std::mt19937_64 random(7);
  for (int tried = 0; tried < 10000;) {
    const std::uint64_t bits = random();
    double value;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    ++tried;
    if (parse_number(ConfigNode::of(value).scalar) != value) FAIL("not the same: " << value);
  }
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
      d.add("word", &Top::word, "one | other").choices({"left", "right"}).source("Loop 1987");
      d.add("center", &Top::center).unit("m");
      d.add("limit", &Top::limit).unit("1");
      d.add("density", &Top::density).unit("kg/m³").required();
    }
  };
  const Schema schema = schema_of<Top>();
  CHECK(describe(schema) ==
        "  name      type              default    unit   range\n"
        "  ball      section\n"
        "      the obstacle\n"
        "    radius  number            0.3        m      > 0\n"
        "  balls     list of sections  []\n"
        "    radius  number            0.3        m      > 0\n"
        "  word      text              left              left, right\n"
        "      one | other [Loop 1987]\n"
        "  center    3 numbers         [0, 0, 0]  m\n"
        "  limit     number or null    null\n"
        "  density   number            required   kg/m³\n");
  const std::string page = describe_markdown(schema);
  CHECK(page.find("|`ball.radius`|number [m], > 0|`0.3`||\n") != std::string::npos);
  CHECK(page.find("|`balls[].radius`|number [m], > 0|") != std::string::npos);
  CHECK(page.find("|`word`|text: left, right|`left`|one \\| other [Loop 1987]|\n") != page.npos);
  CHECK(page.find("|`limit`|number|`null`||\n") != page.npos);
  CHECK(page.find("|`density`|number [kg/m³]|required||\n") != page.npos);

  const std::string ball_json = R"("type": "object", "properties": {"radius": {"type": "number",
    "exclusiveMinimum": 0.0, "description": "[m]", "default": 0.3}}, "additionalProperties": false)";
  CHECK(json_schema(schema) == nlohmann::ordered_json::parse(R"({
    "type": "object",
    "properties": {
      "ball": {)" + ball_json + R"(, "description": "the obstacle"},
      "balls": {"type": "array", "items": {)" + ball_json + R"(}, "default": []},
      "word": {"type": "string", "enum": ["left", "right"], "description": "one | other", "default": "left"},
      "center": {"type": "array", "items": {"type": "number"}, "minItems": 3, "maxItems": 3,
                 "description": "[m]", "default": [0, 0, 0]},
      "limit": {"anyOf": [{"type": "number"}, {"type": "null"}], "default": null},
      "density": {"type": "number", "description": "[kg/m³]"}},
    "additionalProperties": false, "required": ["density"]})"));
}

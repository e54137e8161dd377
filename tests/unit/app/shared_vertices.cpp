#include <catch2/catch.hpp>

#include "tests/support/refusal.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// A sheet of 0.4 m whose pins (or handles) hold its left and its lower side, so that both select vertex 0.
std::string two_sides(const std::string& left, const std::string& lower, const std::string& more = "",
                      const std::string& key = "pins") {
  return "name: sides\ncloth: {shape: square, side: 0.4, columns: 5, rows: 5}\nlevels: 2\nstart: {translate: "
         "[0, 0, 0.3]}\n" +
         key + ":\n  - {region: box, lower: [-1, -1, -1], upper: [0.001, 1, 1]" + left +
         "}\n  - {region: box, lower: [-1, -1, -1], upper: [1, 0.001, 1]" + lower +
         "}\nenergies: [neo_hookean, hinge, gravity]\nmethods: {newton: {}}\n" + more;
}

std::string refusal(const std::string& experiment) {
  return refusal_of([&] { scene_from(experiment); });
}

}  // namespace

TEST_CASE(
    "Two pins or handles that want a vertex at different places are refused, with both and the vertex") {
  using Catch::Contains;
  for (const auto& [key, word] : {std::pair("pins", "pin"), {"handles", "handle"}}) {
    INFO(key);
    const std::string said =
        refusal(two_sides(", translate: [0, 0, 0.3]", ", translate: [0, 0, 0.31]", "", key));
    CHECK_THAT(said,
               Contains(":7:") && Contains(std::string(word) + " 1 (box, line 7) and " + word +
                                           " 0 (box, line 6) both select vertex 0 of level 0, at rest at "
                                           "(0, 0, 0), but want it at (0, 0, 0.31) and at (0, 0, 0.3)"));
    CHECK(std::count(said.begin(), said.end(), '\n') == 0);
  }
  // One stays where the start has it, and the other is moved from the rest shape.
  CHECK_THAT(refusal(two_sides("", ", translate: [0, 0, 0]")), Contains("(0, 0, 0) and at (0, 0, 0.3)"));
  CHECK_THAT(refusal(two_sides("", ", rotate: [0, 0, 90]")), Contains("both select vertex 0"));
}

TEST_CASE("Pins and handles may share vertices that they want at the same place") {
  CHECK(refusal(two_sides("", "")) == "");
  CHECK(refusal(two_sides("", ", translate: [0, 0, 0.3]")) == "");
  // The rotation is about the corner that they share.
  CHECK(refusal(two_sides(", rotate: [0, 30, 0], translate: [0, 0, 0.3]", ", translate: [0, 0, 0.3]")) == "");
  CHECK(refusal(two_sides(", rotate: [10, 20, 30], centre: [0.1, 0.2, 0.3]",
                          ", rotate: [370, 20, 30], centre: [0.1, 0.2, 0.3]")) == "");
  // A pin counts more than a handle, which may pull anywhere.
  CHECK(refusal(two_sides("", "", "handles: [{region: border, translate: [0, 0, 1]}]\n")) == "");
}

TEST_CASE("Pins that meet on a finer level alone are refused there") {
  const std::string said = refusal(
      "name: finer\ncloth: {shape: square, side: 0.4, columns: 5, rows: 5}\nrefiner: midpoint\nlevels: "
      "2\npins:\n"
      "  - {region: box, lower: [0, 0, 0], upper: [0.06, 1, 1]}\n"
      "  - {region: box, lower: [0.04, 0, 0], upper: [0.1, 1, 1], translate: [0, 0, 0.1]}\n"
      "energies: [neo_hookean, gravity]\nmethods: {newton: {}}\n");
  CHECK_THAT(said, Catch::Contains("of level 1, at rest at (0.05, "));
}

TEST_CASE("A schedule that moves one of two pins away from the other is refused, at its values") {
  using Catch::Contains;
  const auto keys = [](const std::string& list) { return "schedule: {steps: 4, keys: [" + list + "]}\n"; };
  const std::string left = "{parameter: pins.0.translate, times: [0, 1], values: [[0, 0, 0.3], [0, 0, 0.5]]}",
                    lower =
                        "{parameter: pins.1.translate, times: [0, 1], values: [[0, 0, 0.3], [0, 0, 0.5]]}";
  CHECK_THAT(refusal(two_sides("", "", keys(left))),
             Contains("key \"pins.0.translate\" at pseudo-time 0.382: pin 0 (box) and pin 1 (box) both "
                      "select vertex 0") &&
                 Contains(":10:"));
  // Together they move as one.
  CHECK(refusal(two_sides("", "", keys(left + ", " + lower))) == "");
  // Away and back, to where the other pin is at the key's times.
  const std::string logarithmic =
      "{parameter: pins.1.translate.2, times: [0, 1], values: [0.3, 0.5], interpolation: log}";
  CHECK_THAT(refusal(two_sides("", ", translate: [0, 0, 0.3]", keys(left + ", " + logarithmic))),
             Contains("both select vertex 0"));
  // A region that grows into another one's.
  const std::string apart =
      "name: apart\ncloth: {shape: square, side: 0.4, columns: 5, rows: 5}\nlevels: 1\npins:\n"
      "  - {region: ball, point: [0, 0, 0], radius: 0.01}\n"
      "  - {region: nearest, point: [0, 0, 0], translate: [0, 0, 0]}\n"
      "  - {region: nearest, point: [0.1, 0, 0], translate: [0, 0, 0.2]}\n"
      "energies: [neo_hookean, gravity]\nmethods: {newton: {}}\n";
  CHECK(refusal(apart) == "");
  CHECK_THAT(
      refusal(apart + keys("{parameter: pins.2.point, times: [0, 2], values: [[0.1, 0, 0], [0, 0, 0]]}")),
      Contains(
          "key \"pins.2.point\" at pseudo-time 2: pin 2 (nearest) and pin 0 (ball) both select vertex 0") &&
          Contains("pin 2 (nearest) and pin 1 (nearest)"));
}

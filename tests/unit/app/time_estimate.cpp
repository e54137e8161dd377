#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "core/app/scene/scene_summary.h"
#include "tests/support/folders.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// Of a row of a record in Markdown.
std::vector<std::string> cells_of(const std::string& row) {
  std::vector<std::string> cells;
  std::istringstream text(row);
  for (std::string cell; std::getline(text, cell, '|');) {
    const auto first = cell.find_first_not_of(' '), last = cell.find_last_not_of(' ');
    cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
  }
  return cells;
}

}  // namespace

TEST_CASE("The estimated time is within a factor of 3 of the recorded one on every shipped scene") {
  std::ifstream record(folders::source() / "benchmarks/results/scenes.md");
  int scenes = 0;
  for (std::string row; std::getline(record, row);) {
    const std::vector<std::string> cells = cells_of(row);  // | run | status | vertices | steps | seconds | …
    if (cells.size() < 6 || cells[2] != "converged") continue;
    INFO(row);
    // The estimate takes nothing from obstacles, whose meshes may not have been made.
    const Experiment experiment = experiment_in(folders::source() / "configs" / (cells[1] + ".yaml"),
                                                {{"levels", "1"}, {"obstacles", "[]"}});
    const auto scene = scene_of(experiment);
    const auto estimate = estimated_seconds(summary_of(*scene), std::stod(cells[3]));
    REQUIRE(estimate);
    CHECK(*estimate < 3 * std::stod(cells[5]));
    CHECK(*estimate > std::stod(cells[5]) / 3);
    ++scenes;
  }
  CHECK(scenes == 25);
}

TEST_CASE("Without weight or bending stiffness no time is estimated") {
  const std::string yaml =
      "name: e\ncloth: {shape: square, side: 1, vertices: 100}\nlevels: 1\nenergies: [neo_hookean, hinge]\n"
      "pins: [{region: ball, point: [0, 0, 0], radius: 0.1}]\nmethods: {newton: {}}\n";
  const Solved s = scene_from(yaml);
  CHECK(!estimated_seconds(summary_of(*s.scene), 100));
}

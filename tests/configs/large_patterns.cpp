// Sewing patterns that are large in one respect, of which the time to check them must not grow with the
// square.

#include <Eigen/Core>
#include <numbers>
#include <sstream>

#include "tests/configs/large.h"

namespace {

/// What is said of a cloth of one panel, with these stitches and further keys of the experiment.
Ended checked_panel(const std::string& panel, double edge_length, const std::string& stitches = "",
                    const std::string& keys = "", int seconds = 20) {
  std::ostringstream cloth;
  cloth << "name: large\nlevels: 1\ncloth: {shape: pattern, file: p.yaml, edge_length: " << edge_length
        << "}\n";
  const Scratch folder(cloth.str() + keys + rest_of_experiment);
  folder.write("p.yaml", "properties: {units_in_meter: 1}\npattern:\n  panels: {a: " + panel +
                             "}\n  stitches: [" + stitches + "]\n");
  return checked(folder, seconds);
}

}  // namespace

TEST_CASE("A pattern of very many edges, darts or seams is read in time") {
  const auto ring = [](int count) {
    std::ostringstream text;
    text << "{vertices: {";
    for (int k = 0; k < count; ++k)
      text << "v" << k << ": [" << 50 * std::cos(2 * std::numbers::pi * k / count) << ", "
           << 50 * std::sin(2 * std::numbers::pi * k / count) << "], ";
    text << "}, edges: {";
    for (int k = 0; k < count; ++k) text << "e" << k << ": [v" << k << ", v" << (k + 1) % count << "], ";
    return text.str() + "}}";
  };
  CHECK(checked_panel(ring(30000), 1).exit_code == 0);
  const Ended faulty = checked_panel(ring(5000), 1, repeated(20000, [](int) { return "[a.x, a.y], "; }));
  CHECK_THAT(faulty.err, Contains("panel a has no edge \"x\"") && Contains("error: and "));
}

TEST_CASE("Panels that are hollow, tall or toothed, labels and names are checked in time, or refused") {
  const auto loops = [](const std::vector<std::vector<Eigen::Vector2d>>& all) {
    std::ostringstream vertices, edges;
    int first = 0;
    for (const auto& loop : all) {
      const auto count = static_cast<int>(loop.size());
      for (int k = 0; k < count; ++k) {
        vertices << "[" << loop[k].x() << ", " << loop[k].y() << "], ";
        edges << "[" << first + k << ", " << first + (k + 1) % count << "], ";
      }
      first += count;
    }
    return "{vertices: [" + vertices.str() + "], edges: [" + edges.str() + "]}";
  };
  const auto ring = [](double radius) {
    std::vector<Eigen::Vector2d> loop;
    for (int k = 0; k < 400; ++k)
      loop.emplace_back(radius * std::cos(k * std::numbers::pi / 200),
                        radius * std::sin(k * std::numbers::pi / 200));
    return loop;
  };
  CHECK(checked_panel(loops({ring(300), ring(299)}), 0.3).exit_code == 0);
  CHECK(checked_panel(loops({{{0, 0}, {1, 0}, {1, 9e4}, {0, 9e4}}}), 1, "", "", 5).exit_code == 0);
  std::vector<Eigen::Vector2d> comb = {{-1, -1}};
  for (int k = 0; k < 20000; ++k) comb.emplace_back(k % 2 == 0 ? 0 : 100, 0.01 * k);
  comb.emplace_back(-1, 200);
  std::ranges::reverse(comb);
  CHECK(checked_panel(loops({comb}), 50).exit_code == 0);
  const std::string labelled =
      "{vertices: [[0, 0], [100, 0], [100, 0.1], [0, 0.1]], edges: [{endpoints: [0, 1], label: hem}, [1, 2], "
      "[2, 3], [3, 0]]}";
  const std::string pin = "{region: label, label: hem}, ";
  CHECK(checked_panel(labelled, 0.01, "", "pins: [" + pin + "]\n").exit_code == 0);
  CHECK_THAT(
      checked_panel(labelled, 0.01, "", "pins: [" + repeated(9000, [&](int) { return pin; }) + "]\n").err,
      Contains("the labels of pins and handles have more than 50000 edges"));
  const std::string name(30000, 'a');
  const std::string named = "{vertices: [[0, 0], [1, 0], [1, 1]], edges: [{endpoints: [0, 1], name: " + name +
                            "b}, [1, 2], [2, 0]]}";
  CHECK_THAT(checked_panel(named, 1, "[a." + name + ", a.1]").err, Contains("panel a has no edge"));
}

TEST_CASE("A pattern that is too large for the machine is refused before it is meshed") {
  const std::string square =
      "vertices: [[0, 0], [20, 0], [20, 20], [0, 20]], edges: [{endpoints: [0, 1], label: "
      "hem}, [1, 2], [2, 3], [3, 0]]}";
  const Scratch folder(
      "name: large\nlevels: 1\ncloth: {shape: pattern, file: p.yaml, edge_length: 0.02}\npins: "
      "[{region: label, label: hem}]\n" +
      rest_of_experiment);
  folder.write("p.yaml", "properties: {units_in_meter: 1}\npattern:\n  panels: {a: {" + square +
                             ", b: {translation: [30, 0, 0], " + square + "}\n");
  for (const std::string faulty : {"", " --set newton.stepsize=1"}) {
    const Ended ended =
        Command("ulimit -v 8000000; ulimit -t 5; exec " + drape_command + " check e.yaml" + faulty,
                folder.path)
            .wait();
    CHECK(ended.exit_code == 2);
    CHECK_THAT(ended.err,
               Contains("level 0 would have about 2.3e+06 vertices and take about 98 GB of memory"));
  }
}

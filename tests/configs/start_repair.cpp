// `--allow-start-repair`: what is moved, by how much, and what is not.

#include <catch2/catch.hpp>

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"
#include "tests/support/solve.h"

namespace {

std::string experiment(const std::string& contact, const std::string& translate, int levels = 2) {
  return "name: repair\ncloth: {shape: square, side: 0.4, columns: 9, rows: 9}\nlevels: " +
         std::to_string(levels) + "\nstart: {translate: " + translate +
         ", perturbation: 1e-3}\nenergies: [neo_hookean, hinge, gravity]\ncontact: " + contact +
         "\nnewton: {max_steps: 2}\nmethods: {newton: {}}\n";
}

std::string ball_at(const std::string& centre) {
  return "shapes\nobstacles: [{name: ball, shape: sphere, radius: 0.1, translate: " + centre + "}]";
}

/// The way that the message says, after a check that must succeed.
Eigen::Vector3d moved(const std::string& text) {
  const Scratch folder(text);
  const Ended plain = drape_with("check e.yaml", folder.path);
  const Ended ended = drape_ends("check e.yaml --allow-start-repair", folder);
  if (ended.err.empty()) {
    CHECK(plain.exit_code == 0);
    return Eigen::Vector3d::Zero();
  }
  Eigen::Vector3d way;
  char end = 0;
  const int read =
      std::sscanf(ended.err.c_str(), "start moved by (%lf, %lf, %lf) m; it touches nothing now%c", &way.x(),
                  &way.y(), &way.z(), &end);
  REQUIRE(read == 4);
  CHECK(end == '\n');
  CHECK(std::count(ended.err.begin(), ended.err.end(), '\n') == 1);
  return way;
}

std::string repair_refusal(const std::string& text) {
  const Scratch folder(text);
  const std::string said = refused_by("run e.yaml --out out --allow-start-repair", folder.path);
  CHECK(!std::filesystem::exists(folder / "out"));
  return said;
}

}  // namespace

TEST_CASE("a start in a ball is moved up, no further than needed, and recorded so that it runs again") {
  const Scratch folder(experiment(ball_at("[0, 0, 0]"), "[-0.2, -0.2, 0.06]", 3));
  const std::string options = " --quiet --no-report --threads 1 --out ";
  drape_ends("run e.yaml" + options + "out", folder, 2);
  const Ended first = drape_with("run e.yaml --allow-start-repair" + options + "first", folder.path);
  CHECK(first.exit_code == 1);  // two steps are no equilibrium
  CHECK_THAT(first.err,
             Catch::Matches("start moved by \\(0, 0, 0\\.04[0-9]*\\) m; it touches nothing now\n"));
  const std::string config = text_of(folder / "first/config.yaml");
  CHECK_THAT(config, Catch::Contains("translate: [-0.2, -0.2, 0.10"));

  const Ended second = drape_ends("run first/config.yaml" + options + "second", folder, 1);
  CHECK(second.err == "");
  CHECK(text_of(folder / "second/config.yaml") == config);
  for (const std::string level : {"0", "1", "2"})
    CHECK((text_of(folder / ("first/levels/newton_l" + level + ".ply")) ==
           text_of(folder / ("second/levels/newton_l" + level + ".ply"))));

  const Solved s = scene_from(config);
  double smallest_gap = 1;
  for (std::size_t l = 0; l < s.scene->starts.size(); ++l) {
    const drape::Positions& x = s.scene->starts[l];
    for (const auto& contact : s.scene->models[l]->contacts())
      CHECK(contact->build_candidates(x, x)->build_collisions(x)->contact_count() == 0);  // none within d̂
    smallest_gap = std::min(smallest_gap, x.rowwise().norm().minCoeff() - 0.1);
  }
  CHECK(smallest_gap >= 1e-3);
  CHECK(smallest_gap < 5e-3);
}

TEST_CASE("a start that touches nothing stays where it is, one within a micrometre does not") {
  const std::string floor = "shapes\nobstacles: [{shape: half_space}]";
  const auto at = [&](const std::string& height) {
    return replaced(experiment(floor, "[0, 0, " + height + "]"), "perturbation: 1e-3", "perturbation: 0");
  };
  CHECK(moved(at("0.5e-3")).isZero(0));
  CHECK(moved(at("2e-6")).isZero(0));
  for (const std::string height : {"1e-7", "0", "-1e-7", "-0.1", "-0.3"}) {
    INFO(height);
    const Eigen::Vector3d way = moved(at(height));
    const double needed = 1e-3 - std::stod(height);
    CHECK(way.head<2>().isZero(0));
    CHECK(way.z() >= needed * (1 - 1e-3));  // as printed
    CHECK(way.z() < 1.03 * needed);
  }
}

TEST_CASE("under a ceiling a start is moved to a side") {
  const std::string ceiling =
      "shapes\nobstacles: [{shape: half_space, normal: [0, 0, -1], translate: [0, 0, 0.05]}, {name: ball, "
      "shape: sphere, radius: 0.1, translate: [0, 0, -0.05]}]";
  const Eigen::Vector3d right = moved(experiment(ceiling, "[-0.1, -0.2, 0]"));
  CHECK(right.x() > 0.1);
  CHECK(right.x() < 0.2);
  CHECK((right.y() == 0 && right.z() == 0));
  const std::string walled = replaced(ceiling, "obstacles: [",
                                      "obstacles: [{shape: half_space, normal: [-1, 0, 0], "
                                      "translate: [0.31, 0, 0]}, ");
  const Eigen::Vector3d left = moved(experiment(walled, "[-0.1, -0.2, 0]"));
  CHECK(left.x() < -0.3);
  CHECK((left.y() == 0 && left.z() == 0));
}

TEST_CASE("a start is not moved into a closed mesh, nor into one that faces inwards") {
  const Scratch folder;
  drape::TriangleMesh inwards = drape::unit_sphere(4);
  inwards.triangles.col(1).swap(inwards.triangles.col(2));
  write_mesh(folder / "shell.ply", inwards);
  for (const std::string& shell :
       {std::string("meshed_shape: sphere, radius: 1"), "mesh: " + (folder / "shell.ply").string()}) {
    INFO(shell);
    // A cloth through the lowest part of a shell: a little further up nothing would touch.
    const std::string contact = "ipc\nobstacles: [{name: shell, " + shell + ", translate: [0, 0, 0.98]}]";
    const Eigen::Vector3d way = moved(experiment(contact, "[-0.2, -0.2, 0]"));
    CHECK(way.z() == 0);
    CHECK(way.head<2>().norm() > 0.1);
  }
}

TEST_CASE("a start with pins is not translated") {
  const std::string pinned =
      experiment(ball_at("[0, 0, 0]"), "[-0.2, -0.2, 0.06]") + "pins: [{point: [0, 0, 0]}]\n";
  const std::string said = repair_refusal(pinned);
  CHECK_THAT(said, Catch::StartsWith("error: e.yaml:4:8: the start of level 0 touches: cloth triangle ") &&
                       Catch::Contains(" and ball: sphere at (") &&
                       Catch::EndsWith("; a cloth with pins is not moved: move the pins or "
                                       "the obstacle\n"));
  CHECK(moved(replaced(pinned, "0.06]", "0.12]")).isZero(0));
}

TEST_CASE("a start without a free position is refused, with the pairs") {
  const auto between = [](const std::string& top) {
    return "shapes\nobstacles: [{name: top, shape: half_space, normal: [0, 0, -1], translate: [0, 0, " + top +
           "]}, {name: bottom, shape: half_space}]";
  };
  const std::string ways = "error: e.yaml:4:8: moving the start by up to 0.566 m up or to a side ";
  // A gap below what the noise needs: the top is met everywhere.
  CHECK_THAT(repair_refusal(experiment(between("0.001"), "[0, 0, 0]")),
             Catch::StartsWith(ways + "does not part cloth triangle ") &&
                 Catch::Contains(" and top: half_space at (") &&
                 Catch::EndsWith(" on level 0; change the start's shape or the obstacle\n"));
  // No gap: low down the bottom is met, high up the top.
  CHECK_THAT(
      repair_refusal(experiment(between("-0.005"), "[0, 0, -0.02]")),
      Catch::StartsWith(ways + "finds no position without intersections; at the start these intersect: cloth "
                               "triangle 0 and bottom: half_space at (") &&
          Catch::EndsWith(" on level 0\n"));
}

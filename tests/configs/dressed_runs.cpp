// Garments that are dressed: killed in each phase, on any number of threads, symmetric, narrow, and refused
// in a sentence.

#include "core/numerics/elements/vertex_fields.h"
#include "tests/configs/killed_dressings.h"
#include "tests/support/any_threads.h"
#include "tests/support/refusal.h"
#include "tests/support/solve.h"
#include "tests/support/tube_dress.h"

using namespace drape;

namespace {

constexpr const char* cloth =
    "material: {density: 300, thickness: 5e-4, membrane_modulus: 4e5, bending_modulus: 1e5}\n"
    "energies: [neo_hookean, hinge, gravity]\n";

/// A tube that would fall, held by the top of its front.
const std::string held =
    "pins: [{region: box, lower: [-1, -1, 0.099], upper: [1, -0.01, 1]}]\n" + std::string(cloth);

/// The experiment in a folder with these changes, solved by its method.
Solved dressed_in(const Scratch& folder, const Overrides& overrides = {}) {
  return solved(experiment_in(folder / "e.yaml", overrides));
}

TubeDress small_tube() { return {.columns = 8, .rows = 5, .facets = 24}; }

/// A tube of four panels around an upright cylinder, each of `width` and the mirror image of its neighbours.
std::string mirrored_pattern(double width) {
  const std::string w = std::to_string(width), top = std::to_string(0.9 * width);
  const std::string left = "vertices: {a: [0, 0], b: [" + w + ", 0], c: [" + top +
                           ", 0.2], d: [0, 0.18]}, edges: {hem: [a, b], side: [b, c], top: [c, d], middle: "
                           "[d, a]}}\n",
                    right = "vertices: {a: [0, 0], b: [-" + w + ", 0], c: [-" + top +
                            ", 0.2], d: [0, 0.18]}, edges: {hem: [b, a], middle: [a, d], top: [d, c], side: "
                            "[c, b]}}\n",
                    front = "{translation: [0, -0.2, -0.1], rotation: [90, 0, 0], ",
                    back = "{translation: [0, 0.2, -0.1], rotation: [90, 0, 180], ";
  return "properties: {units_in_meter: 1, up: z}\npattern:\n  panels:\n    front_left: " + front + left +
         "    front_right: " + front + right + "    back_left: " + back + right + "    back_right: " + back +
         left +
         "  stitches:\n    front: [front_left.middle, front_right.middle]\n    back: [back_left.middle, "
         "back_right.middle]\n    left: [front_left.side, back_left.side]\n    right: [front_right.side, "
         "back_right.side]\n";
}

std::string of_pattern(const Scratch& folder) {
  return "{shape: pattern, file: " + (folder / "tube.yaml").string() + ", edge_length: 0.03}";
}

std::string refused(const TubeDress& tube) {
  const Scratch folder;
  tube.write(folder, cloth);
  return refusal_of([&] { scene_of(experiment_in(folder / "e.yaml")); });
}

}  // namespace

TEST_CASE("A dressing that is killed in each phase resumes to the same bits") {
  const Scratch folder;
  small_tube().write(folder, replaced(held, "gravity]", "gravity, {type: strain_limit, limit: 1.3}]"));
  check_killed_in(folder, {"growth", "sewing", "limit", "weight"});
}

TEST_CASE("A dressing that is killed by the system in each phase resumes to the same bits") {
  const Scratch folder;
  TubeDress tube;
  tube.columns = 24, tube.rows = 18;
  tube.write(folder, held);
  const std::string run = "run e.yaml -j 1 --no-report --measure -q --checkpoint 0 --out ";
  drape_ends(run + "whole", folder);
  const auto times_in = [&](const std::string& out) {
    const Csv rows(folder / (out + "/iterations.csv"));
    std::vector<double> times;
    for (std::size_t k = 0; k < rows.size(); ++k) times.push_back(rows.number(k, "time").value());
    return times;
  };
  const std::vector<double> whole = times_in("whole");
  for (const double begun : {0, 10, 40}) {  // growth, sewing, weight
    INFO(begun);
    const auto first = std::ranges::count_if(whole, [&](double time) { return time <= begun; });
    DrapeAtWork command(run + "part", folder);
    wait_for_lines(command, folder / "part/iterations.csv", static_cast<int>(first) + 2);
    REQUIRE(command.ended_by(SIGKILL).exit_code == 128 + SIGKILL);
    CHECK(times_in("part").size() < whole.size());
    drape_ends("run --resume part --no-report --measure -q -j 1", folder);
    check_equal(folder / "part", folder / "whole");
    std::filesystem::remove_all(folder / "part");
  }
}

TEST_CASE("Energies of a garment are measured by its elastic energy, not by the strain of its placement") {
  const Scratch folder;
  small_tube().write(folder, replaced(held, "gravity]\n", "gravity]\nsnapshots: 4\n"));
  drape_ends("run e.yaml -o out --set levels=2 --no-report --measure -q", folder);
  const Json method = read_results(folder / "out")["methods"]["newton"];
  for (const Json& level : method["levels"]) {
    CHECK(level["energy_released"].is_null());
    CHECK(level["energy_parts_released"].is_null());
  }
  for (const Json& increment : method["increments"]) CHECK(increment["energy_released"].is_null());
  const Json &coarse = method["levels"][0], &finest = method["levels"][1], &parts = finest["energy_parts"];
  const double above = coarse["energy_on_finest"].get<double>() - finest["energy_on_finest"].get<double>(),
               elastic = parts["neo_hookean"].get<double>() + parts["hinge"].get<double>();
  REQUIRE(elastic > 0);
  const Json rows = Json::parse(drape_ends("table out --format json", folder).out);
  CHECK(rows[0]["preview_energy_gap"].get<double>() == Approx(above / elastic).epsilon(1e-6));
  CHECK(rows[0]["pass"] == true);
}

TEST_CASE("A garment that is narrower than its body is sewn without a struggle") {
  TubeDress narrow = small_tube();
  narrow.width = 0.22;
  const Scratch folder;
  narrow.write(folder, cloth);
  const Solved s = dressed_in(folder);
  INFO(s.levels[0].message);
  CHECK(s.levels[0].outcome == Outcome::converged);
  CHECK(s.levels[0].iterations < 200);  // 685 where increments do not wait for a cloth that contact holds up
}

TEST_CASE("A garment that is too tight for its body is refused once it is sewn, by panel and seam") {
  TubeDress narrow{.columns = 16, .rows = 10, .facets = 24};
  narrow.width = 0.26;  // half of the tube, which the body stretches by some 20 %
  const Scratch folder;
  narrow.write(folder, cloth);
  folder.write("tube.yaml", mirrored_pattern(0.13));
  const auto message = [&](const Overrides& overrides) {
    const Solved s = dressed_in(folder, overrides);
    for (const LevelResult& level : s.levels) {
      INFO("level " << level.level);
      REQUIRE(level.outcome == Outcome::infeasible);
      CHECK(level.load_stepping.increment == s.levels[0].load_stepping.increment);
    }
    CHECK(s.scene->load_stepping->phase() == "sewing");
    return s.levels.back().message;
  };
  const std::string stretched =
      ",? is stretched by more than (2|3)[0-9](\\.[0-9])? %, and 10 % is allowed; .*";
  for (const Overrides& finer : {Overrides{}, Overrides{{"levels", "2"}},
                                 Overrides{{"hierarchy", "{coarsen: 1}"}}}) {  // each level is dressed anew
    Overrides all = finer;
    all.emplace_back("dress.largest_stretch", "0.1");
    CHECK_THAT(
        message(all),
        Catch::Matches("the garment is too tight for its body: a tenth of piece (front|back)" + stretched));
  }
  CHECK_THAT(message({{"dress.largest_stretch", "0.1"}, {"cloth", of_pattern(folder)}}),
             Catch::Matches(".*tube.yaml:[4-7]:[0-9]+: the garment is too tight for its body: a tenth of "
                            "panel [a-z_]+, by its seam [a-z]+ \\(.*tube.yaml:(9|10|11|12):[0-9]+\\)" +
                            stretched));
}

TEST_CASE("A symmetric garment has symmetric energies at the start of its dressing") {
  const Scratch folder;
  TubeDress tube = small_tube();
  tube.write(folder, cloth);
  folder.write("tube.yaml", mirrored_pattern(0.16));
  const Experiment experiment = experiment_in(folder / "e.yaml", {{"cloth", of_pattern(folder)}});
  const auto scene = scene_of(experiment);
  const Positions& x = scene->starts[0];
  const Eigen::RowVector3d mirror(-1, 1, 1);
  const auto mirrored = [&](const Eigen::RowVector3d& p) -> Eigen::RowVector3d {
    return p.cwiseProduct(mirror);
  };
  std::vector<int> other;  // vertex, on the other side
  for (const auto& p : x.rowwise()) {
    Eigen::Index nearest = 0;
    CHECK((x.rowwise() - mirrored(p)).rowwise().norm().minCoeff(&nearest) < 1e-12);
    other.push_back(static_cast<int>(nearest));
  }
  // Moved by a smooth field that has no symmetry, and by its mirror image.
  Positions moved = x, image = x;
  for (int v = 0; v < x.rows(); ++v)
    moved.row(v) += 2e-3 * Eigen::RowVector3d(std::sin(9 * x(v, 0) + 4 * x(v, 2)), std::cos(7 * x(v, 1)),
                                              std::sin(8 * x(v, 0) - 5 * x(v, 1)));
  for (int v = 0; v < x.rows(); ++v) image.row(v) = mirrored(moved.row(other[v]));
  REQUIRE((moved - image).norm() > 1e-3);
  scene->load_stepping->begin(0, true);
  for (const auto& model : {scene->load_stepping->model(0), scene->models[0]}) {
    const auto one = model->energy_parts(moved), two = model->energy_parts(image);
    for (std::size_t k = 0; k < one.size(); ++k) {
      INFO(one[k].first);
      CHECK(two[k].second == Approx(one[k].second).epsilon(1e-9).margin(1e-15));
    }
  }
}

TEST_CASE("A pin holds a garment that would fall where the sewing has left it") {
  TubeDress loose = small_tube();
  loose.width = 0.4;
  const Scratch folder;
  loose.write(folder, held);
  const Solved s = dressed_in(folder, {{"friction", "0"}});
  INFO(s.levels[0].message);
  REQUIRE(s.levels[0].outcome == Outcome::converged);
  const std::vector<DirichletVertex>& pinned = s.model().dirichlet();
  REQUIRE(pinned.size() == 7);
  for (const DirichletVertex& d : pinned) {
    CHECK(s.x().row(d.vertex) == d.target.transpose());
    CHECK(std::abs(d.target.z() - 0.1) < 0.025);  // pins are supported two centimetres lower
    CHECK(std::hypot(d.target.x(), d.target.y()) > loose.radius);
    CHECK(std::abs(d.target.y()) < 0.7 * loose.apart);  // not where it was placed
  }
}

TEST_CASE("A lining that is placed where its outer cloth is starts inside it, and stays there") {
  const Scratch folder;
  small_tube().write(folder, held);
  const std::string panel =
      "vertices: {a: [0, 0], b: [0.36, 0], c: [0.36, 0.2], d: [0, 0.2]}, edges: {hem: [a, b], right: [b, c], "
      "top: [c, d], left: [d, a]}}\n";
  const std::string facing = "rotation: [90, 0, 0], translation: [-0.18, ",
                    turned = "rotation: [90, 0, 180], translation: [0.18, ";
  folder.write("tube.yaml",
               "properties: {units_in_meter: 1, up: z}\npattern:\n  panels:\n    outer_front: {" + facing +
                   "-0.2, -0.1], " + panel + "    outer_back: {" + turned + "0.2, -0.1], " + panel +
                   "    lining_front: {" + turned + "-0.2, -0.1], " + panel + "    lining_back: {" + facing +
                   "0.2, -0.1], " + panel +
                   R"(  stitches:
    a: [outer_front.right, outer_back.left]
    b: [outer_front.left, outer_back.right]
    c: [lining_front.right, lining_back.left]
    d: [lining_front.left, lining_back.right]
    e: [outer_front.top, lining_front.top]
    f: [outer_back.top, lining_back.top]
)");
  Solved s{experiment_in(folder / "e.yaml", {{"cloth", of_pattern(folder)}}), nullptr, {}};
  s.scene = scene_of(s.experiment);
  CHECK_THAT(s.scene->garment->remark, Catch::Contains("each layer moved by"));
  const Level& level = s.scene->hierarchy.levels[0];
  Eigen::Vector2d sums(0, 0), counts(0, 0);  // of distances from the axis, of the outer cloth and the lining
  for (int t = 0; t < level.triangle_count(); ++t) {
    const bool is_lining = level.rest.piece_names.at(level.rest.piece[t]).starts_with("lining");
    for (const int v : level.rest.triangles.row(t))
      sums[is_lining] += s.scene->starts[0].row(v).head(2).norm(), counts[is_lining] += 1;
  }
  CHECK(sums[0] / counts[0] > sums[1] / counts[1] + 0.005);
  run_method(s);  // no layer passes through the other one
  INFO(s.levels[0].message);
  CHECK(s.levels[0].outcome == Outcome::converged);
}

TEST_CASE("A dressing starts from the noise of its seed") {
  const Scratch folder;
  small_tube().write(folder, cloth);
  const auto start = [&](const std::string& keys) {
    return scene_of(experiment_in(folder / "e.yaml", {{"start", keys}}))->starts[0];
  };
  const Positions plain = start("{}"), one = start("{perturbation: 1e-3, seed: 1}"),
                  two = start("{perturbation: 1e-3, seed: 2}");
  CHECK((one - plain).cwiseAbs().maxCoeff() > 1e-4);
  CHECK((one - plain).cwiseAbs().maxCoeff() < 3e-3);
  CHECK((one - two).cwiseAbs().maxCoeff() > 1e-4);
}

TEST_CASE("A garment that is dressed anew on a finer level has its pins where the sewing has left it there") {
  const Scratch folder;
  const TubeDress tube{.columns = 16, .rows = 10, .facets = 24};
  tube.write(folder, held);
  for (const Overrides& levels : {Overrides{{"levels", "2"}}, Overrides{{"hierarchy", "{coarsen: 1}"}},
                                  Overrides{{"levels", "2"}, {"hierarchy", "{coarsen: 1}"}}}) {
    const Solved s = dressed_in(folder, levels);
    INFO(levels.size() << " changes, the first of " << levels.front().key);
    for (const LevelResult& level : s.levels) {
      INFO("level " << level.level << " of " << s.levels.size() << ": " << level.message);
      CHECK(level.outcome == Outcome::converged);
    }
    REQUIRE_FALSE(s.model().dirichlet().empty());
    for (const DirichletVertex& d : s.model().dirichlet()) {
      CHECK(s.x().row(d.vertex) == d.target.transpose());
      CHECK(std::abs(d.target.y()) < 0.7 * tube.apart);  // not where it was placed
      // Outside the body, a prism, and not on a chord through it.
      CHECK(std::hypot(d.target.x(), d.target.y()) > tube.radius * std::cos(M_PI / tube.facets));
    }
  }
}

TEST_CASE("A dressing has the same bits on any number of threads") {
  const Scratch folder;
  small_tube().write(folder, cloth);
  same_with_any_threads([&] {
    const Solved s = dressed_in(folder);
    CHECK(has_converged(s.levels[0].outcome));
    return s.x();
  });
}

TEST_CASE("A strain limit comes down once the garment is sewn, and holds at its end") {
  const Scratch folder;
  small_tube().write(
      folder,
      "material: {density: 3000, thickness: 5e-4, membrane_modulus: 1e5, bending_modulus: 1e5}\n"
      "energies: [neo_hookean, hinge, gravity, {type: strain_limit, limit: 50}]\n");
  const auto dressed = [&](const std::string& limit) {
    Solved s = dressed_in(folder, {{"energies.strain_limit.limit", limit}});
    CHECK(s.scene->load_stepping->increment_count() == 10 + 30 + 12 + 1);
    return s;
  };
  const auto largest = [](const Solved& s) { return largest_stretch(s.level(), s.x()).maxCoeff(); };
  const Solved loose = dressed("50"), bound = dressed("1.14"), tight = dressed("1.13");
  CHECK(loose.levels[0].outcome == Outcome::converged);
  CHECK(largest(loose) > 1.14);
  CHECK(bound.levels[0].outcome == Outcome::converged);
  CHECK(largest(bound) < 1.14);
  // Around the body, at the distance that contact keeps, the tube is 13.2 % longer.
  CHECK(tight.levels[0].outcome == Outcome::infeasible);
  CHECK_THAT(tight.levels[0].message, Catch::Contains("cannot be completed") && Catch::Contains("triangle "));
}

TEST_CASE("What cannot be dressed is refused in a sentence") {
  TubeDress elsewhere = small_tube();
  elsewhere.at = {3, 0, 0};
  CHECK(
      refused(elsewhere).ends_with("the garment is nowhere near its body: it is 0.28 × 0.4 × 0.2 m, and the "
                                   "body 0.2 × 0.2 × 0.6 m; are the "
                                   "unit, the axis and the place of both right?"));
  TubeDress giant = small_tube();
  giant.radius = 5, giant.body_height = 30, giant.at = {1, 0, 0};
  CHECK_THAT(refused(giant), Catch::Contains("the garment is inside its body: it is 0.28 × 0.4 × 0.2 m"));
  TubeDress dwarf = small_tube();
  dwarf.radius = 1e-4, dwarf.body_height = 6e-4;
  CHECK_THAT(refused(dwarf), Catch::Contains("the garment is far too large for its body: it is 0.28 × 0.4 "));
  const TubeDress beside{.at = {0, -0.2, 0}};  // the front passes through the axis
  CHECK_THAT(refused(beside),
             Catch::Matches(".*no start is free of intersections: of all that were tried, the best "
                            "still has [0-9]+ pairs, most of piece front: .*place the pieces around "
                            "the body, not through it"));
  const Scratch folder;
  small_tube().write(folder, held);
  const auto check = [&](const std::string& set) {
    return refused_by("check e.yaml --set '" + set + "'", folder.path);
  };
  CHECK(check("dress={growth: 5}") ==
        "error: --set dress: \"growth\" in dress needs \"obstacle\"; here \"obstacle\" is not given\n");
  CHECK(
      check("dress={obstacle: body, unit: mm}")
          .starts_with("error: --set dress: \"unit\" in dress needs \"body\"; here \"body\" is not given\n"));
  CHECK_THAT(check("obstacles=[{name: body, mesh: body.obj}]"),
             Catch::StartsWith("error: e.yaml:6:8: \"body\" is also the name of obstacles[0]"));
  CHECK_THAT(
      check("dress={obstacle: figure}"),
      Catch::StartsWith("error: --set dress: \"dress\" names an obstacle \"figure\", and there is none"));
  CHECK_THAT(
      refused_by("check e.yaml --set contact=shapes --set 'obstacles=[{name: ball, shape: sphere}]' --set "
                 "'dress={obstacle: ball}'",
                 folder.path),
      Catch::Contains("\"dress\" shrinks its body, and the obstacle \"ball\" has no \"contraction\"; "));
  drape_ends("run e.yaml --no-report -q -o run", folder);
  const std::string resume = "run --no-report -q --resume run --out other --set ";
  CHECK(refused_by(resume + "friction=0.2", folder.path).starts_with("error: run/config.yaml:"));
  CHECK_THAT(refused_by(resume + "friction=0.2", folder.path),
             Catch::Contains("\"dress\" begins from pieces as they are placed, and from no other state; "));
  drape_ends(resume + "dress={}", folder);
}

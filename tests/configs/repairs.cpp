// Repairs: of a start that touches something, by `--allow-start-repair`, and of obstacles' faulty meshes.

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/configs/large.h"
#include "tests/support/meshes.h"
#include "tests/support/solve.h"

namespace {

std::string experiment(const std::string& contact, const std::string& translate) {
  return "name: repair\ncloth: {shape: square, side: 0.4, columns: 9, rows: 9}\nlevels: 2\n"
         "start: {translate: " +
         translate +
         ", perturbation: 1e-3}\nenergies: [neo_hookean, hinge, gravity]\n"
         "newton: {max_steps: 2}\nmethods: {newton: {}}\ncontact: " +
         contact + "\n";
}

const std::string repair = "--allow-start-repair";

std::string ball_at(const std::string& centre) {
  return "shapes\nobstacles: [{name: ball, shape: sphere, radius: 0.1, translate: " + centre + "}]";
}

/// The way that the message says, after a check that must succeed.
Eigen::Vector3d moved(const std::string& text) {
  const Scratch folder(text);
  const std::string said = drape_ends("check e.yaml --allow-start-repair", folder).err;
  Eigen::Vector3d way(0, 0, 0);
  if (said.empty()) {
    drape_ends("check e.yaml", folder);
    return way;
  }
  int length = 0;
  REQUIRE(std::sscanf(said.c_str(), "start moved by (%lf, %lf, %lf) m; it touches nothing now\n%n", &way.x(),
                      &way.y(), &way.z(), &length) == 3);
  CHECK(length == static_cast<int>(said.size()));
  return way;
}

/// A tube along x of `around` × `along` vertices, open at both ends and with normals that face outwards.
drape::TriangleMesh tube(double radius, double length, int around, int along) {
  drape::TriangleMesh mesh{drape::Positions(around * along, 3),
                           drape::Triangles(2 * around * (along - 1), 3)};
  for (int j = 0, t = 0; j < along; ++j)
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * M_PI * i / around;
      const int a = j * around + i, b = j * around + (i + 1) % around;
      mesh.vertices.row(a) << length * (j / (along - 1.0) - 0.5), radius * std::cos(angle),
          radius * std::sin(angle);
      if (j + 1 == along) continue;
      mesh.triangles.row(t++) << a, b, b + around;
      mesh.triangles.row(t++) << a, b + around, a + around;
    }
  return mesh;
}

/// A pyramid of 20 cm without its base; vertices 1 to 4 are its corners, 5 its tip.
const std::string pyramid =
    "v -0.1 -0.1 0\nv 0.1 -0.1 0\nv 0.1 0.1 0\nv -0.1 0.1 0\nv 0 0 0.1\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";

const std::string wild = R"(name: wild
cloth: {shape: square, side: 0.3, columns: 9, rows: 9}
levels: 1
start: {translate: [-0.15, -0.15, 0.115], perturbation: 1e-3}
energies: [neo_hookean, hinge, gravity]
contact: [ipc, shapes]
obstacles: [{name: scan, mesh: scan.obj}, {name: floor, shape: half_space, translate: [0, 0, -0.05]}]
friction: 0.3
newton: {force_tolerance: 1e-2}
check_intersections: every_step
methods: {newton: {}}
)";

}  // namespace

TEST_CASE("a start in a ball is moved up, no further than needed, and recorded so that it runs again") {
  const Scratch folder(
      replaced(experiment(ball_at("[0, 0, 0]"), "[-0.2, -0.2, 0.06]"), "levels: 2", "levels: 3"));
  refused(folder, "run e.yaml --out out");
  CHECK_THAT(
      run_into("first", folder, "--threads 1 --allow-start-repair", 1).err,  // two steps are no equilibrium
      Catch::Matches("start moved by \\(0, 0, 0\\.04[0-9]*\\) m; it touches nothing now\n" + shortfalls));
  const std::string config = text_of(folder / "first/config.yaml");
  CHECK_THAT(config, Contains("translate: [-0.2, -0.2, 0.10"));
  CHECK_THAT(
      drape_ends("run first/config.yaml --quiet --no-report --measure --threads 1 --out second", folder, 1)
          .err,
      Catch::Matches(shortfalls));
  check_same_files(folder / "first", folder / "second",
                   {"config.yaml", "levels/newton_l0.ply", "levels/newton_l1.ply", "levels/newton_l2.ply"});

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

TEST_CASE("a start that a body cuts is moved out of it by the shortest way, and to no side across it") {
  const std::string ball =
      "shapes\nobstacles: [{name: ball, shape: sphere, radius: 0.1, translate: [0, 0, $]}";
  const auto over = [&](const std::string& height, const std::string& more = "") {
    return experiment(replaced(ball, "$", height) + more + "]", "[-0.1, -0.2, 0]");
  };
  const Eigen::Vector3d up = moved(over("-0.05")), down = moved(over("0.05"));
  CHECK(up.head<2>().isZero(0));
  CHECK((up.z() > 0.05 && up.z() < 0.055));
  CHECK(down.head<2>().isZero(0));
  CHECK((down.z() < -0.05 && down.z() > -0.055));
  // At the middle of the ball neither side is nearer.
  for (const std::string height : {"0", "-0.01", "0.015"})
    CHECK_THAT(said_of(over(height), repair),
               Contains(" m frees it only across an obstacle, to another side"));
  // Under a ceiling there is no way: one to a side would draw the cloth through the ball.
  const std::string said =
      said_of(over("-0.05", ", {shape: half_space, normal: [0, 0, -1], translate: [0, 0, 0.05]}"), repair);
  CHECK_THAT(said,
             StartsWith("error: e.yaml:4:8: moving the whole start by up to 0.") &&
                 Contains(" m frees it only across an obstacle, to another side of that; at the start these "
                          "intersect: cloth triangle ") &&
                 EndsWith(" on level 0; change the start's shape or place, or the obstacle\n"));
}

TEST_CASE("a sleeve that its arm cuts a little stays around it, and one that it cuts all around is refused") {
  const Scratch folder;
  drape::TriangleMesh sleeve = tube(0.05, 0.15, 24, 7);
  write_mesh(folder / "sleeve.obj", sleeve);
  for (auto v : sleeve.vertices.rowwise()) v.tail<2>() *= 0.7 + 4 * std::abs(v.x());  // narrow in the middle
  write_mesh(folder / "narrow.obj", sleeve);
  const drape::TriangleMesh arm = tube(0.04, 0.4, 32, 9);
  write_mesh(folder / "open.obj", arm);
  drape::TriangleMesh closed = arm;
  append(closed, {{-0.2, 0, 0}, {0.2, 0, 0}}, {});
  for (int i = 0, j = 1, n = 32, top = 8 * n; i < n; ++i, j = (i + 1) % n)
    append(closed, {}, {{9 * n, j, i}, {9 * n + 1, top + i, top + j}});
  write_mesh(folder / "closed.obj", closed);
  closed.triangles.col(1).swap(closed.triangles.col(2));
  write_mesh(folder / "inwards.obj", closed);
  const auto on = [&](const std::string& cloth, const std::string& body, const std::string& place) {
    return replaced(experiment((body.starts_with("mesh") ? "{type: ipc, self_contact: false}" : "shapes") +
                                   ("\nobstacles: [{name: arm, " + body) + "}]",
                               place),
                    "{shape: square, side: 0.4, columns: 9, rows: 9}",
                    "{shape: file, file: " + (folder / cloth).string() + "}");
  };
  const std::string path = folder.path.string();
  for (const std::string& body :
       {"mesh: " + path + "/open.obj", "mesh: " + path + "/closed.obj", "mesh: " + path + "/inwards.obj",
        std::string("shape: capsule, radius: 0.04, height: 0.4, rotate: [0, 90, 0]")}) {
    INFO(body);
    // The sleeve has 1 cm of room, and is moved by 1.2 cm to a side, down, or both.
    for (const Eigen::Vector2d& off :
         {Eigen::Vector2d(0.012, 0), Eigen::Vector2d(0, -0.012), Eigen::Vector2d(-0.0085, 0.0085)}) {
      INFO(off.transpose());
      const Eigen::Vector3d way = moved(
          on("sleeve.obj", body, "[0, " + std::to_string(off[0]) + ", " + std::to_string(off[1]) + "]"));
      CHECK((way.norm() > 0.002 && way.norm() < 0.01));
      CHECK((way.tail<2>() + off).norm() < 0.01);
    }
    CHECK_THAT(said_of(on("narrow.obj", body, "[0, 0.001, 0]"), repair),
               StartsWith("error: e.yaml:4:8: moving the whole start by up to 0.") &&
                   Contains("at the start these intersect: cloth triangle ") && Contains(" and arm"));
  }
}

TEST_CASE(
    "a start is not moved across a sheet that it does not touch, whichever side of it faces the start") {
  const Scratch folder;
  const std::string corners = "v -0.3 -0.3 0.0102\nv 0.3 -0.3 0.0102\nv 0.3 0.3 0.0102\nv -0.3 0.3 0.0102\n";
  for (const std::string face : {"f 1 2 3 4\n", "f 4 3 2 1\n"}) {
    INFO(face);
    std::ofstream(folder / "roof.obj") << corners << face;
    const std::string obstacles =
        "ipc\nobstacles: [{name: floor, meshed_shape: box, size: [0.2, 0.2, 0.2], translate: [0, 0, -0.09]}, "
        "{name: roof, mesh: " +
        (folder / "roof.obj").string() + "}]";
    CHECK_THAT(said_of(experiment(obstacles, "[-0.2, -0.2, 0]"), repair),
               Contains(" m frees it only across an obstacle, to another side"));
  }
}

TEST_CASE("a start is not moved into a closed mesh, nor into one that faces inwards") {
  const Scratch folder;
  drape::TriangleMesh inwards = drape::unit_sphere(4);
  inwards.triangles.col(1).swap(inwards.triangles.col(2));
  write_mesh(folder / "shell.ply", inwards);
  for (const std::string& shell :
       {std::string("meshed_shape: sphere, radius: 1"), "mesh: " + (folder / "shell.ply").string()}) {
    INFO(shell);
    // A cloth through the lowest part of a shell: a little further up nothing would touch either.
    const Eigen::Vector3d way =
        moved(experiment("ipc\nobstacles: [{" + shell + ", translate: [0, 0, 0.98]}]", "[-0.2, -0.2, 0]"));
    CHECK(way.head<2>().isZero(0));
    CHECK((way.z() < -0.017 && way.z() > -0.023));
  }
}

TEST_CASE("a start with pins, or without a free position, is refused, with the pairs") {
  const std::string pinned =
      experiment(ball_at("[0, 0, 0]"), "[-0.2, -0.2, 0.06]") + "pins: [{point: [0, 0, 0]}]\n";
  CHECK_THAT(said_of(pinned, repair),
             StartsWith("error: e.yaml:4:8: the start of level 0 touches: cloth triangle ") &&
                 Contains(" and ball: sphere at (") && Contains("; a cloth with pins is not moved: "));
  CHECK(moved(replaced(pinned, "0.06]", "0.12]")).isZero(0));
  const auto between = [](const std::string& top) {
    return "shapes\nobstacles: [{name: top, shape: half_space, normal: [0, 0, -1], translate: [0, 0, " + top +
           "]}, {name: bottom, shape: half_space}]";
  };
  // A gap below what the noise needs; and none: low down the bottom is met, high up the top.
  for (const auto& [top, place] : {std::pair("0.001", "[0, 0, 0]"), std::pair("-0.005", "[0, 0, -0.02]")})
    CHECK_THAT(said_of(experiment(between(top), place), repair),
               StartsWith("error: e.yaml:4:8: moving the whole start by up to 0.1") &&
                   Contains(" m finds no position without intersections; at the start these intersect: ") &&
                   EndsWith(" on level 0; change the start's shape or place, or the obstacle\n"));
}

TEST_CASE("a start that crosses itself or an obstacle in very many places is checked in time") {
  const auto jagged = [](double height) {
    drape::TriangleMesh sheet = drape::grid({1, 1}, 71, 71, drape::Diagonals::one_way);
    for (Eigen::Index v = 0; v < sheet.vertices.rows(); ++v) sheet.vertices(v, 2) = v % 2 ? height : -height;
    return sheet;
  };
  const Scratch folder("name: large\nlevels: 1\ncloth: {shape: file, file: cloth.obj}\ncontact: ipc\n" +
                       rest_of_experiment);
  write_mesh(folder / "cloth.obj", both_of(jagged(0.02), jagged(-0.02), {0, 0, 0}));
  CHECK_THAT(checked(folder, 20, repair).err,
             Contains("more pairs; change the start's shape, or where its pieces lie"));
  folder.write("e.yaml", text_of(folder / "e.yaml") + "obstacles: [{mesh: spikes.obj}]\n");
  write_mesh(folder / "cloth.obj", jagged(0));
  write_mesh(folder / "spikes.obj", jagged(0.5));
  CHECK_THAT(checked(folder, 20, repair).err, Contains(" m finds no position without intersections"));
}

TEST_CASE("a cloth drapes over an obstacle that is no surface with one side up, or none at all") {
  const auto [faults, said] = GENERATE(table<std::string, std::string>({
      {"v 0.02 0 0.05\nf 5 1 6\nf 5 1 4\nv 7 7 7\nf 3 3 2\nf 1 5 3\nv 0.1 0.1 0.05\nv 0.12 0.1 0.05\nf 3 8 "
       "9\n",
       "obstacle scan: dropped "},
      {"v -0.3 0 0\nv -0.2 0 0\nv -0.2 0.1 0.02\nf 6 7 8\n", ""},
  }));
  CAPTURE(faults);
  const Scratch folder(wild);
  folder.write("scan.obj", pyramid + faults);
  CHECK_THAT(drape_ends("check e.yaml", folder).out, Contains(said));
  CHECK_THAT(drape_ends("run e.yaml --out out --no-report --measure --threads 1", folder).err,
             Contains(said));
  const auto results = results_in(folder / "out");
  CHECK(results.contains("remarks") == !said.empty());
  const auto& level = results["methods"]["newton"]["levels"][0];
  CHECK(level["status"] == "converged");
  CHECK(level["intersections"] == 0);
  CHECK(level["smallest_gap"].get<double>() > 0);
}

TEST_CASE("cages enclose a repaired obstacle, and its animation moves") {
  const std::string faults = "v 9 9 9\nv 0 -0.2 0.05\nf 1 2 5\nf 1 2 7\nf 2 2 3\n";
  const Scratch folder;
  folder.write("scan.obj", pyramid + faults);
  folder.write("higher.obj", replaced(pyramid, "v 0 0 0.1\n", "v 0 0 0.13\n") + faults);
  folder.write("caged.yaml",
               replaced(replaced(wild, "mesh: scan.obj", "mesh: scan.obj, cages: {count: 1, offset: 0.02}"),
                        "0.115]", "0.15]"));
  folder.write(
      "moving.yaml",
      replaced(wild, "mesh: scan.obj", "animation: [scan.obj, higher.obj]") +
          "schedule: {steps: 3, keys: [{parameter: obstacles.scan.frame, times: [0, 1], values: [0, 1]}]}\n");
  for (const std::string name : {"caged", "moving"}) {
    CHECK_THAT(
        drape_ends("run " + name + ".yaml --out " + name + " --no-report --measure --threads 1", folder).err,
        Contains("remark: obstacle scan: dropped 1 loose vertex, 1 doubled triangle and 1 "
                 "triangle without area; kept 1 edge between"));
    const auto level = results_in(folder / name)["methods"]["newton"]["levels"][0];
    CHECK(level["status"] == "converged");
    CHECK(level["intersections"] == 0);
  }
}

// The direction of warp: on patterns and meshes, over the levels, in files.

#include "core/numerics/mesh/grain.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/kernel/files/file.h"
#include "core/numerics/elements/green_strain.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"
#include "tests/support/evaluate.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

std::string experiment(const std::string& cloth) {
  return "name: grain\ncloth: " + cloth +
         "\nlevels: 2\nenergies: [neo_hookean, hinge, gravity]\nmethods: {newton: {}}\n";
}

double centroid_x(const TriangleMesh& mesh, Eigen::Index t) {
  double sum = 0;
  for (const int v : mesh.triangles.row(t)) sum += mesh.vertices(v, 0);
  return sum / 3;
}

/// A square that stands in the plane y = 0, with u along z and v along -x.
constexpr const char* standing =
    "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nvt 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";

}  // namespace

TEST_CASE("grain: warp turns counter-clockwise from x, in every triangle") {
  TriangleMesh mesh = grid({1, 1}, 4, 4, Diagonals::criss_cross);
  for (const double angle : {0., 30., 90., -135.}) {
    mesh.warp = warp_at(mesh, angle);
    const Positions warp = warp_directions(mesh);
    REQUIRE(warp.rows() == mesh.triangles.rows());
    const Eigen::RowVector3d expected(std::cos(angle * M_PI / 180), std::sin(angle * M_PI / 180), 0);
    CHECK((warp.rowwise() - expected).cwiseAbs().maxCoeff() < 1e-15);
  }
  mesh.warp.resize(0, 3);
  CHECK(warp_directions(mesh).col(0).isConstant(1));
  CHECK(grain_faults(mesh, GrainAxis::x, std::vector<char>(mesh.triangles.rows(), true)).empty());
}

TEST_CASE("grain: strains of a material's frame follow the grain") {
  TriangleMesh mesh = random_triangulation({1, 1}, 30, 3);
  mesh.warp = warp_at(mesh, 30);
  const Level level = Level::of(0, mesh);
  Eigen::Matrix2d f;
  f << 1.1, 0.2, -0.1, 0.9;
  const Eigen::Matrix2d c = (f.transpose() * f - Eigen::Matrix2d::Identity()) / 2;
  const Eigen::Vector2d warp(std::cos(M_PI / 6), 0.5), weft(-0.5, std::cos(M_PI / 6));
  for (int t = 0; const MaterialTriangle& m : material_triangles(level)) {
    const auto v = mesh.triangles.row(t++);
    Eigen::Vector3d e[2] = {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
    for (int k = 0; k < 2; ++k)
      e[k].head<2>() = f * (mesh.vertices.row(v[k + 1]) - mesh.vertices.row(v[0])).head<2>().transpose();
    const GreenStrain<double> g(e, m.data());
    CHECK(g.g11 == Approx(warp.dot(c * warp)));
    CHECK(g.g22 == Approx(weft.dot(c * weft)));
    CHECK(g.g12 == Approx(warp.dot(c * weft)));
  }
}

TEST_CASE("grain: every level of an experiment has it, and its files and the saved config too") {
  const Scratch folder;
  folder.write("own.yaml", experiment("{shape: rectangle, size: [0.3, 0.2], vertices: 30, grain: 30}") +
                               "pins: [{point: [0, 0, 0]}]\nnewton: {max_steps: 1}\n");
  CHECK(drape_with("run own.yaml --out out --quiet --no-report", folder.path).exit_code != 2);
  for (const char* level : {"out/rest/l0.ply", "out/rest/l1.ply"}) {
    const std::string bytes = read_file(folder / level);
    CHECK(bytes.find("property double warp_x\nproperty double warp_y\nproperty double warp_z\n") !=
          std::string::npos);
    CHECK_NOTHROW(read_mesh(folder / level));
  }
  CHECK(read_file(folder / "out/config.yaml").find("grain: 30") != std::string::npos);
  const Solved s = scene_from(experiment("{shape: disc, radius: 0.2, vertices: 50, grain: 20}"));
  for (const Level& level : s.scene->hierarchy.levels) {
    REQUIRE(level.rest.warp.rows() == level.triangle_count());
    CHECK(warp_directions(level.rest)(3, 1) == Approx(std::sin(20 * M_PI / 180)));
  }
}

TEST_CASE("grain: a mesh's pattern may be its texture coordinates") {
  const Scratch folder;
  folder.write("standing.obj", standing);
  folder.write("turned.obj", std::string(standing).replace(0, std::string(standing).find("vt"),
                                                           "v 0 0 0\nv 0 1 0\nv 0 1 1\nv 0 0 1\n"));
  const auto warp_of = [&](const std::string& cloth) {
    const Solved s = scene_from(experiment("{shape: file, file: " + (folder / cloth).string()));
    return Eigen::RowVector3d(warp_directions(s.level().rest).row(0));
  };
  CHECK(warp_of("standing.obj, grain: 0, grain_along: u}").isApprox(Eigen::RowVector3d(0, 0, 1)));
  CHECK(warp_of("standing.obj, grain_along: u}").isApprox(Eigen::RowVector3d(0, 0, 1)));
  CHECK_THROWS_WITH(warp_of("standing.obj, grain_along: file}"),
                    Catch::Contains("\"grain_along: file\" needs a PLY file"));
  CHECK(warp_of("standing.obj, grain: 0}").isApprox(Eigen::RowVector3d(1, 0, 0)));
  CHECK(warp_of("turned.obj}").isApprox(Eigen::RowVector3d(0, 1, 0)));  // normal to x, which nobody asked for
  CHECK_THROWS_WITH(warp_of("turned.obj, grain: 10}"),
                    Catch::Contains("\"grain\" has no direction in triangle 0, which is normal to x"));
  std::string plain = standing;
  for (std::size_t at; (at = plain.find("/")) != std::string::npos;) plain.erase(at, 2);
  folder.write("plain.obj", plain);
  CHECK_THROWS_WITH(warp_of("plain.obj, grain: 10, grain_along: u}"),
                    Catch::Contains("needs a mesh with texture coordinates"));
  CHECK_THROWS_WITH(scene_from(experiment("{shape: square, grain: 10, grain_along: u}")),
                    Catch::Contains("grain_along"));
}

TEST_CASE("grain: what is in the triangles' planes keeps its bits when it is projected again") {
  TriangleMesh mesh = unit_sphere(3);
  mesh.vertices *= Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  for (const double angle : {0., 30.}) {
    const Positions warp = cut_directions(mesh, GrainAxis::x, angle);
    CHECK(projected_warp(warp, mesh) == warp);
  }
}

TEST_CASE("grain: a run's own config.yaml does not turn it again") {
  const Scratch folder;
  TriangleMesh mesh = random_triangulation({1, 1}, 60, 3);
  mesh.warp = warp_at(mesh, 17);
  write_mesh(folder / "cut.ply", mesh);
  for (const std::string cut :
       {"", ", grain: 30, grain_along: file",
        ", grain_along: file, grain_regions: [{lower: [0, 0, -1], upper: [0.5, 1, 1], grain: 40}]"}) {
    INFO(cut);
    folder.write("own.yaml", experiment("{shape: file, file: cut.ply" + cut + "}") +
                                 "pins: [{point: [0, 0, 0]}]\nnewton: {max_steps: 1}\n");
    drape_with("run own.yaml --out out --overwrite --quiet --no-report", folder.path);
    drape_with("run out/config.yaml --out again --overwrite --quiet --no-report", folder.path);
    CHECK(read_file(folder / "again/rest/l0.ply") == read_file(folder / "out/rest/l0.ply"));
  }
}

TEST_CASE("grain: parts of a cloth may be cut at another angle, on every level") {
  const auto scene = [](const std::string& regions) {
    return scene_from(experiment(
        "{shape: rectangle, size: [0.4, 0.2], columns: 9, rows: 5, grain: 10, grain_regions: " + regions +
        "}"));
  };
  const Solved s = scene("[{lower: [0.2, 0, -1], upper: [0.4, 0.2, 1], grain: 55}]");
  for (const Level& level : s.scene->hierarchy.levels)
    for (int t = 0; t < level.triangle_count(); ++t) {
      const double x = centroid_x(level.rest, t);
      CHECK(level.rest.warp(t, 0) == Approx(std::cos((x > 0.2 ? 55 : 10) * M_PI / 180)));
    }
  CHECK_THROWS_WITH(scene("[{lower: [1, 1, 1], upper: [2, 2, 2], grain: 55}]"),
                    Catch::Contains("\"grain_regions\": entry 0 has no triangle's centroid"));
  CHECK_THROWS_WITH(scene("[{lower: [0, 0, 0], upper: [2, 2, 2]}]"), Catch::Contains("\"grain\""));
}

TEST_CASE("grain: a region's box holds what a rotation puts beside it by round-off") {
  const Scratch folder;
  TriangleMesh mesh = grid({0.4, 0.4}, 5, 5, Diagonals::one_way);
  mesh.vertices.col(1).array() -= 0.2;
  write_mesh(folder / "flat.ply", mesh);
  const Solved s = scene_from(
      experiment("{shape: file, rotate: [90, 0, 0], grain: 0, file: " + (folder / "flat.ply").string() +
                 ", grain_regions: [{lower: [-1, 0, -1], upper: [1, 0, 1], grain: 45}]}"));
  const auto along = s.scene->hierarchy.levels[0].rest.warp.col(0).array();
  CHECK((along - std::cos(M_PI / 4)).abs().maxCoeff() < 1e-9);
}

TEST_CASE("grain: a region needs an axis in its own triangles alone") {
  const Scratch folder;
  TriangleMesh mesh = unit_box();  // two of its faces are normal to x
  write_mesh(folder / "box.ply", mesh);
  const auto box = [&](const std::string& lower, const std::string& upper) {
    return scene_from(experiment("{shape: file, file: " + (folder / "box.ply").string() +
                                 ", grain_regions: [{lower: " + lower + ", upper: " + upper +
                                 ", grain: 30}]}"));
  };
  CHECK_NOTHROW(box("[-1, -1, 0.4]", "[1, 1, 1]"));
  CHECK_THROWS_WITH(box("[0.4, -1, -1]", "[1, 1, 1]"), Catch::Contains("which is normal to x"));
}

TEST_CASE("grain: a PLY file's faces may have directions of their own, which turn with the file") {
  const Scratch folder;
  TriangleMesh mesh = random_triangulation({1, 1}, 20, 3);
  const auto turning = [&](double more) {  // from triangle to triangle
    Positions warp(mesh.triangles.rows(), 3);
    for (Eigen::Index t = 0; t < warp.rows(); ++t)
      warp.row(t) = cut_directions(mesh, GrainAxis::x, 7. * static_cast<double>(t) + more).row(t);
    return warp;
  };
  mesh.warp = turning(0);
  write_mesh(folder / "cut.ply", mesh);
  const auto rest_of = [&](const std::string& more) {
    return scene_from(experiment("{shape: file, file: " + (folder / "cut.ply").string() + more + "}"))
        .scene->hierarchy.levels[0]
        .rest;
  };
  CHECK(rest_of("").warp.isApprox(mesh.warp));
  CHECK(rest_of(", grain: 0").warp.col(0).isConstant(1));
  CHECK(rest_of(", grain: 20, grain_along: file").warp.isApprox(turning(20)));
  const Positions part = rest_of(", grain_regions: [{lower: [0.5, 0, 0], upper: [1, 1, 0], grain: 0}]").warp;
  for (Eigen::Index t = 0; t < part.rows(); ++t) {
    const bool inside = centroid_x(mesh, t) > 0.5;
    CHECK(part.row(t).isApprox(inside ? Eigen::RowVector3d::UnitX().eval() : mesh.warp.row(t).eval()));
  }
  const TriangleMesh turned = rest_of(", rotate: [0, 0, 90]");
  CHECK((turned.warp.col(0) + mesh.warp.col(1)).cwiseAbs().maxCoeff() < 1e-12);
  folder.write(
      "plain.ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n"
      "element face 1\nproperty list uchar int vertex_indices\nproperty double warp_x\n"
      "property double warp_y\nproperty double warp_z\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0 0 1\n");
  CHECK_THROWS_WITH(
      scene_from(experiment("{shape: file, file: " + (folder / "plain.ply").string() + "}")),
      Catch::Contains("the direction of warp in triangle 0 has no part in the triangle's plane"));
}

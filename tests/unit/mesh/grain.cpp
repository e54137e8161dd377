// The direction of warp: on patterns and meshes, over the levels, in files.

#include "core/numerics/mesh/grain.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/kernel/files/file.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/evaluate.h"
#include "tests/unit/mesh/cloth_scene.h"
#include "tests/unit/mesh/mesh_files.h"

using namespace drape;
using Catch::Contains;
using Eigen::RowVector3d;

namespace {

double centroid_x(const TriangleMesh& mesh, Eigen::Index t) {
  double sum = 0;
  for (const int v : mesh.triangles.row(t)) sum += mesh.vertices(v, 0);
  return sum / 3;
}

/// A square that stands in the plane y = 0, with u along z and v along -x.
const std::string standing =
    "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nvt 0 1\nvt 0 0\nvt 1 0\nvt 1 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";

}  // namespace

TEST_CASE("grain: warp turns counter-clockwise from x, in every triangle") {
  TriangleMesh mesh = grid({1, 1}, 4, 4, Diagonals::criss_cross);
  for (const double angle : {0., 30., 90., -135.}) {
    mesh.warp = warp_at(mesh, angle);
    const Positions warp = warp_directions(mesh);
    REQUIRE(warp.rows() == mesh.triangles.rows());
    const RowVector3d expected(std::cos(angle * M_PI / 180), std::sin(angle * M_PI / 180), 0);
    CHECK((warp.rowwise() - expected).cwiseAbs().maxCoeff() < 1e-15);
  }
  mesh.warp.resize(0, 3);
  CHECK(warp_directions(mesh).col(0).isConstant(1));
  CHECK(grain_faults(mesh, GrainAxis::x, std::vector<char>(mesh.triangles.rows(), true)).empty());
}

TEST_CASE("grain: a mesh's pattern may be its texture coordinates") {
  const Scratch folder;
  folder.write("standing.obj", standing);
  folder.write("turned.obj", "v 0 0 0\nv 0 1 0\nv 0 1 1\nv 0 0 1\n" + standing.substr(standing.find("vt")));
  const auto warp_of = [&](const std::string& name, const std::string& keys) -> RowVector3d {
    return warp_directions(cloth_scene(cloth_in(folder / name, keys)).level().rest).row(0);
  };
  CHECK(warp_of("standing.obj", ", grain: 0, grain_along: u").isApprox(RowVector3d(0, 0, 1)));
  CHECK(warp_of("standing.obj", ", grain_along: u").isApprox(RowVector3d(0, 0, 1)));
  CHECK(warp_of("standing.obj", ", grain: 0").isApprox(RowVector3d(1, 0, 0)));
  CHECK(warp_of("turned.obj", "").isApprox(RowVector3d(0, 1, 0)));  // normal to x, which nobody asked for
}

TEST_CASE("grain: what is in the triangles' planes keeps its bits when it is projected again") {
  TriangleMesh mesh = unit_sphere(3);
  mesh.vertices *= Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
  for (const double angle : {0., 30.}) {
    const Positions warp = cut_directions(mesh, GrainAxis::x, angle);
    CHECK(projected_warp(warp, mesh) == warp);
  }
}

TEST_CASE("grain: a run's files have it, and its own config.yaml does not turn it again") {
  const Scratch folder;
  TriangleMesh mesh = random_triangulation({1, 1}, 60, 3);
  mesh.warp = warp_at(mesh, 17);
  write_mesh(folder / "cut.ply", mesh);
  for (const std::string cloth :
       {"{shape: rectangle, size: [0.3, 0.2], vertices: 30, grain: 30}", "{shape: file, file: cut.ply}",
        "{shape: file, file: cut.ply, grain: 30, grain_along: file}",
        "{shape: file, file: cut.ply, grain_along: file, "
        "grain_regions: [{lower: [0, 0, -1], upper: [0.5, 1, 1], grain: 40}]}"}) {
    INFO(cloth);
    folder.write("own.yaml", cloth_experiment(cloth, "pins: [{point: [0, 0, 0]}]\nnewton: {max_steps: 1}\n"));
    drape_with("run own.yaml --out out --overwrite --quiet --no-report --measure", folder.path);
    drape_with("run out/config.yaml --out again --overwrite --quiet --no-report --measure", folder.path);
    for (const std::string level : {"/rest/l0.ply", "/rest/l1.ply"}) {
      const TriangleMesh rest = read_mesh(folder / ("out" + level));
      CHECK(rest.warp.rows() == rest.triangles.rows());
      CHECK(read_file(folder / ("again" + level)) == read_file(folder / ("out" + level)));
    }
  }
}

TEST_CASE("grain: parts of a cloth may be cut at another angle, on every level") {
  const Solved s = cloth_scene(
      "{shape: rectangle, size: [0.4, 0.2], columns: 9, rows: 5, grain: 10, "
      "grain_regions: [{lower: [0.2, 0, -1], upper: [0.4, 0.2, 1], grain: 55}]}");
  for (const Level& level : s.scene->hierarchy.levels)
    for (int t = 0; t < level.triangle_count(); ++t) {
      const double angle = (centroid_x(level.rest, t) > 0.2 ? 55 : 10) * M_PI / 180;
      CHECK(level.rest.warp.row(t).isApprox(RowVector3d(std::cos(angle), std::sin(angle), 0)));
    }
}

TEST_CASE("grain: a region's box holds what a rotation puts beside it, and needs an axis in it alone") {
  const Scratch folder;
  const auto warp_of = [&](const TriangleMesh& mesh, const std::string& keys) {
    write_mesh(folder / "m.ply", mesh);
    return cloth_scene(cloth_in(folder / "m.ply", keys)).scene->hierarchy.levels[0].rest.warp;
  };
  TriangleMesh flat = grid({0.4, 0.4}, 5, 5, Diagonals::one_way);
  flat.vertices.col(1).array() -= 0.2;
  const Positions along = warp_of(flat,
                                  ", rotate: [90, 0, 0], grain: 0, grain_regions: [{lower: [-1, 0, -1], "
                                  "upper: [1, 0, 1], grain: 45}]");
  CHECK((along.col(0).array() - std::cos(M_PI / 4)).abs().maxCoeff() < 1e-9);
  // Two of a box's faces are normal to x.
  CHECK_NOTHROW(
      warp_of(unit_box(), ", grain_regions: [{lower: [-1, -1, 0.4], upper: [1, 1, 1], grain: 30}]"));
  CHECK_THROWS_WITH(
      warp_of(unit_box(), ", grain_regions: [{lower: [0.4, -1, -1], upper: [1, 1, 1], grain: 30}]"),
      Contains("which is normal to x"));
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
  const auto warp_of = [&](const std::string& keys) {
    return cloth_scene(cloth_in(folder / "cut.ply", keys)).scene->hierarchy.levels[0].rest.warp;
  };
  CHECK(warp_of("").isApprox(mesh.warp));
  CHECK(warp_of(", grain: 0").col(0).isConstant(1));
  CHECK(warp_of(", grain: 20, grain_along: file").isApprox(turning(20)));
  const Positions part = warp_of(", grain_regions: [{lower: [0.5, 0, 0], upper: [1, 1, 0], grain: 0}]");
  for (Eigen::Index t = 0; t < part.rows(); ++t)
    CHECK(part.row(t).isApprox(centroid_x(mesh, t) > 0.5 ? RowVector3d(1, 0, 0)
                                                         : RowVector3d(mesh.warp.row(t))));
  CHECK((warp_of(", rotate: [0, 0, 90]").col(0) + mesh.warp.col(1)).cwiseAbs().maxCoeff() < 1e-12);
  folder.write("plain.ply",
               ply_head(3, faces_head(1) +
                               "property double warp_x\nproperty double warp_y\nproperty double warp_z\n") +
                   "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0 0 1\n");
  CHECK_THROWS_WITH(cloth_scene(cloth_in(folder / "plain.ply")),
                    Contains("the direction of warp in triangle 0 has no part in the triangle's plane"));
}

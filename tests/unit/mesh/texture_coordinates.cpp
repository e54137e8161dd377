// Texture coordinates from a file over the levels to files again, and those of flat meshes without any.

#include "core/numerics/mesh/texture_coordinates.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/hierarchy/midpoint.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/meshes.h"
#include "tests/unit/mesh/mesh_files.h"

using namespace drape;

namespace {

/// Two squares in the plane y = 0 with a seam between them: the second one's uv begin anew at the left.
const std::string two_squares =
    "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 0 1\nv 1 0 1\nv 2 0 1\n"
    "vt 0 0.5\nvt 0.5 0.5\nvt 0.5 1\nvt 0 1\nvt 0.125 0\nvt 0.875 0.125 0\nvt 0.875 0.25\nvt 0.125 0.375\n"
    "f 1/1 2/2 5/3 4/4\nf 2/-4/1 3/6 6/7/1\nf 2/5 6/7 5/8\n";

struct MidpointSplit : Refiner {
  ProlongationMatrix weights(const Level& coarse) const override { return midpoint_weights(coarse); }
};

Eigen::RowVector2d uv_at(const TriangleMesh& mesh, Eigen::Index t, int k) {
  return mesh.uv.block<1, 2>(t, 2 * k);
}

/// The uv that two_squares has at a point of its left or right square.
Eigen::RowVector2d expected_uv(bool left, const Eigen::RowVector3d& p) {
  if (left) return {0.5 * p.x(), 0.5 + 0.5 * p.z()};
  const double x = p.x() - 1, z = p.z();
  return x >= z ? Eigen::RowVector2d(0.125 + 0.75 * x, 0.125 * x + 0.125 * z)   // triangle 2, 3, 6
                : Eigen::RowVector2d(0.125 + 0.75 * x, 0.375 * z - 0.125 * x);  // triangle 2, 6, 5
}

const TriangleMesh banner = grid({2, 0.5}, 5, 3, Diagonals::criss_cross);

Eigen::RowVector2d halved(double x, double y) { return {x / 2, y / 2}; }

/// The largest difference of the planar uv of the banner, turned and moved, and these of its vertices.
double difference(const Eigen::Matrix3d& turn, Eigen::RowVector2d (*uv)(double, double) = halved,
                  const Eigen::RowVector3d& move = {3, -2, 0.7}) {
  TriangleMesh mesh = banner;
  mesh.vertices = (banner.vertices * turn.transpose()).rowwise() + move;
  REQUIRE(PlanarUv::of(mesh));
  mesh.uv = PlanarUv::of(mesh)->at(mesh);
  double most = 0;
  for (Eigen::Index t = 0; t < mesh.uv.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto p = banner.vertices.row(mesh.triangles(t, k));
      most = std::max(most, (uv_at(mesh, t, k) - uv(p.x(), p.y())).norm());
    }
  return most;
}

}  // namespace

TEST_CASE("a face without vt has (0, 0) beside faces that have some") {
  const TriangleMesh mesh = mesh_in("m.obj",
                                    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nvt 0.25\nvt 1 1\nvt 0 1\n"
                                    "f 1 2 3\nf 2/1 4/2 3/3\nf 2 5 4\n");
  CHECK(mesh.uv == CornerUv{{0, 0, 0, 0, 0, 0}, {0.25, 0, 1, 1, 0, 1}, {0, 0, 0, 0, 0, 0}});
  CHECK(mesh_in("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 1 1\nf 1 2 3\n").uv.rows() == 0);
}

TEST_CASE("uv are refined linearly in each triangle, and a seam keeps both of its sides") {
  const Hierarchy hierarchy = Hierarchy::of(mesh_in("m.obj", two_squares), MidpointSplit(), 3);
  const TriangleMesh& finest = hierarchy.levels[2].rest;
  for (const Level& level : hierarchy.levels) {
    const Eigen::Index n = level.rest.triangles.rows();
    REQUIRE(level.rest.uv.rows() == n);
    for (Eigen::Index t = 0; t < n; ++t)
      for (int k = 0; k < 3; ++k)
        CHECK(uv_at(level.rest, t, k) ==
              expected_uv(t < n / 2, level.rest.vertices.row(level.rest.triangles(t, k))));
  }
  const UvVertices split = split_at_seams(finest);
  CHECK(split.vertex.size() == static_cast<std::size_t>(finest.vertices.rows() + 5));  // x = 1 twice
  for (Eigen::Index t = 0; t < 64; ++t)
    for (int k = 0; k < 3; ++k) {
      CHECK(split.vertex[split.triangles(t, k)] == finest.triangles(t, k));
      CHECK(split.uv.row(split.triangles(t, k)) == uv_at(finest, t, k));
    }
  const Scratch folder;
  for (const char* name : {"m.obj", "m.ply"}) {
    write_mesh(folder / name, finest);
    const TriangleMesh read = read_mesh(folder / name);
    CHECK(read.vertices == finest.vertices);
    CHECK(read.triangles == finest.triangles);
    CHECK(read.uv == finest.uv);
  }
  CHECK(Hierarchy::of(banner, MidpointSplit(), 2).levels[1].rest.uv.rows() == 0);
}

TEST_CASE("a PLY has uv at the corners of its faces or at its vertices") {
  const CornerUv uv{{0, 0, 1, 0, 1, 0.5}, {0, 0, 1, 0.5, 0, 1}};
  CHECK(mesh_in("m.ply", ply_head(4,
                                  "element face 1\nproperty list uchar float texcoord\n"
                                  "property list uchar int vertex_indices\n") +
                             "0 0 0\n1 0 0\n1 1 0\n0 1 0\n8 0 0 1 0 1 0.5 0 1 4 0 1 2 3\n")
            .uv == uv);
  for (const std::string names :
       {"s\nproperty float t", "u\nproperty float v", "texture_u\nproperty float texture_v"})
    CHECK(mesh_in("m.ply", ply_head(4, "property float " + names + "\n" + faces_head(1)) +
                               "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 0.5\n0 1 0 0 1\n4 0 1 2 3\n")
              .uv == uv);
}

TEST_CASE("a flat mesh has uv in its own plane, from 0 to 1 along the longer side") {
  using Eigen::Vector3d;
  const auto turn = [](double degrees, const Vector3d& axis) {
    return Eigen::AngleAxisd(degrees * M_PI / 180, axis).toRotationMatrix();
  };
  CHECK(difference(Eigen::Matrix3d::Identity(), halved, {0, 0, 0}) == 0);
  // Upright, facing -y: x to the right, z up.
  const Eigen::Matrix3d upright = turn(90, Vector3d::UnitX());
  CHECK(difference(upright) < 1e-14);
  CHECK(difference(turn(37, Vector3d::UnitZ()) * upright) < 1e-14);
  // Leaning, and nearly horizontal.
  for (const double degrees : {60., 20.}) CHECK(difference(turn(degrees, Vector3d::UnitX())) < 1e-14);
  // On its side: z is up, along the banner.
  CHECK(difference(upright * turn(90, Vector3d::UnitZ()),
                   [](double x, double y) { return Eigen::RowVector2d(0.25 - y / 2, x / 2); }) < 1e-14);
  // Its front below: no mirrored letters on the front.
  CHECK(difference(turn(180, Vector3d::UnitY())) < 1e-14);

  TriangleMesh back = banner;
  back.triangles.col(1).swap(back.triangles.col(2));
  const TriangleMesh bag = both_of(banner, back, {0, 0, 0});
  REQUIRE(PlanarUv::of(bag));
  const CornerUv of_bag = PlanarUv::of(bag)->at(bag);
  CHECK(of_bag.minCoeff() == 0);
  CHECK(of_bag.maxCoeff() == 1);

  TriangleMesh bent = banner;
  for (Eigen::Index i = 0; i < bent.vertices.rows(); ++i)
    bent.vertices(i, 2) = 0.01 * bent.vertices(i, 0) * i;
  CHECK_FALSE(PlanarUv::of(bent));
}

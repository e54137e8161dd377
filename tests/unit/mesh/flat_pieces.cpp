#include "core/numerics/mesh/flat_pieces.h"

#include <catch2/catch.hpp>

#include "core/app/experiment/experiment_parameters.h"
#include "core/numerics/mesh/check.h"
#include "core/numerics/mesh/rotation.h"
#include "core/numerics/mesh/seams.h"
#include "core/numerics/mesh/unjoined_borders.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/sewn.h"
#include "tests/unit/mesh/mesh_files.h"

using namespace drape;

namespace {

/// Two squares side by side, in two triangles each, that share the edge from vertex 1 to vertex 4.
TriangleMesh two_squares() {
  TriangleMesh mesh = as_piece(grid({0.2, 0.1}, 3, 2, Diagonals::one_way));
  for (Eigen::Index t = 0; t < 4; ++t)
    if (mesh.vertices(mesh.triangles.row(t), 0).mean() > 0.1)
      for (int k = 0; k < 3; ++k) mesh.uv(t, 2 * k) += 5;
  return mesh;
}

}  // namespace

TEST_CASE("Seams are edges whose corners differ, and pieces lie between them") {
  const TriangleMesh mesh = two_squares();
  const Topology topology = Topology::of(mesh.triangles, 6);
  int seams = 0;
  for (int e = 0; e < topology.edges.rows(); ++e) {
    if (!is_seam(mesh, topology, e)) continue;
    ++seams;
    CHECK(topology.edges.row(e) == Eigen::RowVector2i(1, 4));
    CHECK(rest_length(mesh, topology, e) == Approx(0.1));
  }
  CHECK(seams == 1);
  const std::vector<int> pieces = flat_pieces(mesh, topology);
  CHECK(pieces == std::vector<int>{0, 0, 1, 1});
  TriangleMesh space = mesh;
  space.sewing.reset();
  CHECK(flat_pieces(space, topology) == std::vector<int>{0, 0, 0, 0});
}

TEST_CASE("Vertices that are written twice are joined, in the order of the first ones") {
  TriangleMesh mesh = two_squares();
  TriangleMesh doubled = mesh;
  doubled.vertices.conservativeResize(8, 3);
  doubled.vertices.row(6) = mesh.vertices.row(1) + Eigen::RowVector3d(1e-6, 0, 0);
  doubled.vertices.row(7) = mesh.vertices.row(4) - Eigen::RowVector3d(0, 1e-6, 0);
  for (Eigen::Index t = 0; t < 4; ++t)
    for (int k = 0; k < 3 && mesh.uv(t, 0) > 1; ++k) {
      int& v = doubled.triangles(t, k);
      v = v == 1 ? 6 : v == 4 ? 7 : v;
    }
  TriangleMesh apart = doubled;
  CHECK(join_vertices(apart, 1e-7) == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7});
  CHECK(join_vertices(doubled, 1e-5) == std::vector<int>{0, 1, 2, 3, 4, 5, 1, 4});
  CHECK(doubled.vertices == mesh.vertices);
  CHECK(doubled.triangles == mesh.triangles);
}

TEST_CASE("Faults of flat pieces are named by triangle, and mirrored pieces are none") {
  TriangleMesh mesh = two_squares();
  CHECK(check_pieces(mesh).empty());
  place_piece(mesh, {1, 1, 0, 0}, 0, true, {0, 0});
  CHECK(check_pieces(mesh).empty());
  mesh.uv.row(2).setConstant(0.5);
  REQUIRE(check_pieces(mesh).size() == 1);
  CHECK(check_pieces(mesh)[0].starts_with("1 triangle has no area in texture coordinates: 2 ("));
}

TEST_CASE("The length of texture coordinates comes from areas in space, along u and along v") {
  TriangleMesh mesh = two_squares();
  const std::vector<char> all(4, 1);
  CHECK(UvLength::of(mesh, all).whole == Approx(1));
  mesh.uv *= 4;
  CHECK(UvLength::of(mesh, all).whole == Approx(0.25));
  for (int k = 0; k < 3; ++k) mesh.uv.col(2 * k) *= 2;
  const UvLength length = UvLength::of(mesh, all);
  CHECK(length.along_u == Approx(0.125));
  CHECK(length.along_v == Approx(0.25));
  CHECK_FALSE(similar_lengths(length.along_u, length.along_v));
}

TEST_CASE("OBJ and PLY files keep pieces by name, a PLY the length of texture coordinates too") {
  const std::string squares = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 2 1 0\n";
  const TriangleMesh groups =
      mesh_in("m.obj", squares + "o shirt\ng front\nf 1 2 3 4\ng back side\nf 2 5 6 3\n");
  CHECK(groups.piece == std::vector<int>{0, 0, 1, 1});
  CHECK(groups.piece_names == std::vector<std::string>{"front", "back"});
  const TriangleMesh materials =
      mesh_in("m.obj", squares + "g all\nf 1 2 3\nusemtl a\nf 1 3 4\nusemtl b\nf 2 5 6 3\n");
  CHECK(materials.piece_names == std::vector<std::string>{"a", "b", "unnamed"});
  CHECK(materials.piece == std::vector<int>{2, 0, 1, 1});
  for (const std::string keyword : {"usemtl", "o"}) {
    const auto line = [&](const std::string& name) { return keyword + "  sleeve   " + name + '\n'; };
    const TriangleMesh blanks =
        mesh_in("m.obj", squares + line("left") + "f 1 2 3 4\n" + line("right") + "f 2 5 6 3\n");
    CHECK(blanks.piece_names == std::vector<std::string>{"sleeve left", "sleeve right"});
  }
  CHECK(mesh_in("m.obj", squares + "f 1 2 3 4\nf 2 5 6 3\n").piece.empty());

  TriangleMesh sewn = two_squares();
  sewn.piece = {0, 0, 1, 1}, sewn.piece_names = {"left", "right"};
  sewn.sewing->uv_length = 0.0254;
  const Scratch folder;
  for (const char* name : {"m.obj", "m.ply"}) {
    write_mesh(folder / name, sewn);
    const TriangleMesh read = read_mesh(folder / name);
    CHECK(read.piece == sewn.piece);
    CHECK(read.piece_names == sewn.piece_names);
    CHECK(read.uv == sewn.uv);
  }
  CHECK(read_mesh(folder / "m.ply").sewing->uv_length == 0.0254);
  sewn.piece_names = {"a\x1b[2J b", "c#d\\"};
  write_mesh(folder / "odd.obj", sewn);
  CHECK(read_mesh(folder / "odd.obj").piece_names == std::vector<std::string>{"a_x1b[2J_b", "c_d_"});
  sewn.piece_names = {"a b", "a_b"};
  write_mesh(folder / "odd.obj", sewn);
  CHECK(read_mesh(folder / "odd.obj").piece == sewn.piece);
  CHECK_THAT(vtp_text(sewn), Catch::Contains("Name=\"piece\""));
}

TEST_CASE("Positions go back to the unit, axes and frame of the file that was read") {
  AsReadParameters read;
  read.unit = GENERATE("mm", "inch", "m"), read.up = GENERATE("y", "z");
  read.scale = 1.7, read.rotate = {20, -35, 110};
  const Positions x = grid({0.3, 0.2}, 4, 3, Diagonals::one_way).vertices;
  Positions metres = x;
  read.convert(metres);
  metres *= read.scale;
  metres *= rotation_matrix(read.rotate).transpose();
  CHECK(read.in_file(metres).isApprox(x, 1e-14));
}

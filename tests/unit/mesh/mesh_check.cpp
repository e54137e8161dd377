#include <catch2/catch.hpp>
#include <limits>

#include "core/numerics/mesh/check.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/meshes.h"

using namespace drape;
using Faults = std::vector<std::string>;

namespace {

/// A strip of two triangles above z = 0, so that only the checks of any mesh apply.
TriangleMesh strip() { return mesh_of({{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}}, {{0, 1, 2}, {2, 1, 3}}); }

TriangleMesh strip_with(const std::vector<Eigen::Vector3d>& vertices,
                        const std::vector<Eigen::Vector3i>& triangles) {
  TriangleMesh mesh = strip();
  append(mesh, vertices, triangles);
  return mesh;
}

/// The strip, scaled and then moved along x.
TriangleMesh scaled_strip(double scale, double x) {
  TriangleMesh mesh = strip();
  mesh.vertices = (scale * mesh.vertices).rowwise() + Eigen::RowVector3d(x, 0, 0);
  return mesh;
}

/// The mesh must have one fault, which begins so; a remedy may follow.
void check_fault(const TriangleMesh& mesh, const std::string& beginning) {
  const Faults faults = check_mesh(mesh);
  REQUIRE(faults.size() == 1);
  CHECK_THAT(faults[0], Catch::StartsWith(beginning));
}

/// A flat grid of 5 × 5 vertices.
TriangleMesh flat_sheet() { return grid({1, 1}, 5, 5, Diagonals::one_way); }

/// Two flat sheets at the same place, joined along `joined` of the first one's vertices; the second faces
/// down.
TriangleMesh flat_cover(const TriangleMesh& sheet, const std::vector<int>& joined) {
  TriangleMesh mesh = sheet;
  std::vector<int> number(sheet.vertices.rows(), -1);
  for (const int v : joined) number[v] = v;
  for (int v = 0; v < sheet.vertices.rows(); ++v)
    if (number[v] < 0) {
      number[v] = static_cast<int>(mesh.vertices.rows());
      append(mesh, {sheet.vertices.row(v)}, {});
    }
  for (const auto& t : sheet.triangles.rowwise())
    append(mesh, {}, {{number[t[0]], number[t[2]], number[t[1]]}});
  return mesh;
}

/// A band of 24 triangles whose ends are joined after half a turn.
TriangleMesh moebius_band() {
  constexpr int quads = 12;
  TriangleMesh band;
  for (int i = 0; i < quads; ++i)
    for (const double side : {-0.2, 0.2}) {
      const double turn = 2 * M_PI * i / quads, r = 1 + side * std::cos(turn / 2);
      append(band, {{r * std::cos(turn), r * std::sin(turn), side * std::sin(turn / 2)}}, {});
    }
  for (int i = 0; i < quads; ++i) {
    const int a = 2 * i, b = a + 1, c = i + 1 < quads ? a + 2 : 1, d = i + 1 < quads ? a + 3 : 0;
    append(band, {}, {{a, c, b}, {b, c, d}});
  }
  return band;
}

}  // namespace

TEST_CASE("every fault is one line that names the elements") {
  check_fault(strip_with({{5, 5, 5}}, {}),
              "1 vertex belongs to no triangle: 4 (counted from 0); remove them, or merge those at "
              "the place of another, as a cloth's \"join\" does");
  std::vector<Eigen::Vector3d> far;
  for (int k = 0; k < 100; ++k) far.emplace_back(k, 5, 5);
  check_fault(strip_with(far, {}), "100 vertices belong to no triangle: 4, 5, 6, 7, 8, … (counted from 0)");
  check_fault(strip_with({}, {{1, 3, 1}}), "1 triangle repeats a vertex: 2 (1, 3, 1) (counted from 0)");
  check_fault(strip_with({}, {{1, 3, 2}}), "1 triangle has the same vertices as another: 2 (1, 3, 2) as 1 ");
  check_fault(strip_with({{0, 0, 2}}, {{1, 2, 4}}),
              "1 edge has more than two triangles: (1, 2) in triangles 0, 1, 2 (counted from 0)");
  check_fault(strip_with({{2, 1, 1}, {2, 2, 1}}, {{3, 4, 5}}),
              "1 vertex joins separate fans of triangles: 3 of 2 fans (counted from 0)");
  check_fault(strip_with({}, {{-1, 1, 3}, {2, 1, 4}}),
              "2 triangles name a vertex that is not there: 2 (-1, 1, 3), 3 (2, 1, 4) (counted from 0); "
              "vertices go from 0 to 3");
  TriangleMesh mesh = strip();
  mesh.triangles.row(1) << 1, 2, 3;
  check_fault(mesh, "1 edge runs in the same direction in both triangles: (1, 2) in triangles 0, 1 ");
}

TEST_CASE("coordinates are finite numbers that can be computed with") {
  TriangleMesh mesh = strip();
  mesh.vertices(1, 2) = -1e30;
  check_fault(mesh, "1 vertex has too large a coordinate: 1 with 1e+30 m (counted from 0); at most 1e+09 m");
  mesh.vertices(1, 2) = std::nan("");
  mesh.vertices(3, 0) = std::numeric_limits<double>::infinity();
  check_fault(mesh, "2 vertices have a coordinate that is not finite: 1, 3 (counted from 0)");
  check_fault(scaled_strip(1e-30, 0), "the mesh is 1.41e-30 m across; at least 1e-09 m can be computed with");
  // So far away that rounding changes its shape.
  check_fault(scaled_strip(1e-8, 1001),
              "the mesh is 1.41e-08 m across and 1e+03 m from the origin, where "
              "rounding moves vertices by 2.22e-13 m");
  CHECK(check_mesh(scaled_strip(1e-8, 1)).empty());
  CHECK(check_mesh(scaled_strip(1e-8, 0)).empty());
  CHECK(check_mesh(scaled_strip(1e8, 0)).empty());
}

TEST_CASE("a triangle without area is found at any scale") {
  const double scale = GENERATE(1e-6, 1.0, 1e6);
  TriangleMesh mesh = strip();
  mesh.vertices.row(3) << 0.5, 0.5, 1;  // on the edge (1, 2)
  mesh.vertices *= scale;
  CHECK(check_mesh(mesh) ==
        Faults{"1 triangle has no area: 1 (2, 1, 3) (counted from 0); move their vertices "
               "apart, or remove them"});
  mesh.vertices.row(3) += scale * Eigen::RowVector3d(1e-9, 0, 0);
  CHECK(check_mesh(mesh).empty());
}

TEST_CASE("a triangle that rounding of its coordinates strains is named at any scale, also far away") {
  const double scale = GENERATE(1e-6, 1.0, 1e6);
  TriangleMesh mesh = strip();
  mesh.vertices.row(3) << 0.5 + 1e-11, 0.5, 1;  // beside the edge (1, 2)
  mesh.vertices *= scale;
  const Faults expected{
      "1 triangle is so low that rounding of coordinates strains the cloth: 1 (2, 1, 3) (counted from 0); "
      "move the vertices apart, or mesh the cloth anew there"};
  CHECK(check_mesh(mesh) == expected);
  mesh.vertices.row(3) += scale * Eigen::RowVector3d(1e-8, 0, 0);
  CHECK(check_mesh(mesh).empty());
  mesh.vertices.col(1).array() += 1e2 * scale;
  CHECK(check_mesh(mesh) == expected);
}

TEST_CASE("a surface with one side is not told to turn a side over") {
  const std::string moebius =
      "1 edge of a surface with one side, as a Möbius band has, runs in the same direction in both "
      "triangles: "
      "(0, 1) in triangles 0, 23 (counted from 0); a cloth has two sides: cut it open along them";
  CHECK(check_mesh(moebius_band()) == Faults{moebius});
  TriangleMesh mesh = strip();
  mesh.triangles.row(1) << 1, 2, 3;
  const TriangleMesh both = both_of(moebius_band(), mesh, {3, 0, 0});
  CHECK(check_mesh(both) ==
        Faults{"1 edge runs in the same direction in both triangles: (25, 26) in triangles 24, 25 (counted "
               "from 0); turn one side over, so that all triangles have the same front side",
               moebius});
}

TEST_CASE("a valid mesh has no faults, whether closed, a cushion, a folded sheet or one that faces down") {
  CHECK(check_mesh({}) == Faults{"the mesh has no vertices", "the mesh has no triangles"});
  CHECK(check_mesh(strip()).empty());
  CHECK(check_mesh(grid({1, 1}, 5, 4, Diagonals::criss_cross)).empty());
  CHECK(check_mesh(tetrahedron()).empty());  // a fan that closes around a vertex makes no bow-tie
  const TriangleMesh sheet = flat_sheet();
  CHECK(check_mesh(flat_cover(sheet, {0, 5, 10, 15, 20})).empty());
  CHECK(check_mesh(flat_cover(wheel(6), {1, 2, 3, 4, 5, 6})).empty());
  CHECK(check_mesh(flat_cover(sheet, {})).empty());  // two layers
  TriangleMesh down = sheet;
  down.triangles.col(1).swap(down.triangles.col(2));
  CHECK(check_mesh(down).empty());
  TriangleMesh strip_over = strip();
  strip_over.vertices.col(2).setZero();
  append(strip_over, {{0.2, 0.2, 0}}, {{3, 1, 4}});
  CHECK(check_mesh(strip_over).empty());
}

TEST_CASE("a vertex of a flat sheet that lies beyond its neighbours turns triangles over") {
  TriangleMesh mesh = flat_sheet();
  mesh.vertices.row(12) << 0.85, 0.55, 0;  // its neighbour is at 0.75, 0.5
  const Faults faults = check_mesh(mesh);
  REQUIRE(faults.size() == 1);
  CHECK_THAT(faults[0],
             Catch::Contains("(12, ") &&
                 Catch::Contains(" overlap those around a vertex: each faces the other way than they do: "));
}

TEST_CASE("a cloth whose triangles are not joined is to be welded") {
  TriangleMesh triangles, squares;  // with vertices of their own
  const TriangleMesh sheet = flat_sheet();
  for (const auto& t : sheet.triangles.rowwise())
    triangles = both_of(triangles, {sheet.vertices(t, Eigen::all), Triangles{{0, 1, 2}}}, {0, 0, 0});
  for (int k = 0; k < 16; ++k)  // cells
    squares =
        both_of(squares, grid({0.25, 0.25}, 2, 2, Diagonals::one_way), {0.25 * (k % 4), 0.25 * (k / 4), 0});
  for (const TriangleMesh& soup : {triangles, squares})
    CHECK(check_mesh(soup) == Faults{"32 triangles share no vertices, but lie edge to edge (a triangle "
                                     "soup); weld it: merge the vertices that are at the same place"});
}

TEST_CASE("a vertex within an edge of the triangle beside it is a T-junction") {
  // A square whose lower half has a vertex in the middle of the diagonal.
  TriangleMesh mesh =
      mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 0}}, {{0, 1, 4}, {1, 2, 4}, {0, 2, 3}});
  const double angle = GENERATE(0, 0.4);
  for (auto x : mesh.vertices.rowwise()) x = Eigen::RowVector3d(x[0] * cos(angle), x[1], x[0] * sin(angle));
  const Faults faults = check_mesh(mesh);
  REQUIRE(faults.size() == 2);
  CHECK_THAT(faults[0],
             Catch::Contains("2 vertices join separate fans of triangles: 0 of 2 fans, 2 of 2 fans"));
  CHECK(faults[1] ==
        "1 border vertex lies inside a border edge (T-junctions): 4 in (0, 2) (counted from 0); the "
        "cloth would open there: split the edge's triangle at the vertex");
  // In another part of the cloth the vertex is that of another sheet.
  mesh.triangles.row(2) << 5, 6, 3;
  append(mesh, {{0, 0, 0}, {cos(angle), 1, sin(angle)}}, {});
  CHECK(check_mesh(mesh).empty());
  // In a file of six decimals.
  mesh = mesh_of({{0, 0, 0}, {0.02, 0, 0}, {0.02, 0.013333, 0}, {0, 0.013333, 0}, {0.01, 0.006667, 0}},
                 {{0, 1, 4}, {1, 2, 4}, {0, 2, 3}});
  CHECK_THAT(check_mesh(mesh).back(), Catch::Contains("T-junctions"));
}

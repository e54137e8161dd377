#include <catch2/catch.hpp>
#include <limits>

#include "core/kernel/mesh/check.h"
#include "core/kernel/mesh/generate.h"

using namespace drape;
using Faults = std::vector<std::string>;

namespace {

/// A strip of two triangles above z = 0, so that only the checks of any mesh apply.
TriangleMesh strip() {
  TriangleMesh mesh;
  mesh.vertices.resize(4, 3);
  mesh.vertices << 0, 0, 1, 1, 0, 1, 0, 1, 1, 1, 1, 1;
  mesh.triangles.resize(2, 3);
  mesh.triangles << 0, 1, 2, 2, 1, 3;
  return mesh;
}

void append_triangle(TriangleMesh& mesh, int a, int b, int c) {
  mesh.triangles.conservativeResize(mesh.triangles.rows() + 1, 3);
  mesh.triangles.bottomRows(1) << a, b, c;
}

void append_vertex(TriangleMesh& mesh, double x, double y, double z) {
  mesh.vertices.conservativeResize(mesh.vertices.rows() + 1, 3);
  mesh.vertices.bottomRows(1) << x, y, z;
}

}  // namespace

TEST_CASE("a valid mesh has no faults", "[check]") {
  CHECK(check_mesh(strip()).empty());
  CHECK(check_mesh(grid({1, 1}, 5, 4, Diagonals::criss_cross)).empty());
}

TEST_CASE("an empty mesh is a fault", "[check]") {
  CHECK(check_mesh({}) == Faults{"the mesh has no vertices", "the mesh has no triangles"});
}

TEST_CASE("every fault is one line that names the element", "[check]") {
  TriangleMesh mesh = strip();

  SECTION("index out of range") {
    mesh.triangles(1, 2) = 4;
    append_triangle(mesh, -1, 1, 3);
    CHECK(check_mesh(mesh) == Faults{"triangle 1 (2, 1, 4) names vertex 4, but vertices go from 0 to 3",
                                     "triangle 2 (-1, 1, 3) names vertex -1, but vertices go from 0 to 3"});
  }
  SECTION("coordinate that is not finite") {
    mesh.vertices(1, 2) = std::numeric_limits<double>::quiet_NaN();
    mesh.vertices(3, 0) = std::numeric_limits<double>::infinity();
    CHECK(check_mesh(mesh) == Faults{"vertex 1 (counted from 0) has a coordinate that is not finite",
                                     "vertex 3 (counted from 0) has a coordinate that is not finite"});
  }
  SECTION("coordinates too large, or a mesh too small, to be computed with") {
    mesh.vertices(1, 2) = -1e30;
    CHECK(check_mesh(mesh) ==
          Faults{
              "vertex 1 (counted from 0) has a coordinate of 1e+30 m; at most 1e+09 m can be computed with"});
    mesh.vertices = strip().vertices * 1e-30;
    CHECK(check_mesh(mesh) == Faults{"the mesh is 1.41e-30 m across; at least 1e-09 m can be computed with"});
    mesh.vertices = strip().vertices * 1e8;
    CHECK(check_mesh(mesh).empty());
    mesh.vertices = strip().vertices * 1e-8;
    CHECK(check_mesh(mesh).empty());
  }
  SECTION("so far away that rounding changes its shape") {
    mesh.vertices *= 1e-8;
    mesh.vertices.col(0).array() += 1;
    CHECK(check_mesh(mesh).empty());
    mesh.vertices.col(0).array() += 1e3;
    CHECK(check_mesh(mesh) == Faults{"the mesh is 1.41e-08 m across and 1e+03 m from the origin, where "
                                     "rounding moves vertices by 2.22e-13 m; move it nearer"});
  }
  SECTION("vertex without triangle") {
    append_vertex(mesh, 5, 5, 5);
    CHECK(check_mesh(mesh) == Faults{"vertex 4 belongs to no triangle (counted from 0)"});
  }
  SECTION("repeated index") {
    append_triangle(mesh, 1, 3, 1);
    CHECK(check_mesh(mesh) == Faults{"triangle 2 (1, 3, 1) repeats a vertex (counted from 0)"});
  }
  SECTION("no area, at any scale") {
    const double scale = GENERATE(1e-6, 1.0, 1e6);
    mesh.vertices.row(3) << 0.5, 0.5, 1;  // on the edge (1, 2)
    mesh.vertices *= scale;
    CHECK(check_mesh(mesh) == Faults{"triangle 1 (2, 1, 3) has no area (counted from 0)"});
    mesh.vertices.row(3) += scale * Eigen::RowVector3d(1e-9, 0, 0);
    CHECK(check_mesh(mesh).empty());
  }
  SECTION("edge with three triangles") {
    append_vertex(mesh, 0, 0, 2);
    append_triangle(mesh, 1, 2, 4);
    CHECK(check_mesh(mesh) == Faults{"edge (1, 2) has 3 triangles: 0, 1, 2 (counted from 0)"});
  }
  SECTION("inverted triangle") {
    mesh.triangles.row(1) << 1, 2, 3;
    CHECK(check_mesh(mesh) == Faults{"edge (1, 2) runs in the same direction in triangles 0 and 1 (counted "
                                     "from 0): one of them is inverted"});
  }
  SECTION("bow-tie") {
    append_vertex(mesh, 2, 1, 1);
    append_vertex(mesh, 2, 2, 1);
    append_triangle(mesh, 3, 4, 5);
    CHECK(check_mesh(mesh) == Faults{"vertex 3 joins 2 separate fans of triangles (counted from 0)"});
  }
  SECTION("duplicate triangle") {
    append_triangle(mesh, 1, 3, 2);
    CHECK(check_mesh(mesh) ==
          Faults{"triangle 2 (1, 3, 2) has the same vertices as triangle 1 (counted from 0)",
                 "edge (1, 2) has 3 triangles: 0, 1, 2 (counted from 0)",
                 "edge (1, 3) runs in the same direction in triangles 1 and 2 (counted from 0): one of them "
                 "is inverted",
                 "edge (2, 3) runs in the same direction in triangles 1 and 2 (counted from 0): one of them "
                 "is inverted"});
  }
  SECTION("flat mesh that folds over") {
    mesh.vertices.col(2).setZero();
    CHECK(check_mesh(mesh).empty());
    append_vertex(mesh, 0.2, 0.2, 0);
    append_triangle(mesh, 3, 1, 4);  // shares the edge (1, 3) rightly but lies on the other triangles
    CHECK(check_mesh(mesh) ==
          Faults{"triangle 2 (3, 1, 4) faces the other way than most of this flat mesh (counted from 0)"});
  }
}

TEST_CASE("the inner edge of a fan closed around a vertex makes no bow-tie", "[check]") {
  TriangleMesh mesh;  // a tetrahedron, closed
  mesh.vertices.resize(4, 3);
  mesh.vertices << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  mesh.triangles.resize(4, 3);
  mesh.triangles << 0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3;
  CHECK(check_mesh(mesh).empty());
}

TEST_CASE("the smallest angle is in degrees", "[check]") {
  TriangleMesh mesh = strip();
  CHECK(smallest_angle(mesh) == Approx(45));
  mesh.vertices.row(3) << 1, std::sqrt(3.0), 1;
  mesh.triangles.conservativeResize(1, 3);
  mesh.triangles << 0, 1, 3;
  CHECK(smallest_angle(mesh) == Approx(30));
  CHECK(smallest_angle({}) == 0);
}

#include "core/numerics/patterns/generate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "core/kernel/interfaces/level.h"
#include "core/numerics/mesh/check.h"
#include "core/numerics/mesh/same_entries.h"
#include "core/numerics/patterns/delaunay.h"

using namespace drape;

namespace {

/// The angles of triangle t [degree].
std::array<double, 3> angles_of(const TriangleMesh& mesh, Eigen::Index t) {
  std::array<double, 3> angles;
  for (int k = 0; k < 3; ++k) {
    const auto side_to = [&](int i) -> Eigen::Vector3d {
      return mesh.vertices.row(mesh.triangles(t, i % 3)) - mesh.vertices.row(mesh.triangles(t, k));
    };
    const Eigen::Vector3d a = side_to(k + 1), b = side_to(k + 2);
    angles[k] = std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
  }
  return angles;
}

int euler_characteristic(const TriangleMesh& mesh) {
  const auto n = static_cast<int>(mesh.vertices.rows());
  const Topology topology = Topology::of(mesh.triangles, n);
  return n - static_cast<int>(topology.edges.rows() - mesh.triangles.rows());
}

bool same(const TriangleMesh& a, const TriangleMesh& b) {
  return same_entries(a.vertices, b.vertices) && same_entries(a.triangles, b.triangles);
}

/// What every pattern must be: valid, flat, counter-clockwise, in one piece with this many holes.
void require_pattern(const TriangleMesh& mesh, double area, int holes, double angle) {
  REQUIRE(mesh.vertices.rows() > 0);
  CHECK(check_mesh(mesh).empty());
  CHECK((mesh.vertices.col(2).array() == 0).all());
  CHECK(area_vectors(mesh).col(2).sum() / 2 == Approx(area).epsilon(1e-12));
  CHECK(euler_characteristic(mesh) == 1 - holes);
  double smallest = 180;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t)
    smallest = std::min(smallest, std::ranges::min(angles_of(mesh, t)));
  CHECK(smallest > angle);
}

const Polygon unit_square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
const Polygon hole{{.3, .3}, {.5, .3}, {.5, .6}, {.3, .6}};

}  // namespace

TEST_CASE("a grid counts vertices, not cells", "[generate]") {
  const auto diagonals = GENERATE(Diagonals::one_way, Diagonals::criss_cross);
  const TriangleMesh mesh = grid({2, 1}, 32, 32, diagonals);
  CHECK(mesh.vertices.rows() == 1024);
  CHECK(mesh.triangles.rows() == 2 * 31 * 31);
  CHECK(mesh.vertices.row(0) == Eigen::RowVector3d(0, 0, 0));
  CHECK(mesh.vertices.row(1023) == Eigen::RowVector3d(2, 1, 0));
  require_pattern(mesh, 2, 0, 26);
}

TEST_CASE("diagonals go one way or criss-cross", "[generate]") {
  const auto valence = [](Diagonals diagonals, int v) {
    const TriangleMesh mesh = grid({1, 1}, 6, 6, diagonals);
    return Topology::of(mesh.triangles, 36).vertex_vertices.size(v);
  };
  for (int v : {7, 8, 13, 14}) CHECK(valence(Diagonals::one_way, v) == 6);
  CHECK(valence(Diagonals::criss_cross, 7) == 8);   // (1, 1)
  CHECK(valence(Diagonals::criss_cross, 8) == 4);   // (2, 1)
  CHECK(valence(Diagonals::criss_cross, 13) == 4);  // (1, 2)
  CHECK(valence(Diagonals::criss_cross, 14) == 8);  // (2, 2)
}

TEST_CASE("an equilateral triangulation has angles of 60 degrees, and halves at two sides", "[generate]") {
  const int columns = GENERATE(2, 7, 12), rows = GENERATE(2, 3, 9, 10);
  const double side = 0.1;
  const Eigen::Vector2d size((columns - 1) * side, (rows - 1) * std::sqrt(0.75) * side);
  const TriangleMesh mesh = equilateral(size, columns, rows);
  CAPTURE(columns, rows);
  CHECK(mesh.vertices.rows() == columns * rows + rows / 2);
  CHECK(mesh.triangles.rows() == (rows - 1) * (2 * columns - 1));
  require_pattern(mesh, size.prod(), 0, 29.9);
  CHECK(mesh.vertices.colwise().maxCoeff() == Eigen::RowVector3d(size.x(), size.y(), 0));
  CHECK(mesh.vertices.colwise().minCoeff() == Eigen::RowVector3d(0, 0, 0));

  // Triangles at the sides x = 0 and x = width, two a strip, have a half or a whole triangle's angles.
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t) {
    const Eigen::Vector3d x = mesh.vertices(mesh.triangles.row(t), 0);
    const bool inside = x.minCoeff() > 0 && x.maxCoeff() < size.x();
    for (const double angle : angles_of(mesh, t)) {
      const double from_60 = std::abs(angle - 60);
      CHECK((inside ? from_60 : std::min({std::abs(angle - 30), from_60, std::abs(angle - 90)})) < 1e-9);
    }
  }
}

TEST_CASE("an equilateral triangulation is had in about the asked number, nearly equilateral", "[generate]") {
  for (const Eigen::Vector2d& size : {Eigen::Vector2d(1, 1), {0.4, 0.05}, {0.7, 2.1}, {3, 0.02}})
    for (const int vertices : {150, 1024, 1600, 20000}) {
      const Eigen::Vector2i counts = equilateral_counts(size, vertices);
      const int made = counts.x() * counts.y() + counts.y() / 2;
      const double side = size.x() / (counts.x() - 1), height = size.y() / (counts.y() - 1);
      CAPTURE(size.transpose(), vertices, made, height / side);
      // Whole strips of whole triangles: half a strip more or less, and the number changes by 1/strips.
      const double allowed = std::max(0.05, 1.2 / (std::min(counts.x(), counts.y()) - 1));
      CHECK(std::abs(made - vertices) <= allowed * vertices);
      CHECK(std::abs(height / side / std::sqrt(0.75) - 1) <= allowed);
    }
  // A count that is given stays.
  CHECK(equilateral_counts({1, 1}, 1024, 11, 0) == Eigen::Vector2i(11, 13));
  CHECK(equilateral_counts({1, 1}, 1024, 0, 13) == Eigen::Vector2i(11, 13));
  CHECK(equilateral_counts({1, 1}, 1024, 5, 6) == Eigen::Vector2i(5, 6));
  // Shapes that cannot be met in this number of vertices still do not ask for more.
  for (const Eigen::Vector2d& size : {Eigen::Vector2d(1e6, 1e-6), {1e-6, 1e6}}) {
    const Eigen::Vector2i counts = equilateral_counts(size, 1000);
    CAPTURE(counts.transpose());
    CHECK(counts.minCoeff() >= 2);
    CHECK(counts.x() * counts.y() <= 1000);
  }
  CHECK_THROWS_WITH(equilateral({1, 0}, 3, 3), "equilateral: the size must be positive");
  CHECK_THROWS_WITH(equilateral({1, 1}, 1, 3), "equilateral: at least 2 × 2 vertices are needed");
}

TEST_CASE("Delaunay patterns meet the count, the area and the angle", "[generate]") {
  const int count = GENERATE(150, 1000, 4000);
  const auto near = [&](const TriangleMesh& mesh) {
    return std::abs(mesh.vertices.rows() - count) <= 0.15 * count;
  };

  const TriangleMesh plain = delaunay_polygon({unit_square}, count, 1);
  CHECK(near(plain));
  require_pattern(plain, 1, 0, 20);

  Polygon backwards(hole.rbegin(), hole.rend());
  const TriangleMesh holed = delaunay_polygon({unit_square, backwards}, count, 1);
  CHECK(near(holed));
  require_pattern(holed, 0.94, 1, 20);
  CHECK(same(holed, delaunay_polygon({unit_square, backwards}, count, 1)));

  const TriangleMesh other = delaunay_polygon({unit_square}, count, 2);
  CHECK(near(other));
  CHECK_FALSE(same(plain, other));
}

TEST_CASE("Outlines with slanted sides and holes are triangulated at every count", "[generate]") {
  // Points of a slanted side are on one line only up to rounding.
  const std::vector<std::vector<Polygon>> outlines = {
      {{{0, 0}, {1, 0}, {0, 1}}},
      {{{0, 0}, {1, 0}, {0.5, 0.86602540378443865}}},
      {{{0, 0}, {1, 0}, {0.8, 0.7}, {0.2, 0.7}}},
      {{{0, 0}, {0.5, -0.3}, {1, 0}, {0.7, 0.9}, {0.3, 0.9}}},
      {{{0.1, 0}, {0.9, 0.2}, {0.7, 1}, {0, 0.8}}, {{0.3, 0.3}, {0.6, 0.35}, {0.5, 0.6}}},
      {{{0, 0}, {1, 0}, {0.4, 0.4}, {0, 1}}},
  };
  const double areas[] = {0.5, std::sqrt(3.0) / 4, 0.56, 0.78, 0.59, 0.4};
  for (std::size_t k = 0; k < outlines.size(); ++k)
    for (const int count : {60, 141, 300, 1024, 2000}) {
      CAPTURE(k, count);
      const TriangleMesh mesh = delaunay_polygon(outlines[k], count, 1);
      CHECK(std::abs(mesh.vertices.rows() - count) <= 0.15 * count);
      require_pattern(mesh, areas[k], static_cast<int>(outlines[k].size()) - 1, 20);
    }
}

TEST_CASE("a disc's border is on the circle, its spacing that of the inside", "[generate]") {
  const int count = GENERATE(200, 1500);
  const TriangleMesh mesh = disc(0.6, count);
  CHECK(std::abs(mesh.vertices.rows() - count) <= 0.15 * count);
  CHECK(same(mesh, disc(0.6, count)));

  const Topology topology = Topology::of(mesh.triangles, static_cast<int>(mesh.vertices.rows()));
  int border_vertices = 0;
  for (int v = 0; v < mesh.vertices.rows(); ++v) {
    if (!topology.on_border[v]) continue;
    ++border_vertices;
    CHECK(mesh.vertices.row(v).norm() == Approx(0.6).epsilon(1e-12));
  }
  double border = 0, inside = 0;
  int inner_edges = 0;
  for (int e = 0; e < topology.edges.rows(); ++e) {
    const double length =
        (mesh.vertices.row(topology.edges(e, 0)) - mesh.vertices.row(topology.edges(e, 1))).norm();
    if (topology.edge_triangles(e, 1) == -1)
      border += length / border_vertices;
    else
      inside += length, ++inner_edges;
  }
  CHECK(border == Approx(inside / inner_edges).epsilon(0.1));
  const double corner = 2 * std::numbers::pi / border_vertices;
  require_pattern(mesh, 0.6 * 0.6 / 2 * border_vertices * std::sin(corner), 0, 20);
}

TEST_CASE("random triangulations are exact in number and the same for one seed", "[generate]") {
  const unsigned seed = GENERATE(range(0u, 6u));
  const TriangleMesh mesh = random_triangulation({0.5, 2}, 1600, seed);
  CHECK(mesh.vertices.rows() == 1600);
  require_pattern(mesh, 1, 0, 15);
  CHECK(same(mesh, random_triangulation({0.5, 2}, 1600, seed)));
  CHECK_FALSE(same(mesh, random_triangulation({0.5, 2}, 1600, seed + 1)));

  const Positions& x = mesh.vertices;
  for (const auto& [cx, cy] : {std::pair{0., 0.}, {.5, 0.}, {.5, 2.}, {0., 2.}})
    CHECK((x.rowwise() - Eigen::RowVector3d(cx, cy, 0)).rowwise().norm().minCoeff() == 0);
}

TEST_CASE("random numbers do not depend on the standard library", "[generate]") {
  Random random(5489);
  for (int i = 1; i < 10000; ++i) random.unit();
  // The C++ standard's check of mt19937_64: its 10000th number is 9981545732273789042.
  CHECK(random.unit() == static_cast<double>(9981545732273789042ull >> 11) * 0x1.0p-53);
}

TEST_CASE("patterns refuse what cannot be meshed, naming the loop", "[generate]") {
  CHECK_THROWS_WITH(grid({1, 0}, 3, 3, Diagonals::one_way), "grid: the size must be positive");
  CHECK_THROWS_WITH(grid({1, 1}, 1, 3, Diagonals::one_way), "grid: at least 2 × 2 vertices are needed");
  CHECK_THROWS_WITH(disc(-1, 100), "disc: the radius must be positive");
  CHECK_THROWS_WITH(
      random_triangulation({1, 1}, 4, 0),
      "random triangulation: 4 vertices leave none for the inside of this rectangle; ask for more");

  const auto mesh = [](const std::vector<Polygon>& loops) { return delaunay_polygon(loops, 100, 0); };
  const std::string border = "polygon: loop 0 (the outer border) ";
  CHECK_THROWS_WITH(mesh({}), "polygon: there is no loop");
  CHECK_THROWS_WITH(mesh({{{0, 0}, {1, 0}}}), border + "has fewer than three points");
  CHECK_THROWS_WITH(mesh({{{0, 0}, {1, 1}, {1, 0}, {0, 1}}}), border + "crosses or touches itself");
  CHECK_THROWS_WITH(mesh({{{0, 0}, {1, 0}, {1, 1}, {0, 0}}}),
                    border + "ends with its first point again; leave the last one out");
  CHECK_THROWS_WITH(mesh({{{0, 0}, {1, 0}, {2, 0}}}), border + "crosses or touches itself");
  CHECK_THROWS_WITH(mesh({{{0, 0}, {1, NAN}, {2, 0}}}), border + "has a coordinate that is not finite");
  CHECK_THROWS_WITH(mesh({unit_square, {{2, 2}, {3, 2}, {3, 3}}}),
                    "polygon: loop 1 (a hole) lies outside loop 0");
  CHECK_THROWS_WITH(mesh({unit_square, hole, {{.9, .5}, {1.2, .5}, {.9, .6}}}),
                    "polygon: loop 2 (a hole) crosses or touches loop 0");
  CHECK_THROWS_WITH(mesh({unit_square, hole, {{.4, .4}, {.45, .4}, {.4, .5}}}),
                    "polygon: loop 2 (a hole) and loop 1 lie one inside the other");
  CHECK_THROWS_WITH(delaunay_polygon({unit_square}, 2, 0), "polygon: at least three vertices are needed");

  Polygon comb;  // 43 corners
  for (int i = 0; i < 20; ++i) comb.insert(comb.end(), {{i / 20., 0}, {(i + 0.5) / 20, 0.1}});
  comb.insert(comb.end(), {{1, 0}, {1, 1}, {0, 1}});
  // A needle asks for ever smaller triangles: given up, not meshed to the end of memory.
  CHECK_THROWS_WITH(
      delaunay_polygon({{{0, 0}, {1, 0}, {0, 1e-9}}}, 10, 0),
      Catch::StartsWith("polygon: about 10 vertices are not possible; the nearest number is above "));
  CHECK_THROWS_WITH(delaunay_polygon({comb}, 20, 0),
                    Catch::StartsWith("polygon: about 20 vertices are not possible; the nearest number is "));
}

TEST_CASE("A random triangulation is valid for sides that no division hits exactly") {
  for (const double height : {0.8, 0.7, 1.1, 0.3})
    for (const int vertices : {60, 61, 150}) {
      CAPTURE(height, vertices);
      REQUIRE(check_mesh(random_triangulation({1, height}, vertices, 2)).empty());
    }
}

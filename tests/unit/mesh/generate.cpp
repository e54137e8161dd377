#include "core/numerics/patterns/generate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "core/kernel/interfaces/level.h"
#include "core/numerics/mesh/area_vectors.h"
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

bool same(const TriangleMesh& a, const TriangleMesh& b) {
  return same_entries(a.vertices, b.vertices) && same_entries(a.triangles, b.triangles);
}

/// What every pattern must be: valid, flat, counter-clockwise, in one piece with this many holes.
void require_pattern(const TriangleMesh& mesh, double area, int holes, double angle) {
  REQUIRE(mesh.vertices.rows() > 0);
  CHECK(check_mesh(mesh).empty());
  CHECK((mesh.vertices.col(2).array() == 0).all());
  CHECK(area_vectors(mesh).col(2).sum() / 2 == Approx(area).epsilon(1e-12));
  const auto n = mesh.vertices.rows(), edges = Topology::of(mesh.triangles, static_cast<int>(n)).edges.rows();
  CHECK(n - edges + mesh.triangles.rows() == 1 - holes);  // Euler's characteristic
  double smallest = 180;
  for (Eigen::Index t = 0; t < mesh.triangles.rows(); ++t)
    smallest = std::min(smallest, std::ranges::min(angles_of(mesh, t)));
  CHECK(smallest > angle);
}

/// Whether the number of vertices is about the one that was asked for.
bool has_about(int count, const TriangleMesh& mesh) {
  return std::abs(mesh.vertices.rows() - count) <= 0.15 * count;
}

const Polygon unit_square{{0, 0}, {1, 0}, {1, 1}, {0, 1}};
const Polygon hole{{.3, .3}, {.5, .3}, {.5, .6}, {.3, .6}};

}  // namespace

TEST_CASE("a grid counts vertices, not cells, and its diagonals go one way or criss-cross") {
  for (const Diagonals diagonals : {Diagonals::one_way, Diagonals::criss_cross}) {
    const TriangleMesh mesh = grid({2, 1}, 32, 32, diagonals);
    CHECK(mesh.vertices.rows() == 1024);
    CHECK(mesh.triangles.rows() == 2 * 31 * 31);
    CHECK(mesh.vertices.row(0) == Eigen::RowVector3d(0, 0, 0));
    CHECK(mesh.vertices.row(1023) == Eigen::RowVector3d(2, 1, 0));
    require_pattern(mesh, 2, 0, 26);
    const Topology topology = Topology::of(mesh.triangles, 1024);
    for (const auto& [v, valence] : {std::pair(33, 8), {34, 4}, {65, 4}, {66, 8}})  // (1, 1) to (2, 2)
      CHECK(topology.vertex_vertices.size(v) == (diagonals == Diagonals::one_way ? 6 : valence));
  }
}

TEST_CASE("an equilateral triangulation has angles of 60 degrees, and halves at two sides") {
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

TEST_CASE("an equilateral triangulation is had in about the asked number, nearly equilateral") {
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
}

TEST_CASE("Delaunay patterns meet the count, the area and the angle") {
  const auto check = [](double area, const std::vector<Polygon>& loops, const std::vector<int>& counts) {
    for (const int count : counts) {
      CAPTURE(area, count);
      const TriangleMesh mesh = delaunay_polygon(loops, count, 1);
      CHECK(has_about(count, mesh));
      require_pattern(mesh, area, static_cast<int>(loops.size()) - 1, 20);
    }
  };
  const std::vector<Polygon> holed{unit_square, Polygon(hole.rbegin(), hole.rend())};
  check(1, {unit_square}, {150, 1000, 4000});
  check(0.94, holed, {150, 1000, 4000});
  CHECK(same(delaunay_polygon(holed, 1000, 1), delaunay_polygon(holed, 1000, 1)));
  CHECK_FALSE(same(delaunay_polygon(holed, 1000, 1), delaunay_polygon(holed, 1000, 2)));
  // Points of a slanted side are on one line only up to rounding.
  const std::vector<int> counts{60, 141, 300, 1024, 2000};
  check(0.5, {{{0, 0}, {1, 0}, {0, 1}}}, counts);
  check(std::sqrt(3.0) / 4, {{{0, 0}, {1, 0}, {0.5, 0.86602540378443865}}}, counts);
  check(0.56, {{{0, 0}, {1, 0}, {0.8, 0.7}, {0.2, 0.7}}}, counts);
  check(0.78, {{{0, 0}, {0.5, -0.3}, {1, 0}, {0.7, 0.9}, {0.3, 0.9}}}, counts);
  check(0.59, {{{0.1, 0}, {0.9, 0.2}, {0.7, 1}, {0, 0.8}}, {{0.3, 0.3}, {0.6, 0.35}, {0.5, 0.6}}}, counts);
  check(0.4, {{{0, 0}, {1, 0}, {0.4, 0.4}, {0, 1}}}, counts);
}

TEST_CASE("a disc's border is on the circle, its spacing that of the inside") {
  const int count = GENERATE(200, 1500);
  const TriangleMesh mesh = disc(0.6, count);
  CHECK(has_about(count, mesh));
  CHECK(same(mesh, disc(0.6, count)));
  const Topology topology = Topology::of(mesh.triangles, static_cast<int>(mesh.vertices.rows()));
  double length[2] = {}, number[2] = {};  // of edges inside and at the border
  for (int e = 0; e < topology.edges.rows(); ++e) {
    const auto ends = mesh.vertices(topology.edges.row(e), Eigen::all);
    const bool border = topology.edge_triangles(e, 1) == -1;
    if (border) CHECK(ends.rowwise().norm().isApproxToConstant(0.6, 1e-12));
    length[border] += (ends.row(0) - ends.row(1)).norm();
    ++number[border];
  }
  CHECK(length[1] / number[1] == Approx(length[0] / number[0]).epsilon(0.1));
  require_pattern(mesh, 0.6 * 0.6 / 2 * number[1] * std::sin(2 * std::numbers::pi / number[1]), 0, 20);
}

TEST_CASE("random triangulations are exact in number and the same for one seed") {
  const unsigned seed = GENERATE(range(0u, 6u));
  const TriangleMesh mesh = random_triangulation({0.5, 2}, 1600, seed);
  CHECK(mesh.vertices.rows() == 1600);
  require_pattern(mesh, 1, 0, 15);
  CHECK(same(mesh, random_triangulation({0.5, 2}, 1600, seed)));
  CHECK_FALSE(same(mesh, random_triangulation({0.5, 2}, 1600, seed + 1)));

  const Positions& x = mesh.vertices;
  for (const auto& [cx, cy] : {std::pair{0., 0.}, {.5, 0.}, {.5, 2.}, {0., 2.}})
    CHECK((x.rowwise() - Eigen::RowVector3d(cx, cy, 0)).rowwise().norm().minCoeff() == 0);
  // Also for sides that no division hits exactly.
  for (const double height : {0.8, 0.7, 1.1, 0.3})
    for (const int vertices : {60, 61, 150})
      CHECK(check_mesh(random_triangulation({1, height}, vertices, 2)).empty());
}

TEST_CASE("random numbers do not depend on the standard library") {
  Random random(5489);
  for (int i = 1; i < 10000; ++i) random.unit();
  // The C++ standard's check of mt19937_64: its 10000th number is 9981545732273789042.
  CHECK(random.unit() == static_cast<double>(9981545732273789042ull >> 11) * 0x1.0p-53);
}

TEST_CASE("patterns refuse what no experiment can ask for") {
  CHECK_THROWS_WITH(grid({1, 0}, 3, 3, Diagonals::one_way), "grid: the size must be positive");
  CHECK_THROWS_WITH(equilateral({1, 0}, 3, 3), "equilateral: the size must be positive");
  CHECK_THROWS_WITH(disc(-1, 100), "disc: the radius must be positive");
  const auto refused = [](const std::vector<Polygon>& loops, const std::string& fault, int count = 100) {
    CHECK_THROWS_WITH(delaunay_polygon(loops, count, 0), Catch::StartsWith("polygon: " + fault));
  };
  refused({}, "there is no loop");
  refused({unit_square}, "at least three vertices are needed", 2);
  refused({{{0, 0}, {1, NAN}, {2, 0}}}, "loop 0 (the outer border) has a coordinate that is not finite");
  Polygon comb;  // 43 corners
  for (int i = 0; i < 20; ++i) comb.insert(comb.end(), {{i / 20., 0}, {(i + 0.5) / 20, 0.1}});
  comb.insert(comb.end(), {{1, 0}, {1, 1}, {0, 1}});
  refused({comb}, "about 20 vertices are not possible; the nearest number is ", 20);
}

#include "core/numerics/collision_detection/intersections.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <random>

#include "core/numerics/patterns/generate.h"
#include "tests/support/meshes.h"

using namespace drape;

namespace {

using Vector = Eigen::Vector3d;

std::size_t count(const TriangleMesh& mesh) { return self_intersections(mesh).size(); }

/// Two triangles without a common vertex: (0,0,0) (1,0,0) (0,1,0), and this one.
std::size_t count_against_unit(const Vector& a, const Vector& b, const Vector& c) {
  const TriangleMesh unit = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}),
                     other = mesh_of({a, b, c}, {{0, 1, 2}});
  const std::size_t between = intersections(unit, other).size();
  CHECK(intersections(other, unit).size() == between);
  CHECK(count(both_of(unit, other, {0, 0, 0})) == between);
  return between;
}

std::vector<std::pair<int, int>> by_cgal(const TriangleMesh& mesh) {
  using Point = CGAL::Exact_predicates_inexact_constructions_kernel::Point_3;
  using Surface = CGAL::Surface_mesh<Point>;
  Surface surface;
  for (const auto& x : mesh.vertices.rowwise()) surface.add_vertex(Point(x[0], x[1], x[2]));
  for (const auto& t : mesh.triangles.rowwise())
    surface.add_face(Surface::Vertex_index(t[0]), Surface::Vertex_index(t[1]), Surface::Vertex_index(t[2]));
  std::vector<std::pair<Surface::Face_index, Surface::Face_index>> faces;
  CGAL::Polygon_mesh_processing::self_intersections(surface, std::back_inserter(faces));
  std::vector<std::pair<int, int>> pairs;
  for (const auto& [s, t] : faces) {
    const int a = static_cast<int>(s.idx()), b = static_cast<int>(t.idx());
    pairs.emplace_back(std::min(a, b), std::max(a, b));
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

TEST_CASE("intersections: two triangles without a common vertex") {
  CHECK(count_against_unit({.2, .2, -1}, {.3, .2, 1}, {.2, .4, 1}) == 1);     // through it
  CHECK(count_against_unit({.2, .2, 1e-12}, {.3, .2, 1}, {.2, .4, 1}) == 0);  // just above
  CHECK(count_against_unit({.2, .2, 0}, {.3, .2, 1}, {.2, .4, 1}) == 1);      // a vertex touches its inside
  CHECK(count_against_unit({.5, 0, 0}, {.5, -1, 0}, {.6, -1, 1}) == 1);       // a vertex touches its edge
  CHECK(count_against_unit({.5, -1e-16, 0}, {.5, -1, 0}, {.6, -1, 1}) == 0);  // not quite
  CHECK(count_against_unit({0, 0, 0}, {-1, 0, 0}, {0, -1, 0}) == 1);          // vertices coincide
  CHECK(count_against_unit({.1, .1, 0}, {.2, .1, 0}, {.1, .2, 0}) == 1);      // coplanar, inside
  CHECK(count_against_unit({.6, .6, 0}, {2, .6, 0}, {.6, 2, 0}) == 0);        // coplanar, beside
  CHECK(count_against_unit({-1, .5, 0}, {2, .5, 0}, {2, .7, 0}) == 1);        // coplanar, across
  CHECK(count_against_unit({0, 0, 1e-300}, {1, 0, 1e-300}, {0, 1, 1e-300}) == 0);  // parallel
  CHECK(count_against_unit({.5, -.5, -.5}, {.5, .5, .5}, {.5, -.5, .5}) == 1);     // an edge touches an edge
}

TEST_CASE("intersections: neighbours") {
  const Vector a(0, 0, 0), b(1, 0, 0), c(.3, 1, 0);
  // Sharing the edge ab, with the angle between them from flat to folded flat.
  const auto hinge = [&](const Vector& d) { return count(mesh_of({a, b, c, d}, {{0, 1, 2}, {1, 0, 3}})); };
  for (const double degrees : {180.0, 150.0, 90.0, 60.0, 1.0, 1e-7}) {
    const double t = degrees * M_PI / 180;
    CHECK(hinge({.6, std::cos(t), degrees == 180 ? 0 : std::sin(t)}) == 0);
  }
  CHECK(hinge({.6, .8, 0}) == 1);
  CHECK(hinge({.6, .8, 1e-15}) == 0);
  // Sharing the vertex a.
  const auto fan = [&](const Vector& d, const Vector& e) {
    return count(mesh_of({a, b, c, d, e}, {{0, 1, 2}, {0, 3, 4}}));
  };
  CHECK(fan({-1, 0, 0}, {0, -1, 0}) == 0);        // opposite, in the plane
  CHECK(fan({.5, .2, 1}, {.4, .3, -1}) == 1);     // through it
  CHECK(fan({.5, .2, 1}, {.4, .3, 1e-12}) == 0);  // above it
  CHECK(fan({.5, .2, 0}, {.4, .3, 1}) == 1);      // an edge along its inside
  CHECK(fan({-.1, 1, 1}, {-.1, 1, -1}) == 0);     // beside it
  CHECK(fan({.2, .1, 0}, {.2, .2, 0}) == 1);      // in the plane, overlapping
  CHECK(fan({1, 0, 0}, {.5, -1, 0}) == 1);        // an edge with the same ends but another vertex
  // Twice the same triangle.
  CHECK(count(mesh_of({a, b, c}, {{0, 1, 2}, {1, 2, 0}})) == 1);
}

TEST_CASE("intersections: pairs are ordered, with a point near them") {
  TriangleMesh mesh = grid({1, 1}, 12, 12, Diagonals::one_way);
  CHECK(count(mesh) == 0);
  const TriangleMesh needle = mesh_of({{.31, .52, -1}, {.32, .52, -1}, {.31, .53, 1}}, {{0, 1, 2}});
  const std::vector<TrianglePair> found = intersections(mesh, needle);
  REQUIRE(!found.empty());
  for (std::size_t i = 0; i < found.size(); ++i) {
    CHECK(found[i].second == 0);
    CHECK((found[i].where - Vector(.31, .525, 0)).norm() < 0.05);
    if (i > 0) CHECK(found[i - 1].first < found[i].first);
  }
  CHECK(intersections(mesh, mesh_of({{5, 5, 5}, {6, 5, 5}, {5, 6, 5}}, {{0, 1, 2}})).empty());
  CHECK(intersections(TriangleMesh(), needle).empty());
  CHECK(self_intersections(TriangleMesh()).empty());
}

TEST_CASE("intersections: the same as CGAL's on crumpled cloths") {
  std::mt19937 random(8);
  for (const double noise : {0.0, 0.003, 0.02, 0.2}) {
    TriangleMesh mesh = grid({1, 1}, 30, 30, Diagonals::criss_cross);
    std::uniform_real_distribution<double> move(-noise, noise);
    for (Eigen::Index i = 0; i < mesh.vertices.size(); ++i) mesh.vertices.data()[i] += move(random);
    mesh.vertices *= Eigen::AngleAxisd(-0.7, Vector(1, 2, 3).normalized()).toRotationMatrix();
    std::vector<std::pair<int, int>> found;
    for (const TrianglePair& pair : self_intersections(mesh)) found.emplace_back(pair.first, pair.second);
    CHECK(found == by_cgal(mesh));
    if (noise == 0.2) REQUIRE(found.size() > 1000);
    if (noise < 0.01) CHECK(found.empty());
  }
}

TEST_CASE("intersections: triangles without area touch their neighbours") {
  TriangleMesh one_point = grid({1, 1}, 4, 4, Diagonals::one_way), one_line = one_point,
               two_vertices_in_one_place = one_point;
  one_point.vertices.rowwise() = one_line.vertices.row(5);
  one_line.vertices.col(1).setZero();
  two_vertices_in_one_place.vertices.row(5) = two_vertices_in_one_place.vertices.row(6);
  for (const TriangleMesh& mesh : {one_point, one_line, two_vertices_in_one_place}) CHECK(count(mesh) > 0);
}

// Openings of a garment that a part of a body passes through, or none: on solids of revolution.

#include "core/numerics/dressing/openings.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "core/numerics/mesh/unjoined_borders.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/meshes.h"
#include "tests/support/sewn.h"

using namespace drape;

namespace {

using Profile = std::vector<Eigen::Vector2d>;  // radius and height [m]

/// The profile with points between its corners, at most 2 cm apart.
Profile divided(const Profile& corners) {
  Profile points;
  for (std::size_t k = 0; k + 1 < corners.size(); ++k) {
    const Eigen::Vector2d way = corners[k + 1] - corners[k];
    const int count = static_cast<int>(std::ceil(way.norm() / 0.02));
    for (int i = 0; i < count; ++i) points.push_back(corners[k] + i * way / count);
  }
  points.push_back(corners.back());
  return points;
}

/// A surface of revolution about an upright axis through `at`. Points of the profile with radius 0 close it.
TriangleMesh revolved(const Profile& corners, const Eigen::Vector3d& at = {0, 0, 0}, int around = 40) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  std::vector<int> ring, last;
  for (const Eigen::Vector2d& point : divided(corners)) {
    ring.clear();
    for (int i = 0; i < around; ++i) {
      const double angle = 2 * M_PI * i / around;
      if (point[0] > 0 || i == 0)
        vertices.push_back(at +
                           Eigen::Vector3d(point[0] * std::cos(angle), point[0] * std::sin(angle), point[1]));
      ring.push_back(static_cast<int>(vertices.size()) - 1);
    }
    for (int i = 0; i < around && !last.empty(); ++i) {
      const int next = (i + 1) % around;
      if (last[i] != last[next]) triangles.push_back({last[i], last[next], ring[next]});
      if (ring[i] != ring[next]) triangles.push_back({last[i], ring[next], ring[i]});
    }
    last = ring;
  }
  return mesh_of(vertices, triangles);
}

/// A closed upright rod.
TriangleMesh rod(double radius, double low, double high, const Eigen::Vector3d& at = {0, 0, 0}) {
  return revolved({{0, low}, {radius, low}, {radius, high}, {0, high}}, at);
}

/// A ring about a horizontal axis, of a round wire.
TriangleMesh ring(double radius, double wire, const Eigen::Vector3d& at) {
  constexpr int along = 60, across = 12;
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3i> triangles;
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < across; ++j) {
      const double angle = 2 * M_PI * i / along, own = 2 * M_PI * j / across,
                   r = radius + wire * std::cos(own);
      vertices.push_back(at +
                         Eigen::Vector3d(r * std::cos(angle), wire * std::sin(own), r * std::sin(angle)));
      const int next = (i + 1) % along, other = (j + 1) % across;
      triangles.push_back({i * across + j, next * across + j, next * across + other});
      triangles.push_back({i * across + j, next * across + other, i * across + other});
    }
  return mesh_of(vertices, triangles);
}

/// Whether each opening of a cloth is passed, by the length of its border, the shortest first.
std::vector<bool> passed(const TriangleMesh& cloth, const TriangleMesh& body) {
  const Level level = Level::of(0, cloth);
  std::vector<Opening> openings = openings_of(level, cloth.vertices, body);
  std::vector<bool> all;
  for (std::size_t k = openings.size(); k-- > 0;) all.push_back(openings[k].passed);
  for (std::size_t k = 0; k + 1 < openings.size(); ++k) CHECK(openings[k].length >= openings[k + 1].length);
  return all;
}

using Bools = std::vector<bool>;

/// A trunk that is open below, and a narrow sleeve from the middle of its top, out of the trunk or into it.
TriangleMesh trunk(double sleeve_end) {
  return revolved({{0.3, -0.5}, {0.3, 0}, {0.1, 0}, {0.1, sleeve_end}});
}

}  // namespace

TEST_CASE("Both openings of a tube are passed by a rod in it, and none by a rod beside it") {
  const TriangleMesh tube = revolved({{0.2, 0}, {0.15, 0.3}});
  CHECK(passed(tube, rod(0.1, -0.5, 0.8)) == Bools{true, true});
  CHECK(passed(tube, rod(0.1, -0.5, 0.8, {0.4, 0, 0})) == Bools{false, false});
  CHECK(passed(tube, rod(0.1, -0.5, -0.1)) == Bools{false, false});
  CHECK(passed(tube, rod(0.1, -0.5, 0.8, {3e6, 0, 0})) == Bools{false, false});
}

TEST_CASE("A border has the length and the middle of its half-edges, which follow one another") {
  const TriangleMesh tube = revolved({{0.2, 0}, {0.1, 0.3}}, {1, 2, 3}, 200);
  const std::vector<Opening> openings = openings_of(Level::of(0, tube), tube.vertices, rod(0.05, 0, 1));
  REQUIRE(openings.size() == 2);
  CHECK(openings[0].length == Approx(2 * M_PI * 0.2).epsilon(1e-3));
  CHECK((openings[0].middle - Eigen::Vector3d(1, 2, 3)).norm() < 1e-12);
  CHECK((openings[1].middle - Eigen::Vector3d(1, 2, 3.3)).norm() < 1e-12);
  for (const Opening& opening : openings) {
    REQUIRE(opening.half_edges.size() == 200);
    for (std::size_t k = 0; k < 200; ++k)
      CHECK(HalfEdge::of(tube.triangles, opening.half_edges[k]).to ==
            HalfEdge::of(tube.triangles, opening.half_edges[(k + 1) % 200]).from);
  }
}

TEST_CASE("A hem below the feet and a cuff beyond the hand are passed, also in a tapered tube") {
  const TriangleMesh tube = revolved({{0.2, 0}, {0.2, 1}});
  CHECK(passed(tube, rod(0.1, 0.3, 1.5)) == Bools{true, true});
  CHECK(passed(revolved({{0.08, 0}, {0.13, 0.8}}), rod(0.05, 0.5, 1.5)) == Bools{true, true});
}

TEST_CASE("A sleeve without an arm is told, beside its trunk and pushed into it") {
  const TriangleMesh body = rod(0.05, -1, -0.02, {0.2, 0, 0});  // up to the trunk's top
  CHECK(passed(trunk(0.3), body) == Bools{false, true});
  CHECK(passed(trunk(-0.3), body) == Bools{false, true});
  const TriangleMesh wide = rod(0.28, -1, -0.02);  // whose end is below the sleeve
  CHECK(passed(trunk(0.3), wide) == Bools{false, true});
  CHECK(passed(trunk(0.3), rod(0.05, -1, 0.5)) == Bools{true, true});
  CHECK(passed(trunk(-0.3), rod(0.05, -1, 0.5)) ==
        Bools{true, true});  // an arm in a sleeve that was pushed in
}

TEST_CASE("A body of several parts passes with one of them, and what reaches in by less than 2 cm does not") {
  const TriangleMesh torso = rod(0.25, -1, -0.02), arm = rod(0.05, -0.01, 0.5);
  CHECK(passed(trunk(0.3), both_of(torso, arm, Eigen::RowVector3d::Zero())) == Bools{true, true});
  CHECK(passed(trunk(0.3), both_of(arm, torso, Eigen::RowVector3d::Zero())) == Bools{true, true});
  const TriangleMesh tube = revolved({{0.1, 0}, {0.3, 0.01}});
  CHECK(passed(tube, rod(0.006, -1, 0.012)) == Bools{false, false});
  CHECK(passed(tube, rod(0.006, -1, 0.05)) == Bools{true, true});
}

TEST_CASE("A closed ring passes through a tube around its wire, as an arm with its hand on the hip") {
  const TriangleMesh tube = revolved({{0.1, -0.1}, {0.1, 0.1}}), rings = ring(0.4, 0.05, {0.4, 0, 0});
  CHECK(passed(tube, rings) == Bools{true, true});
  CHECK(passed(tube, ring(0.4, 0.05, {0.6, 0, 0})) == Bools{false, false});
  CHECK(passed(tube, ring(0.4, 0.05, {0.29, 0, 0})) == Bools{false, false});  // one that the tube cuts into
}

TEST_CASE("A tube that is bent flat around a rod is not passed by it, but by a rod inside") {
  TriangleMesh tube = revolved({{0.2, 0}, {0.2, 0.02}});
  const Eigen::Index around = tube.vertices.rows() / 2;
  for (Eigen::Index v = 0; v < tube.vertices.rows(); ++v) {  // outside from -150 to 150 degrees, inside back
    const auto part = static_cast<double>(v % around) / static_cast<double>(around);
    const bool outside = part < 0.5;
    const double angle = (outside ? 4 * part - 1 : 3 - 4 * part) * 150 * M_PI / 180,
                 radius = outside ? 0.2 : 0.12;
    tube.vertices.row(v).head(2) << radius * std::cos(angle), radius * std::sin(angle);
  }
  CHECK(passed(tube, rod(0.01, -0.513, 0.5, {0.08, 0, 0})) == Bools{false, false});
  CHECK(passed(tube, rod(0.01, -0.5, 0.5, {0.16, 0, 0})) == Bools{true, true});
}

TEST_CASE("A sheet has no opening, and a bag of two sewn sheets has one") {
  constexpr double side = 0.4;
  const TriangleMesh sheet = grid({side, side}, 9, 9, Diagonals::criss_cross);
  CHECK(passed(sheet, rod(0.05, -0.5, 0.5)).empty());
  CHECK(passed(as_piece(sheet), rod(0.05, -0.5, 0.5)).empty());
  TriangleMesh back = sheet;
  back.triangles.col(1).swap(back.triangles.col(2));
  for (auto x : back.vertices.rowwise())
    if (x[0] > 0.01 && x[0] < side - 0.01 && x[1] > 0.01) x[2] = 0.1;
  TriangleMesh bag = both_of(sheet, back, Eigen::RowVector3d::Zero());
  join_vertices(bag, 1e-6);
  bag = as_piece(bag);
  const Eigen::Vector3d middle(side / 2, side / 2, 0.05);
  TriangleMesh stick = rod(0.02, 0, 0.5);
  for (auto x : stick.vertices.rowwise()) x = Eigen::RowVector3d(x[1], x[2], -x[0]) + middle.transpose();
  CHECK(passed(bag, stick) == Bools{true});
  stick.vertices.rowwise() += Eigen::RowVector3d(0, 0, 0.2);
  CHECK(passed(bag, stick) == Bools{false});
}

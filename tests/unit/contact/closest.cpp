#include "core/numerics/collision_detection/closest.h"

#include <algorithm>
#include <set>
#include <vector>

#include "tests/unit/contact/pairs.h"

using namespace drape;
using Eigen::Vector3d;

namespace {

/// The height of a triangle (x1, x2, x3) that closest() takes for its edges, being so thin; 0 of others.
/// Which of the edges is the nearest rounding may decide, so that a vertex can lie ahead by so much.
double height_left_out(const PairPositions& x) {
  const Vector3d a = x.col(2) - x.col(1), b = x.col(3) - x.col(1);
  const double area = a.cross(b).norm(), longest = std::max({a.norm(), b.norm(), (b - a).norm()});
  return area <= 1e-11 * a.norm() * b.norm() && longest > 0 ? area / longest : 0;
}

/// The weights are those of a point on either side, and no other pair of points is nearer: by convexity that
/// holds when no vertex lies on the near side of its side's point, seen along r.
void check_optimal(PairKind kind, const PairPositions& x) {
  const Closest found = closest(kind, x);
  const int first = first_primitive_size(kind);
  CAPTURE(x, found.c.transpose());
  CHECK(std::abs(found.c.head(first).sum() - 1) <= 1e-15);
  CHECK(std::abs(found.c.sum()) <= 1e-15 * found.c.norm());
  CHECK(found.c.head(first).minCoeff() >= 0);
  CHECK(found.c.tail(4 - first).maxCoeff() <= 0);
  const Vector3d r = connection(x, found);
  Vector3d a = Vector3d::Zero(), b = Vector3d::Zero();  // from x_0
  for (int k = 1; k < 4; ++k)
    (k < first ? a : b) += (k < first ? 1 : -1) * found.c[k] * (x.col(k) - x.col(0));
  const double size = (x.colwise() - x.col(0)).norm();
  const double left_out = kind == PairKind::point_triangle ? height_left_out(x) : 0;
  for (int k = 0; k < 4; ++k) {
    const Vector3d from_own = x.col(k) - x.col(0) - (k < first ? a : b);
    const double ahead = r.dot(from_own) * (k < first ? 1 : -1);
    CHECK(ahead >= -4e-15 * size * (from_own.norm() + r.norm()) - left_out * r.norm());
  }
}

}  // namespace

TEST_CASE("no other points of a random pair are closer") {
  std::mt19937 random(1);
  for (const auto kind : {PairKind::point_triangle, PairKind::edge_edge}) {
    std::set<std::vector<bool>> regions;
    for (int i = 0; i < 3000; ++i) {
      const PairPositions x = random_pair(random);
      check_optimal(kind, x);
      const Closest found = closest(kind, x);
      std::vector<bool> zeros;
      for (int k = 0; k < 4; ++k) zeros.push_back(found.c[k] == 0);
      regions.insert(zeros);
    }
    // face, 3 edges, 3 vertices; 3 × 3 places on two edges
    CHECK(regions.size() == (kind == PairKind::edge_edge ? 9 : 7));
  }
}

TEST_CASE("near-degenerate pairs keep an exact distance") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  const auto small = [&] { return std::pow(10, -16 * unit(random)); };
  for (int i = 0; i < 40000; ++i) {
    PairPositions x = random_pair(random);
    const double size = small();
    switch (i % 7) {
      case 0:  // nearly parallel edges, or a needle
        x.col(3) = x.col(2) + x.col(1) - x.col(0) + size * x.col(3);
        break;
      case 1:  // nearly in one line
        x.col(2) = x.col(0) + unit(random) * (x.col(1) - x.col(0)) + size * x.col(2);
        x.col(3) = x.col(0) + 2 * unit(random) * (x.col(1) - x.col(0)) + small() * x.col(3);
        break;
      case 2:  // a short edge
        x.col(3) = x.col(2) + size * x.col(3);
        break;
      case 3:  // near to touching, in the middle
        x.col(0) = (x.col(1) + x.col(2) + x.col(3)) / 3 + size * x.col(0);
        break;
      case 4:  // a cap: vertex 1 next to the middle of the side opposite
        x.col(1) = x.col(2) + unit(random) * (x.col(3) - x.col(2)) + size * x.col(1);
        break;
      case 5:  // next to the inside of a needle, either way round
        x.col(3) = x.col(i % 2 ? 2 : 1) + size * x.col(3);
        x.col(0) = x.col(1) + 0.3 * (x.col(2) - x.col(1)) + 0.4 * (x.col(3) - x.col(1)) + small() * x.col(0);
        break;
      default:  // near to one plane
        x.row(2) *= size;
    }
    check_optimal(PairKind::point_triangle, x);
    check_optimal(PairKind::edge_edge, x);
  }
}

TEST_CASE("exactly degenerate pairs") {
  using enum PairKind;
  const Vector3d o(0, 0, 0), e1(1, 0, 0), e2(0, 1, 0), e3(0, 0, 1);
  const auto expect = [](PairKind kind, const PairPositions& x, double distance) {
    check_optimal(kind, x);
    CHECK(connection(x, closest(kind, x)).norm() == distance);
  };
  // Parallel edges: side by side, one behind the other, of opposite directions, on one line.
  expect(edge_edge, pair_at(o, e1, e2, e1 + e2), 1);
  expect(edge_edge, pair_at(o, e1, 3 * e1, 4 * e1), 2);
  expect(edge_edge, pair_at(o, e1, 0.5 * e1 + e2, -2 * e1 + e2), 1);
  expect(edge_edge, pair_at(o, e1, -3 * e1 + 4 * e2, -4 * e1 + 4 * e2), 5);
  expect(edge_edge, pair_at(o, e1, 0.5 * e1, 2 * e1), 0);
  // Edges without length, and edges that cross at right angles.
  expect(edge_edge, pair_at(o, o, -e1, e1), 0);
  expect(edge_edge, pair_at(-e1, e1, e3, e3), 1);
  expect(edge_edge, pair_at(o, o, e3, e3), 1);
  expect(edge_edge, pair_at(-e1, e1, e3 - e2, e3 + e2), 1);
  // Triangles without area: a line, a point.
  expect(point_triangle, pair_at(e2, o, e1, 2 * e1), 1);
  expect(point_triangle, pair_at(e2 + 1.5 * e1, o, 2 * e1, e1), 1);
  expect(point_triangle, pair_at(e2 + 1.5 * e1, e1, o, 2 * e1), 1);
  expect(point_triangle, pair_at(e2, o, o, o), 1);
  expect(point_triangle, pair_at(e2, o, o, e1), 1);
  // Over a corner, an edge and the inside of a triangle.
  expect(point_triangle, pair_at(e3, o, e1, e2), 1);
  CHECK(closest_point_triangle(e3, o, e1, e2).free == 0);
  CHECK(closest_point_triangle(e3 + 0.5 * e1, o, e1, e2).free == 1);
  CHECK(closest_point_triangle(e3 + 0.3 * (e1 + e2), o, e1, e2).free == 2);
  CHECK(nearest_on_segment(o, e1) == 0);
}

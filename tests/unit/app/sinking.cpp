#include "core/app/dressing/sinking.h"

#include <catch2/catch.hpp>

#include "core/numerics/patterns/generate.h"

using namespace drape;

TEST_CASE("Each garment sinks by itself, along its own loads") {
  // Two sheets, of which the second has a fifth of the first one's vertices, but the same area.
  TriangleMesh both = grid({1, 1}, 10, 10, Diagonals::one_way);
  const TriangleMesh coarse = grid({1, 1}, 4, 4, Diagonals::one_way);
  const Eigen::Index first = both.vertices.rows(), triangles = both.triangles.rows();
  both.vertices.conservativeResize(first + coarse.vertices.rows(), 3);
  both.vertices.bottomRows(coarse.vertices.rows()) = coarse.vertices.rowwise() + Eigen::RowVector3d(2, 0, 0);
  both.triangles.conservativeResize(triangles + coarse.triangles.rows(), 3);
  both.triangles.bottomRows(coarse.triangles.rows()) = coarse.triangles.array() + static_cast<int>(first);
  const Level level = Level::of(0, both);
  const Positions from = both.vertices;
  Positions to = from, loads = Positions::Zero(from.rows(), 3);
  loads.topRows(first).col(1).setConstant(-3);  // down is -y for the first, x for the second
  loads.bottomRows(from.rows() - first).col(0).setConstant(0.1);
  to.topRows(first).col(1).array() += 0.3;  // rises
  to.topRows(first).col(2).array() -= 5;    // beside
  CHECK(sinking(level, loads, from, to) == 0);
  to.bottomRows(from.rows() - first).col(0).array() += 0.02;
  CHECK(sinking(level, loads, from, to) == Approx(0.02));
  // Half of the area goes down by .2, the other up by .1, whatever the number of vertices there.
  const Eigen::VectorXd x = from.col(0);
  for (int v = 0; v < first; ++v) to(v, 1) = from(v, 1) - 0.3 * x[v] + 0.1;
  CHECK(sinking(level, loads, from, to) == Approx(0.05).epsilon(1e-2));
  loads.setZero();
  CHECK(sinking(level, loads, from, to) == 0);
}

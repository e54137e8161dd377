#include "core/numerics/hierarchy/rest_interpolation.h"

#include <catch2/catch.hpp>
#include <random>

#include "core/numerics/hierarchy/midpoint.h"
#include "core/numerics/patterns/generate.h"

using namespace drape;

namespace {

Level scattered_sheet() { return Level::of(0, random_triangulation({1, 0.7}, 60, 3)); }

/// The split mesh's rest positions, each moved in the sheet's plane by up to 1 cm either way.
Positions moved_rest(const Level& coarse) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-0.01, 0.01);
  Positions rest = midpoint_weights(coarse) * coarse.rest.vertices;
  for (auto vertex : rest.rowwise()) vertex += Eigen::RowVector3d(shift(random), shift(random), 0);
  return rest;
}

}  // namespace

TEST_CASE("linear interpolation equals midpoint weights for vertices that rest at edge midpoints") {
  const Level coarse = scattered_sheet();
  const ProlongationMatrix midpoints = midpoint_weights(coarse);
  const Positions rest = midpoints * coarse.rest.vertices;
  const Positions rounded = rest.array() * (1 + 1e-14);
  const Positions x = Positions::Random(coarse.vertex_count(), 3);
  for (const Positions& fine_rest : {rest, rounded})
    CHECK(Positions(rest_interpolation(coarse, fine_rest) * x) == Positions(midpoints * x));
}

TEST_CASE("linear interpolation reproduces rest positions, also outside the border") {
  const Level coarse = scattered_sheet();
  const Positions rest = moved_rest(coarse);
  const ProlongationMatrix linear = rest_interpolation(coarse, rest);
  CHECK((linear * coarse.rest.vertices - rest).cwiseAbs().maxCoeff() <= 1e-14);
  CHECK((midpoint_weights(coarse) * coarse.rest.vertices - rest).cwiseAbs().maxCoeff() > 0.005);
  const Eigen::VectorXd sums = linear * Eigen::VectorXd::Ones(coarse.vertex_count());
  CHECK((sums.array() - 1).abs().maxCoeff() <= 1e-15);
}

TEST_CASE("a vertex follows the triangle that contains its rest position") {
  const Level coarse = Level::of(0, grid({1, 1}, 2, 2, Diagonals::one_way));
  Positions rest = midpoint_weights(coarse) * coarse.rest.vertices;
  const auto corner = coarse.rest.triangles.row(1);
  const Eigen::RowVector3d inside = 0.2 * coarse.rest.vertices.row(corner[0]) +
                                    0.3 * coarse.rest.vertices.row(corner[1]) +
                                    0.5 * coarse.rest.vertices.row(corner[2]);
  rest.row(corner[0]) = inside;
  const Positions x = Positions::Random(4, 3);
  const Positions fine = rest_interpolation(coarse, rest) * x;
  CHECK((fine.row(corner[0]) - (0.2 * x.row(corner[0]) + 0.3 * x.row(corner[1]) + 0.5 * x.row(corner[2])))
            .norm() <= 1e-15);

  // Above a bent rest shape its projection to the nearest triangle counts.
  Positions lifted = rest;
  lifted.row(corner[0]) += Eigen::RowVector3d(0, 0, 0.05);
  CHECK((rest_interpolation(coarse, lifted) * x - fine).norm() <= 1e-15);
}

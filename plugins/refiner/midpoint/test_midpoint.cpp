#include <catch2/catch.hpp>

#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/unregistered.h"
// After it:
#include "plugins/refiner/midpoint/midpoint.cpp"

using namespace drape;

TEST_CASE("midpoint refinement does not move a crumpled surface", "[refiner][midpoint]") {
  TriangleMesh mesh = random_triangulation({1, 1}, 80, 3);
  mesh.vertices.col(2) = 0.1 * (20 * mesh.vertices.col(0) + 9 * mesh.vertices.col(1)).array().sin();
  const Hierarchy hierarchy = Hierarchy::of(mesh, MidpointRefiner(), 3);
  const double area = hierarchy.levels[0].vertex_area.sum();
  CHECK(area > 1.1);
  for (int l = 0; l < 2; ++l) {
    CHECK(hierarchy.prolongations[l].isApprox(hierarchy.midpoints[l]));
    const Eigen::VectorXd sums =
        hierarchy.prolongations[l] * Eigen::VectorXd::Ones(hierarchy.prolongations[l].cols());
    CHECK((sums.array() == 1).all());
    CHECK(hierarchy.levels[l + 1].vertex_area.sum() == Approx(area).epsilon(1e-13));
    const auto n = hierarchy.levels[l].vertex_count();
    CHECK(hierarchy.levels[l + 1].rest.vertices.topRows(n) == hierarchy.levels[l].rest.vertices);
  }
}

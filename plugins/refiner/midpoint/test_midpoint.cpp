#include <catch2/catch.hpp>

#include "core/numerics/hierarchy/midpoint.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/unregistered.h"
// After it:
#include "plugins/refiner/midpoint/midpoint.cpp"

using namespace drape;

TEST_CASE("midpoint: new vertices are the midpoints of edges", "[refiner][midpoint]") {
  const Level level = Level::of(0, random_triangulation({1, 1}, 80, 3));
  CHECK(MidpointRefiner().weights(level).isApprox(midpoint_weights(level)));
}

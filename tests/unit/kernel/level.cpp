#include "core/kernel/interfaces/level.h"

#include <catch2/catch.hpp>

#include "core/numerics/patterns/generate.h"

using namespace drape;

TEST_CASE("a level's vertex areas are thirds of its triangles", "[level]") {
  const Level level = Level::of(3, grid({2, 3}, 3, 4, Diagonals::one_way));
  CHECK(level.index == 3);
  CHECK(level.vertex_count() == 12);
  CHECK(level.triangle_count() == 12);
  CHECK(level.topology.edges.rows() == 12 + 12 - 1);
  REQUIRE(level.vertex_area.size() == 12);
  CHECK(level.vertex_area.sum() == Approx(6).epsilon(1e-14));
  CHECK(level.vertex_area[4] == Approx(6 * 0.5 / 3).epsilon(1e-14));  // inside: six triangles of 1/2
  CHECK(level.vertex_area[0] == Approx(2 * 0.5 / 3).epsilon(1e-14));
  CHECK(level.vertex_area[2] == Approx(1 * 0.5 / 3).epsilon(1e-14));
}

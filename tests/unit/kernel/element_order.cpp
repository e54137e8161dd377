#include "core/kernel/interfaces/element_order.h"

#include <catch2/catch.hpp>
#include <numeric>
#include <set>

#include "core/kernel/interfaces/level.h"
#include "core/numerics/patterns/generate.h"

using namespace drape;

namespace {

void check_order(const Stencils& stencils, const Positions& rest, int most_colours) {
  const ElementOrder order = ElementOrder::of(stencils, rest);
  std::vector<int> sorted = order.elements, all(stencils.rows());
  std::iota(all.begin(), all.end(), 0);
  std::sort(sorted.begin(), sorted.end());
  CHECK(sorted == all);
  CHECK(order.chunks() <= ElementOrder::max_chunks);
  CHECK(order.chunk_start.back() == stencils.rows());
  CHECK(order.colour_start.back() == order.chunks());
  CHECK(order.colours() <= most_colours);

  int odd_chunks = 0;
  for (int colour = 0; colour < order.colours(); ++colour) {
    std::set<int> earlier;  // vertices of this colour's chunks
    for (int c = order.colour_start[colour]; c < order.colour_start[colour + 1]; ++c) {
      odd_chunks += (order.chunk_start[c + 1] - order.chunk_start[c]) % 8 != 0;
      std::set<int> own;
      for (int i = order.chunk_start[c]; i < order.chunk_start[c + 1]; ++i)
        for (int k = 0; k < stencils.cols(); ++k) own.insert(stencils(order.elements[i], k));
      REQUIRE_FALSE(own.empty());
      for (const int v : own) REQUIRE(earlier.count(v) == 0);
      earlier.insert(own.begin(), own.end());
    }
  }
  CHECK(odd_chunks <= 1);
}

}  // namespace

TEST_CASE("Chunks of one colour share no vertex") {
  for (const int n : {2, 5, 40, 157}) {
    const Level level = Level::of(0, grid({1, 2}, n, n, Diagonals::one_way));
    check_order(level.rest.triangles, level.rest.vertices, 12);
    check_order(level.hinges, level.rest.vertices, 12);
  }
  const Level disordered = Level::of(0, random_triangulation({1, 1}, 3000, 1));
  check_order(disordered.hinges, disordered.rest.vertices, 12);
}

TEST_CASE("Elements around one vertex cost colours, not correctness") {
  Stencils fan(20000, 2);
  Positions rest(20001, 3);
  for (int i = 0; i < 20001; ++i) rest.row(i) << std::cos(i), std::sin(i), i;
  for (int i = 0; i < 20000; ++i) fan.row(i) << 0, i + 1;
  check_order(fan, rest, ElementOrder::max_chunks);
}

TEST_CASE("No elements, no chunks") {
  const ElementOrder order = ElementOrder::of(Stencils(0, 4), Positions(0, 3));
  CHECK(order.chunks() == 0);
  CHECK(order.colours() == 0);
}

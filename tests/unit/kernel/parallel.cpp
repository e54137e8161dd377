// Loops on several threads, and the order in which they go through elements.

#include "core/kernel/threads/parallel.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>
#include <vector>

#include "core/kernel/interfaces/element_order.h"
#include "core/kernel/interfaces/level.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/any_threads.h"

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

TEST_CASE("parallel_for covers a range once, in pieces that do not depend on the threads") {
  for (const int threads : {1, 2, 3, 7}) {
    set_thread_count(threads);
    REQUIRE(thread_count() == threads);
    for (const int size : {0, 1, 9, 10, 11, 1003})
      for (const int grain : {1, 10, 2000}) {
        std::vector<int> seen(size, 0);
        std::atomic<int> bad = 0, pieces = 0;
        parallel_for(size, grain, [&](int begin, int end) {
          ++pieces;
          bad += begin % grain != 0 || end != std::min(begin + grain, size) || begin >= end;
          for (int i = begin; i < end; ++i) ++seen[i];
        });
        CHECK(bad == 0);
        CHECK(pieces == (size + grain - 1) / grain);
        CHECK(seen == std::vector<int>(size, 1));
      }
  }
  set_thread_count(0);
  CHECK(core_count() >= 1);
  CHECK(thread_count() == core_count());
}

TEST_CASE("parallel_for can be nested, rethrows what a body throws, and works afterwards") {
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    CHECK_THROWS_WITH(parallel_for(1000, 1,
                                   [](int begin, int) {
                                     if (begin == 500) throw std::runtime_error("piece 500");
                                   }),
                      "piece 500");
    std::atomic<int> count = 0;
    parallel_for(8, 1,
                 [&](int, int) { parallel_for(100, 3, [&](int begin, int end) { count += end - begin; }); });
    CHECK(count == 800);
  }
  set_thread_count(0);
}

TEST_CASE("parallel_sum has the same bits with any number of threads") {
  const auto piece = [](int begin, int end) {
    double s = 0;
    for (int i = begin; i < end; ++i) s += std::sin(i) * std::exp(i % 40);
    return s;
  };
  const auto sum = [&] { return parallel_sum(100000, 37, piece); };
  REQUIRE(same_with_any_threads(sum, {1, 2, 2, 2, 3, 3, 3, 5, 5, 5}) != 0);
  CHECK(parallel_sum(0, 5, [](int, int) { return 1.0; }) == 0);
}

TEST_CASE("what pieces find is collected in their order") {
  const auto odd_numbers = [](int begin, int end, std::vector<int>& found) {
    for (int i = begin; i < end; ++i)
      if (i % 2) found.push_back(i);
  };
  const std::vector<int> odd =
      same_with_any_threads([&] { return parallel_collect<int>(1001, 7, odd_numbers); }, {1, 4});
  REQUIRE(odd.size() == 500);
  for (int k = 0; k < 500; ++k) CHECK(odd[k] == 2 * k + 1);
  const auto fails = [](int, int, std::vector<int>&) { FAIL("there is nothing to do"); };
  CHECK(parallel_collect<int>(0, 5, fails).empty());
}

TEST_CASE("Chunks of one colour share no vertex") {
  for (const int n : {2, 5, 40, 157}) {
    const Level level = Level::of(0, grid({1, 2}, n, n, Diagonals::one_way));
    check_order(level.rest.triangles, level.rest.vertices, 12);
    check_order(level.hinges, level.rest.vertices, 12);
  }
  const Level disordered = Level::of(0, random_triangulation({1, 1}, 3000, 1));
  check_order(disordered.hinges, disordered.rest.vertices, 12);
}

TEST_CASE("Elements around one vertex cost colours, not correctness; no elements make no chunks") {
  Stencils fan(20000, 2);
  Positions rest(20001, 3);
  for (int i = 0; i < 20001; ++i) rest.row(i) << std::cos(i), std::sin(i), i;
  for (int i = 0; i < 20000; ++i) fan.row(i) << 0, i + 1;
  check_order(fan, rest, ElementOrder::max_chunks);
  const ElementOrder none = ElementOrder::of(Stencils(0, 4), Positions(0, 3));
  CHECK(none.chunks() == 0);
  CHECK(none.colours() == 0);
}

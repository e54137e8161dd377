#include "core/kernel/threads/parallel.h"

#include <atomic>
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "tests/support/any_threads.h"

using namespace drape;

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

TEST_CASE("parallel_for can be nested") {
  set_thread_count(2);
  std::atomic<int> count = 0;
  parallel_for(8, 1,
               [&](int, int) { parallel_for(100, 3, [&](int begin, int end) { count += end - begin; }); });
  CHECK(count == 800);
  set_thread_count(0);
}

TEST_CASE("parallel_for rethrows what a body throws, and works afterwards") {
  for (const int threads : {1, 2}) {
    set_thread_count(threads);
    const auto run = [] {
      parallel_for(1000, 1, [](int begin, int) {
        if (begin == 500) throw std::runtime_error("piece 500");
      });
    };
    CHECK_THROWS_WITH(run(), "piece 500");
    std::atomic<int> count = 0;
    parallel_for(1000, 7, [&](int begin, int end) { count += end - begin; });
    CHECK(count == 1000);
  }
  set_thread_count(0);
}

TEST_CASE("parallel_sum has the same bits with any number of threads") {
  const auto sum = [] {
    return parallel_sum(100000, 37, [](int begin, int end) {
      double s = 0;
      for (int i = begin; i < end; ++i) s += std::sin(i) * std::exp(i % 40);
      return s;
    });
  };
  const double same = same_with_any_threads(sum, {1, 2, 2, 2, 3, 3, 3, 5, 5, 5});
  REQUIRE(same != 0);
  CHECK(parallel_sum(0, 5, [](int, int) { return 1.0; }) == 0);
}

TEST_CASE("what pieces find is collected in their order") {
  const auto odd_numbers = [] {
    return parallel_collect<int>(1001, 7, [](int begin, int end, std::vector<int>& found) {
      for (int i = begin; i < end; ++i)
        if (i % 2) found.push_back(i);
    });
  };
  const std::vector<int> odd = same_with_any_threads(odd_numbers, {1, 4});
  REQUIRE(odd.size() == 500);
  for (int k = 0; k < 500; ++k) CHECK(odd[k] == 2 * k + 1);
  CHECK(parallel_collect<int>(0, 5, [](int, int, std::vector<int>&) {
          FAIL("there is nothing to do");
        }).empty());
}

#include <catch2/catch.hpp>
#include <vector>

#include "core/app/run/errors.h"

using namespace drape;

namespace {

Positions positions_at(int iteration) { return Positions::Constant(4, 3, iteration / 3.0); }

/// The iterations that are kept of so many.
std::vector<int> kept(int most, int iterations) {
  SnapshotRecorder snapshots;
  for (int k = 1; k <= iterations; ++k) snapshots.iteration({0.1 * k, k, 5.0 * k}, positions_at(k), most);
  std::vector<int> of;
  for (const Snapshot& snapshot :
       snapshots.end_level({0.1 * iterations, iterations, 0}, positions_at(iterations))) {
    CHECK((snapshot.x - positions_at(snapshot.cost.iterations)).norm() == 0);
    of.push_back(snapshot.cost.iterations);
  }
  return of;
}

}  // namespace

TEST_CASE("snapshots are spread evenly, never more than asked for, the last state among them") {
  CHECK(kept(8, 0) == std::vector{0});
  CHECK(kept(8, 1) == std::vector{1});
  CHECK(kept(8, 5) == std::vector{1, 2, 3, 4, 5});
  CHECK(kept(8, 7) == std::vector{1, 2, 3, 4, 5, 6, 7});
  CHECK(kept(8, 8) == std::vector{1, 3, 5, 7, 8});
  CHECK(kept(8, 100) == std::vector{1, 17, 33, 49, 65, 81, 97, 100});
  CHECK(kept(1, 9) == std::vector{9});
  CHECK(kept(2, 9) == std::vector{1, 9});
  for (int most = 1; most < 12; ++most)
    for (int n = 0; n < 200; ++n) {
      const std::vector<int> all = kept(most, n);
      REQUIRE(static_cast<int>(all.size()) <= most);
      REQUIRE(all.back() == n);
    }
}

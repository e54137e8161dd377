#include <catch2/catch.hpp>

#include "core/numerics/contact/candidates.h"
#include "core/numerics/contact/moving_pairs.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/random.h"

using namespace drape;

namespace {

template <PairKind kind>
void check_bounds(RandomNumbers& random) {
  constexpr int W = native_pack_width;
  const auto small = [&] { return std::pow(10, random(-9, 0)); };
  const Positions none;
  int decided = 0, tests = 0;
  for (int round = 0; round < 4000; ++round) {
    Positions x0(4 * W, 3), x1(4 * W, 3);
    PairLanes<W> lanes;
    std::vector<ContactPair> pairs;
    for (int lane = 0; lane < W; ++lane) {
      // From wide apart to touching, from fat to slivers, with and without motion.
      const double flat = small(), thin = small(), motion = small() * (round % 4 != 0);
      for (int v = 4 * lane; v < 4 * lane + 4; ++v)
        for (int c = 0; c < 3; ++c) {
          x0(v, c) = random(-1, 1) * (c == 0 ? 1 : c == 1 ? thin : flat) + (round % 3 == 0 ? 100 : 0);
          x1(v, c) = x0(v, c) + motion * random(-1, 1);
        }
      pairs.push_back({{4 * lane, 4 * lane + 1, 4 * lane + 2, 4 * lane + 3}, kind});
      lanes.add(pairs.back().vertices, {x0, x1, 0, none, none});
    }
    const MovingPairs<kind, W> moving(lanes);
    const double dhat = small();
    const auto reach = moving.speed + dhat, still = Pack<W>(dhat);
    for (int lane = 0; lane < W; ++lane) {
      const bool may_come = may_come_within_dhat(pairs[lane], {x0, x1, dhat, none, none});
      const bool comes_at_once = may_come_within_dhat(pairs[lane], {x0, x0, dhat, none, none});
      CHECK(!(moving.beyond(reach)[lane] && may_come));
      CHECK(!(moving.within(reach)[lane] && !may_come));
      CHECK(!(moving.beyond(still)[lane] && comes_at_once));
      CHECK(moving.separation[lane] <= moving.distance[lane] + 1e-12 * moving.size[lane]);
      decided += moving.beyond(reach)[lane] || moving.within(reach)[lane];
      ++tests;
    }
  }
  CHECK(decided > 0.9 * tests);
}

}  // namespace

TEST_CASE("self pairs: SIMD's bounds decide nothing that the exact functions contradict") {
  RandomNumbers random(5);
  check_bounds<PairKind::point_triangle>(random);
  check_bounds<PairKind::edge_edge>(random);
}

TEST_CASE("self pairs: far from the origin boxes are as tight as near it") {
  const TriangleMesh rest = grid({1, 1}, 13, 11, Diagonals::criss_cross);
  const Topology topology = Topology::of(rest.triangles, static_cast<int>(rest.vertices.rows()));
  const Surface surface = Surface::of(rest, topology);
  const Positions near = rest.vertices + 0.02 * Positions::Random(rest.vertices.rows(), 3), none;
  long boxes[2] = {0, 0};
  for (const int far : {0, 1}) {
    const Positions x = near.array() + 1e6 * far;
    std::vector<ContactPair> found;
    SelfPairSearch search(surface, BroadPhaseKind::bvh);
    const PairLimits unlimited{1L << 40, 1L << 40};
    REQUIRE(search.find({x, x, 1e-3, none, none}, 0, unlimited, boxes[far], found));
  }
  CHECK(double(boxes[1]) < 1.1 * double(boxes[0]));
}

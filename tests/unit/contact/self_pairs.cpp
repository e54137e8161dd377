#include <catch2/catch.hpp>
#include <random>

#include "core/numerics/contact/candidates.h"
#include "core/numerics/contact/moving_pairs.h"
#include "core/numerics/contact/pair_geometry.h"
#include "core/numerics/patterns/generate.h"

using namespace drape;
using Eigen::Vector3d;

namespace {

constexpr PairLimits unlimited{1L << 40, 1L << 40};

/// A square cloth that is crumpled at random, the more the closer its parts come.
struct Crumpled {
  TriangleMesh rest = grid({1, 1}, 13, 11, Diagonals::criss_cross);
  Topology topology = Topology::of(rest.triangles, static_cast<int>(rest.vertices.rows()));
  Surface surface = Surface::of(rest, topology);
  Positions none;

  Positions at(double noise, unsigned seed) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> move(-noise, noise);
    Positions x = rest.vertices;
    for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] += move(random);
    return x;
  }

  LinearMotion motion(const Positions& x0, const Positions& x1, double dhat) const {
    return {x0, x1, dhat, none, none};
  }
};

Box box_of(const Positions& x0, const Positions& x1, std::initializer_list<int> vertices, double dhat) {
  Box box;
  const Eigen::RowVector3d origin = x0.row(0);
  for (const int v : vertices) box.include(Box::around(x0.row(v) - origin, x1.row(v) - origin, 0.5 * dhat));
  return box;
}

bool share_vertex(const std::array<int, 4>& v, int first_end) {
  for (int a = 0; a < first_end; ++a)
    for (int b = first_end; b < 4; ++b)
      if (v[a] == v[b]) return true;
  return false;
}

/// By the definition: the pairs whose boxes overlap and that may come within d̂, in the order of the triangles
/// that represent them.
std::vector<ContactPair> brute_force(const Crumpled& cloth, const LinearMotion& motion) {
  const Surface& s = cloth.surface;
  const Positions moved = motion.x1.rowwise() - (motion.x1 - motion.x0).colwise().mean();
  std::vector<ContactPair> all;
  const auto add = [&](const ContactPair& pair) {
    const auto& v = pair.vertices;
    const bool edges = pair.kind == PairKind::edge_edge;
    if (share_vertex(v, edges ? 2 : 1)) return;
    const auto box = [&](std::initializer_list<int> of) { return box_of(motion.x0, moved, of, motion.dhat); };
    const bool overlap =
        edges ? box({v[0], v[1]}).overlaps(box({v[2], v[3]})) : box({v[0]}).overlaps(box({v[1], v[2], v[3]}));
    if (overlap && may_come_within_dhat(pair, motion)) all.push_back(pair);
  };
  for (int a = 0; a < s.triangle_count(); ++a)
    for (int b = a + 1; b < s.triangle_count(); ++b) {
      for (const auto& [of, against] : {std::pair(a, b), std::pair(b, a)})
        for (int k = 0; k < 3; ++k)
          if (s.represents_vertex(of, k)) add(vertex_triangle(0, s.triangles(of, k), s, 0, against));
      for (int k = 0; k < 3; ++k)
        for (int m = 0; m < 3; ++m)
          if (s.represents_edge(a, k) && s.represents_edge(b, m))
            add(edge_edge(s, 0, s.triangle_edges(a, k), s, 0, s.triangle_edges(b, m)));
    }
  return all;
}

void check_same(const std::vector<ContactPair>& found, const std::vector<ContactPair>& expected) {
  REQUIRE(found.size() == expected.size());
  int different = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    different += found[i].vertices != expected[i].vertices || found[i].kind != expected[i].kind ||
                 found[i].mollifier != expected[i].mollifier;
  CHECK(different == 0);
}

template <PairKind kind>
void check_bounds(std::mt19937& random) {
  std::uniform_real_distribution<double> place(-1, 1), exponent(-9, 0);
  constexpr int W = native_pack_width;
  int decided = 0, tests = 0;
  for (int round = 0; round < 4000; ++round) {
    Positions x0(4 * W, 3), x1(4 * W, 3);
    PairLanes<W> lanes;
    std::vector<ContactPair> pairs;
    for (int lane = 0; lane < W; ++lane) {
      // From wide apart to touching, from fat to slivers, with and without motion.
      const double flat = std::pow(10, exponent(random)), thin = std::pow(10, exponent(random)),
                   motion = std::pow(10, exponent(random)) * (round % 4 != 0);
      for (int v = 4 * lane; v < 4 * lane + 4; ++v)
        for (int c = 0; c < 3; ++c) {
          x0(v, c) = place(random) * (c == 0 ? 1 : c == 1 ? thin : flat) + (round % 3 == 0 ? 100 : 0);
          x1(v, c) = x0(v, c) + motion * place(random);
        }
      pairs.push_back({{4 * lane, 4 * lane + 1, 4 * lane + 2, 4 * lane + 3}, kind});
      lanes.add(pairs.back().vertices, {x0, x1, 0, x0, x1});
    }
    const MovingPairs<kind, W> moving(lanes);
    const Positions none;
    const double dhat = std::pow(10, exponent(random));
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

TEST_CASE("self pairs: every kind of broad phase finds those of a brute-force search, in order") {
  const Crumpled cloth;
  for (const double noise : {0.0, 0.02, 0.3})
    for (const double step : {0.0, 0.01, 0.4})
      for (const double dhat : {1e-3, 0.05}) {
        CAPTURE(noise, step, dhat);
        const Positions x0 = cloth.at(noise, 1);
        Positions x1 = x0 + step * (cloth.at(1, 2) - cloth.at(0, 2));
        x1.col(1).array() += 5 * step;  // which all parts share
        const LinearMotion motion = cloth.motion(x0, x1, dhat);
        const std::vector<ContactPair> expected = brute_force(cloth, motion);
        if (noise > 0.1 && (step > 0.1 || dhat > 0.01)) REQUIRE(expected.size() > 1000);
        for (const BroadPhaseKind kind : {BroadPhaseKind::bvh, BroadPhaseKind::fcl}) {
          SelfPairSearch search(cloth.surface, kind);
          std::vector<ContactPair> found;
          long boxes = 0;
          REQUIRE(search.find(motion, 0.5, unlimited, boxes, found));
          check_same(found, expected);
          CHECK(boxes >= std::ssize(found));
          for (const ContactPair& pair : found) CHECK((pair.dhat == dhat && pair.friction == 0.5));
        }
      }
}

TEST_CASE("self pairs: SIMD's bounds decide nothing that the exact functions contradict") {
  std::mt19937 random(5);
  check_bounds<PairKind::point_triangle>(random);
  check_bounds<PairKind::edge_edge>(random);
}

TEST_CASE("self pairs: far from the origin boxes are as tight as near it") {
  const Crumpled cloth;
  long boxes[2] = {0, 0};
  for (const int far : {0, 1}) {
    const Positions x = cloth.at(0.02, 1).array() + 1e6 * far;
    std::vector<ContactPair> found;
    SelfPairSearch search(cloth.surface, BroadPhaseKind::bvh);
    REQUIRE(search.find(cloth.motion(x, x, 1e-3), 0, unlimited, boxes[far], found));
  }
  CHECK(double(boxes[1]) < 1.1 * double(boxes[0]));
}

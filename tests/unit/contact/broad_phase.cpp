#include "core/numerics/collision_detection/broad_phase.h"

#include <catch2/catch.hpp>
#include <functional>
#include <random>

using namespace drape;

namespace {

using Vector = Eigen::Vector3d;
constexpr long unlimited = 1L << 40;
constexpr BroadPhaseKind kinds[] = {BroadPhaseKind::bvh, BroadPhaseKind::fcl};

std::vector<Box> random_boxes(int count, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> place(-1, 1), extent(0, size);
  std::vector<Box> boxes;
  for (int i = 0; i < count; ++i) {
    const Vector low(place(random), place(random), place(random));
    boxes.push_back(Box::around(low, low + Vector(extent(random), extent(random), extent(random)), 0));
  }
  return boxes;
}

/// The boxes that overlap, of those that may be a pair; each box of one set only with those after it.
AdjacencyList brute_force(
    const std::vector<Box>& boxes, const std::vector<Box>& others, bool self,
    const std::function<bool(int, int)>& may_be_pair = [](int, int) { return true; }) {
  AdjacencyList rows;
  rows.start = {0};
  for (int i = 0; i < static_cast<int>(boxes.size()); ++i) {
    for (int j = self ? i + 1 : 0; j < static_cast<int>(others.size()); ++j)
      if (boxes[i].overlaps(others[j]) && may_be_pair(i, j)) rows.items.push_back(j);
    rows.start.push_back(static_cast<int>(rows.items.size()));
  }
  return rows;
}

void check_same(const AdjacencyList& found, const AdjacencyList& expected) {
  CHECK(found.start == expected.start);
  CHECK(found.items == expected.items);
}

AdjacencyList pairs_of(const BroadPhase& phase) {
  AdjacencyList pairs;
  REQUIRE(phase.overlaps(phase, unlimited, pairs));
  return pairs;
}

/// Every kind of broad phase finds these pairs of the boxes, and of them and others.
void check_every_kind(const std::vector<Box>& boxes, const AdjacencyList& own, const std::vector<Box>& others,
                      const AdjacencyList& with_others, const Stencils& vertices = {},
                      const Stencils& other_vertices = {}) {
  for (const BroadPhaseKind kind : kinds) {
    const auto phase = make_broad_phase(kind, vertices), other = make_broad_phase(kind, other_vertices);
    phase->update(boxes);
    other->update(others);
    check_same(pairs_of(*phase), own);
    AdjacencyList found;
    REQUIRE(phase->overlaps(*other, unlimited, found));
    check_same(found, with_others);
  }
}

}  // namespace

TEST_CASE("broad phase: a box bounds its points despite rounding") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-5, 5);
  for (int i = 0; i < 10000; ++i) {
    const Vector a(place(random), place(random), place(random)), b = a * 1e-3;
    const Box box = Box::around(a, b, 1e-9);
    for (int k = 0; k < 3; ++k) {
      CHECK(box.lower[k] <= std::min(a[k], b[k]) - 1e-9);
      CHECK(box.upper[k] >= std::max(a[k], b[k]) + 1e-9);
      CHECK(box.upper[k] - box.lower[k] <= std::abs(a[k] - b[k]) + 1e-5);
    }
  }
  CHECK(Box().is_empty());
  CHECK(!Box().overlaps(Box::around({-1, -1, -1}, {1, 1, 1}, 0)));
}

TEST_CASE("broad phase: boxes beyond the range of floats are clamped, and still overlap") {
  const Vector p(0.25, 0.5, 0.75);
  std::vector<Box> boxes;
  for (int i = 0; i < 100; ++i) boxes.push_back(Box::around(i * p, (i + 1) * p, i % 2 ? 1e39 : 1e300));
  boxes.push_back(Box::around(1e200 * p, 2e200 * p, 0));
  boxes.push_back(Box::around(p, -1e60 * p, 1e-3));
  for (const Box& box : boxes) {
    for (int k = 0; k < 3; ++k) CHECK(std::isfinite(box.upper[k] - box.lower[k]));
    CHECK(std::isfinite(box.half_area()));
  }
  const AdjacencyList expected = brute_force(boxes, boxes, true);
  CHECK(expected.items.size() == 102 * 101 / 2 - 1);  // all but the last two
  check_every_kind(boxes, expected, boxes, brute_force(boxes, boxes, false));
}

TEST_CASE("broad phase: every kind finds the pairs of a brute-force search") {
  for (const int count : {0, 1, 2, 8, 9, 63, 65, 700, 1500})
    for (const double size : {0.0, 0.1, 0.8}) {
      const std::vector<Box> boxes = random_boxes(count, size, count), others = random_boxes(333, size, 77);
      const AdjacencyList own_pairs = brute_force(boxes, boxes, true);
      const AdjacencyList pairs = brute_force(boxes, others, false);
      if (count > 600 && size > 0) REQUIRE(std::min(own_pairs.items.size(), pairs.items.size()) >= 10);
      check_every_kind(boxes, own_pairs, others, pairs);
    }
}

TEST_CASE("broad phase: boxes of primitives that share a vertex are no pair") {
  std::mt19937 random(9);
  const int count = 700, vertex_count = 90;
  std::uniform_int_distribution<int> vertex(0, vertex_count - 1);
  for (const int size : {1, 2, 3}) {
    Stencils vertices(count, size), others(vertex_count, 1);
    for (int i = 0; i < count; ++i)
      for (int k = 0; k < size; ++k) vertices(i, k) = vertex(random);
    for (int i = 0; i < vertex_count; ++i) others(i, 0) = i;
    const std::vector<Box> boxes = random_boxes(count, 0.6, 4), points = random_boxes(vertex_count, 0.3, 6);
    const auto share = [](const auto& a, const auto& b) {
      for (const int v : a)
        for (const int w : b)
          if (v == w) return true;
      return false;
    };
    const AdjacencyList own = brute_force(
        boxes, boxes, true, [&](int i, int j) { return !share(vertices.row(i), vertices.row(j)); });
    const AdjacencyList against = brute_force(
        boxes, points, false, [&](int i, int j) { return !share(vertices.row(i), others.row(j)); });
    REQUIRE(own.items.size() < brute_force(boxes, boxes, true).items.size());
    REQUIRE(against.items.size() > 100);
    check_every_kind(boxes, own, points, against, vertices, others);
  }
}

TEST_CASE("broad phase: degenerate, equal and touching boxes") {
  const Vector p(0.25, 0.5, 0.75);
  std::vector<Box> boxes(20, Box::around(p, p, 0));  // equal: all pairs
  for (int i = 0; i < 30; ++i) {                     // in a row, each shares a face with the next
    Box box;
    for (int k = 0; k < 3; ++k) box.lower[k] = box.upper[k] = 8;
    box.lower[0] = static_cast<float>(i);
    box.upper[0] = static_cast<float>(i + 1);
    boxes.push_back(box);
  }
  const AdjacencyList expected = brute_force(boxes, boxes, true);
  REQUIRE(expected.items.size() == 190 + 29);
  check_every_kind(boxes, expected, boxes, brute_force(boxes, boxes, false));
}

TEST_CASE("broad phase: refitted or rebuilt, the pairs are those of the last update") {
  const std::vector<Box> first = random_boxes(1000, 0.1, 1), shuffled = random_boxes(1000, 0.1, 2);
  std::vector<Box> near = first;
  for (Box& box : near) box.upper[2] += 0.05F;
  const std::vector<Box> fewer(first.begin(), first.begin() + 300);
  for (const BroadPhaseKind kind : kinds) {
    const auto phase = make_broad_phase(kind);
    for (const std::vector<Box>* boxes :
         std::initializer_list<const std::vector<Box>*>{&first, &near, &shuffled, &fewer, &near}) {
      phase->update(*boxes);
      check_same(pairs_of(*phase), brute_force(*boxes, *boxes, true));
    }
  }
}

TEST_CASE("broad phase: the limit on pairs, and kinds that differ") {
  const std::vector<Box> boxes = random_boxes(400, 0.5, 5);
  const long count = static_cast<long>(brute_force(boxes, boxes, true).items.size());
  REQUIRE(count > 500);
  for (const BroadPhaseKind kind : kinds) {
    const auto phase = make_broad_phase(kind);
    phase->update(boxes);
    AdjacencyList pairs;
    CHECK(phase->overlaps(*phase, count, pairs));
    CHECK(static_cast<long>(pairs.items.size()) == count);
    CHECK(!phase->overlaps(*phase, count - 1, pairs));
    const auto other =
        make_broad_phase(kind == BroadPhaseKind::fcl ? BroadPhaseKind::bvh : BroadPhaseKind::fcl);
    CHECK_THROWS_WITH(phase->overlaps(*other, count, pairs), Catch::Contains("two kinds"));
  }
}

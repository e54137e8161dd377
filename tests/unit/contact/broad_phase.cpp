#include "core/numerics/collision_detection/broad_phase.h"

#include <array>
#include <catch2/catch.hpp>

#include "core/numerics/collision_detection/box_tree.h"
#include "tests/support/random.h"

using namespace drape;

namespace {

using Vector = Eigen::Vector3d;
using Boxes = std::vector<Box>;
constexpr long unlimited = 1L << 40;
constexpr BroadPhaseKind broad_phases[] = {BroadPhaseKind::bvh, BroadPhaseKind::fcl};

Boxes random_boxes(int count, double size, unsigned seed) {
  RandomNumbers random(seed);
  Boxes boxes;
  for (int i = 0; i < count; ++i) {
    const Vector low = random.vector(1), extent = random.vector(size / 2).array() + size / 2;
    boxes.push_back(Box::around(low, low + extent, 0));
  }
  return boxes;
}

/// The boxes that overlap; each box of one set only with those after it.
AdjacencyList pairs_by_hand(const Boxes& boxes, const Boxes& others) {
  AdjacencyList rows;
  rows.start = {0};
  for (int i = 0; i < std::ssize(boxes); ++i) {
    for (int j = &boxes == &others ? i + 1 : 0; j < std::ssize(others); ++j)
      if (boxes[i].overlaps(others[j])) rows.items.push_back(j);
    rows.start.push_back(static_cast<int>(rows.items.size()));
  }
  return rows;
}

void check_pairs(const BroadPhase& phase, const BroadPhase& other, const AdjacencyList& expected) {
  AdjacencyList found;
  REQUIRE(phase.overlaps(other, unlimited, found));
  CHECK(found.start == expected.start);
  CHECK(found.items == expected.items);
}

/// Every kind of broad phase finds the pairs of the boxes, and of them and others; returns their numbers.
std::array<long, 2> check_every_kind(const Boxes& boxes, const Boxes& others) {
  const AdjacencyList own = pairs_by_hand(boxes, boxes), with_others = pairs_by_hand(boxes, others);
  for (const BroadPhaseKind kind : broad_phases) {
    const auto phase = make_broad_phase(kind), other = make_broad_phase(kind);
    phase->update(boxes);
    other->update(others);
    check_pairs(*phase, *phase, own);
    check_pairs(*phase, *other, with_others);
  }
  return {std::ssize(own.items), std::ssize(with_others.items)};
}

}  // namespace

TEST_CASE("broad phase: a box bounds its points despite rounding") {
  RandomNumbers random(3);
  for (int i = 0; i < 10000; ++i) {
    const Vector a = random.vector(5), b = a * 1e-3;
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
  Boxes boxes;
  for (int i = 0; i < 100; ++i) boxes.push_back(Box::around(i * p, (i + 1) * p, i % 2 ? 1e39 : 1e300));
  boxes.push_back(Box::around(1e200 * p, 2e200 * p, 0));
  boxes.push_back(Box::around(p, -1e60 * p, 1e-3));
  for (const Box& box : boxes) {
    for (int k = 0; k < 3; ++k) CHECK(std::isfinite(box.upper[k] - box.lower[k]));
    CHECK(std::isfinite(box.half_area()));
  }
  const Boxes others = boxes;
  CHECK(check_every_kind(boxes, others)[0] == 102 * 101 / 2 - 1);  // all but the last two
}

TEST_CASE("broad phase: every kind finds the pairs of a brute-force search") {
  for (const int count : {0, 1, 2, 8, 9, 63, 65, 700, 1500})
    for (const double size : {0.0, 0.1, 0.8}) {
      const auto pairs = check_every_kind(random_boxes(count, size, count), random_boxes(333, size, 77));
      if (count > 600 && size > 0) REQUIRE(std::min(pairs[0], pairs[1]) >= 10);
    }
}

TEST_CASE("broad phase: degenerate, equal and touching boxes") {
  const Vector p(0.25, 0.5, 0.75);
  Boxes boxes(20, Box::around(p, p, 0));  // equal: all pairs
  for (int i = 0; i < 30; ++i) {          // in a row, each shares a face with the next
    Box box;
    for (int k = 0; k < 3; ++k) box.lower[k] = box.upper[k] = 8;
    box.lower[0] = static_cast<float>(i);
    box.upper[0] = static_cast<float>(i + 1);
    boxes.push_back(box);
  }
  const Boxes others = boxes;
  CHECK(check_every_kind(boxes, others)[0] == 190 + 29);
}

TEST_CASE("broad phase: refitted or rebuilt, the pairs are those of the last update") {
  const Boxes first = random_boxes(1000, 0.1, 1), shuffled = random_boxes(1000, 0.1, 2),
              fewer(first.begin(), first.begin() + 300);
  Boxes near = first;
  for (Box& box : near) box.upper[2] += 0.05F;
  for (const BroadPhaseKind kind : broad_phases) {
    const auto phase = make_broad_phase(kind);
    for (const Boxes* boxes : {&first, &std::as_const(near), &shuffled, &fewer, &std::as_const(near)}) {
      phase->update(*boxes);
      check_pairs(*phase, *phase, pairs_by_hand(*boxes, *boxes));
    }
  }
}

TEST_CASE("broad phase: of poses that follow each other each has its own pairs") {
  const Boxes first = random_boxes(1000, 0.1, 1), shuffled = random_boxes(1000, 0.1, 2),
              others = random_boxes(400, 0.1, 3), few = random_boxes(40, 0.1, 4);
  Boxes near = first;
  for (Box& box : near) box.upper[2] += 0.05F;
  for (const BroadPhaseKind kind : broad_phases) {
    const auto cloth = make_broad_phase(kind), small = make_broad_phase(kind);
    cloth->update(others);
    small->update(few);
    PoseTrees trees(kind);
    std::vector<std::shared_ptr<const BroadPhase>> poses;
    const Boxes* boxes[] = {&first, &near, &shuffled, &near};
    for (const Boxes* pose : boxes) poses.push_back(trees.of(*pose));
    for (std::size_t k = 0; k < poses.size(); ++k) {
      check_pairs(*cloth, *poses[k], pairs_by_hand(others, *boxes[k]));
      const AdjacencyList few_pairs = pairs_by_hand(few, *boxes[k]);
      REQUIRE(!few_pairs.items.empty());
      REQUIRE(few_pairs.items.size() < boxes[k]->size() / 4);
      check_pairs(*small, *poses[k], few_pairs);
    }
  }
}

TEST_CASE("broad phase: the limit on pairs, and kinds that differ") {
  const Boxes boxes = random_boxes(400, 0.5, 5);
  const long count = std::ssize(pairs_by_hand(boxes, boxes).items);
  REQUIRE(count > 500);
  for (const BroadPhaseKind kind : broad_phases) {
    const auto phase = make_broad_phase(kind),
               other = make_broad_phase(kind == broad_phases[0] ? broad_phases[1] : broad_phases[0]);
    phase->update(boxes);
    AdjacencyList pairs;
    CHECK(phase->overlaps(*phase, count, pairs));
    CHECK(std::ssize(pairs.items) == count);
    CHECK(!phase->overlaps(*phase, count - 1, pairs));
    CHECK_THROWS_WITH(phase->overlaps(*other, count, pairs), Catch::Contains("two kinds"));
  }
}

TEST_CASE("a tree's search within a run ends when it is told") {
  // A run of 64 boxes that overlap 50,000 has three million pairs.
  BoxTree few, many;
  few.build(Boxes(64, Box::around({0, 0, 0}, {1, 1, 1}, 0)));
  many.build(Boxes(50000, Box::around({0, 0, 0}, {1, 1, 1}, 0)));
  long found = 0;
  few.overlaps(
      many, 0, [&](int, int) { ++found; }, [&] { return found > 1000; });
  CHECK(found > 1000);
  CHECK(found <= 1000 + 64 * 64);
}

#include <algorithm>
#include <cstdlib>

#include "tests/support/any_threads.h"
#include "tests/unit/contact/exact_check.h"

using namespace drape;
using Eigen::Vector3d;

namespace {

using exact_check::Query;
using exact_check::safe;

constexpr int families = 12, straight = 1;

Query random_query(std::mt19937& random, int family) {
  std::uniform_real_distribution<double> unit(0, 1);
  const auto any = [&] { return random_pair(random); };
  const auto size = [&](double least, double most) { return least * std::pow(most / least, unit(random)); };
  Query q;
  q.kind = random() % 2 ? PairKind::point_triangle : PairKind::edge_edge;
  const bool edges = q.kind == PairKind::edge_edge;
  const int first = first_primitive_size(q.kind), second = 4 - first;
  q.x0 = any();
  q.x1 = any();
  const auto touching = [&](double gap) {
    const double s = unit(random), t = unit(random);
    return bring_near(q.kind, q.x0, s, t, gap);
  };
  const auto push = [&](const Vector3d& p) {
    q.x1 = q.x0;
    q.x1.leftCols(first).colwise() += p;
  };
  Vector3d n;
  double gap;
  switch (family) {
    case 0:  // anything
      break;
    case straight:  // through, at a constant speed
      push(-size(1e-3, 10) * touching(size(1e-3, 1)));
      break;
    case 2:  // tiny gaps
      n = touching(1e-9);
      push(size(1e-9, 1e3) * (any().col(0) - n));
      break;
    case 3:  // tiny gaps, all vertices move
      touching(size(1e-9, 1e-3));
      q.x1 = q.x0 + size(1e-9, 10) * any();
      break;
    case 4:  // in one plane
      q.x0.row(2).setConstant(0.5);
      q.x1.row(2).setConstant(0.5);
      break;
    case 5:  // parallel edges, or a triangle's plane moving onto the point
      gap = size(1e-9, 0.1);
      if (edges) {
        const Vector3d u = q.x0.col(1) - q.x0.col(0);
        n = u.unitOrthogonal();
        q.x0.col(2) = q.x0.col(0) + unit(random) * u + gap * n;
        q.x0.col(3) = q.x0.col(2) + (random() % 2 ? 0.7 : -0.7) * u;
        push(size(gap, 100 * gap) * n);
      } else {
        push(-size(gap, 100 * gap) * touching(gap));
      }
      break;
    case 6:  // grazing: past a corner or along a face, closing slowly or not at all
      gap = size(1e-9, 1e-2);
      n = touching(gap);
      push(size(0.1, 100) * n.unitOrthogonal() - gap * (0.9 + 0.2 * unit(random)) * n);
      break;
    case 7:  // huge motions
      q.x1 = size(10, 1e6) * q.x1;
      break;
    case 8:  // far from the origin
      q.x1 = q.x0 + size(1e-6, 1) * any();
      n = 100 * any().col(0);
      q.x0.colwise() += n;
      q.x1.colwise() += n;
      break;
    case 9:  // slivers and nearly parallel edges
      n = edges ? q.x0.col(1) - q.x0.col(0) : q.x0.col(2) - q.x0.col(1);
      q.x0.col(3) = q.x0.col(edges ? 2 : 1) + n + size(1e-12, 1e-2) * q.x0.col(3);
      touching(size(1e-9, 1e-1));
      q.x1 = q.x0 + size(1e-9, 1) * any();
      break;
    case 10:  // sides that turn about each other
      touching(size(1e-6, 1e-1));
      q.x1.leftCols(first) = -q.x0.leftCols(first);
      q.x1.rightCols(second) = q.x0.rightCols(second) + size(1e-6, 1) * any().rightCols(second);
      break;
    default:  // towards a common point: vertex on vertex, edge on vertex
      q.x1.col(random() % first) = q.x1.col(3);
  }
  if (random() % 4 == 0) q.min_gap_fraction = random() % 2 ? 0.5 : 0;
  if (random() % 4 == 0) q.offset = unit(random) * std::max(q.gap(0), 0.0);
  return q;
}

/// The time of impact from below, to nine digits; 1 without an impact.
double impact(Query q) {
  q.min_gap_fraction = 0;
  const PairPositions x0 = q.x0;
  double time = 0;
  for (int i = 0; i < 100 && time < 1; ++i) {
    q.x0 = x0 + time * (q.x1 - x0);
    const double part = q.time() * (1 - time);
    time += part;
    if (part <= 1e-10 * time) break;
  }
  return time;
}

/// A point over a triangle that lies in the plane z = 0.
Query point_over_triangle(double height, const Vector3d& motion, double offset = 0, double kept = 0.1) {
  const PairPositions x0 = pair_at({0.2, 0.3, height}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  Query q{PairKind::point_triangle, x0, x0, offset, kept};
  q.x1.col(0) += motion;
  return q;
}

}  // namespace

TEST_CASE("no motion leads to an intersection, by exact arithmetic, and few end long before their impact") {
  const char* wanted = std::getenv("DRAPE_CCD_QUERIES");  // a million take about a minute
  const int count = wanted ? std::atoi(wanted) : 120000;
  std::mt19937 random(1);
  int ended[families] = {};   // before their motion's end, by family
  int unsafe = 0, early = 0;  // early: with more of the gap left than `min_gap_fraction` and the slack
  std::vector<double> parts;  // of the time to the impact
  for (int i = 0; i < count; ++i) {
    const Query q = random_query(random, i % families);
    const double t = q.time();
    if (!(t >= 0 && t <= 1) || (t > 0 && !safe(q, t))) ++unsafe;
    if (t == 1) continue;
    ++ended[i % families];
    const double rounding = 1e-14 * std::max(q.x0.cwiseAbs().maxCoeff(), q.x1.cwiseAbs().maxCoeff());
    if (q.gap(t) > (q.min_gap_fraction + 0.02) * q.gap(0) + rounding) ++early;
    if (t == 0 || q.min_gap_fraction != 0.1 || i >= 16000) continue;
    const double end = impact(q);
    if (end == 1) continue;
    parts.push_back(t / end);
    if (i % families == straight) CHECK((parts.back() >= 0.88 - 1e-9 && parts.back() <= 0.9 + 1e-9));
  }
  CHECK(unsafe == 0);
  CHECK(early < count / 1000);
  for (const int of_family : ended) CHECK(of_family > count / families / 100);
  REQUIRE(parts.size() > 3000);
  std::sort(parts.begin(), parts.end());
  CHECK(parts.back() <= 1);
  CHECK(parts[parts.size() / 2] > 0.88);
  CHECK(parts[parts.size() / 100] > 0.5);
}

TEST_CASE("the exact check detects intersections") {
  const Query q = point_over_triangle(0.5, {0, 0, -1}), rounded = point_over_triangle(0.5, {0, 0, -1}, 0.25);
  CHECK(safe(q, 0.49));
  CHECK_FALSE(safe(q, 0.5));
  CHECK_FALSE(safe(q, 0.51));
  CHECK(safe(rounded, 0.249));
  CHECK_FALSE(safe(rounded, 0.251));
}

TEST_CASE("fractions that are known in closed form") {
  const Vector3d down(0, 0, -1), aside(3, 4, 0), along(0.2, 0, -2e-3);
  CHECK(point_over_triangle(0.5, down).time() == Approx(0.45).epsilon(0.03));
  CHECK(point_over_triangle(0.5, down, 0.3).time() == Approx(0.18).epsilon(0.03));
  const double half = point_over_triangle(0.5, down, 0, 0.5).time();
  CHECK(half == Approx(0.25).epsilon(0.05));
  CHECK(half <= 0.25);
  CHECK(point_over_triangle(0, -down).time() == 0);  // touching
  for (const double part : {0.449, 0.0}) CHECK(point_over_triangle(0.5, part * down).time() == 1);
  for (const double height : {0.5, 1e-9}) CHECK(point_over_triangle(height, aside).time() == 1);
  CHECK(point_over_triangle(1e-9, -5 * down).time() == 1);
  // Along a triangle a motion is free, however much of the gap is to be kept.
  for (const double kept : {0.1, 0.9, 0.98, 0.99})
    CHECK(point_over_triangle(0.5, along, 0, kept).time() == 1);
  Query together = point_over_triangle(1e-6, {0, 0, 0});  // a common translation: no gap changes
  together.x1.colwise() += Vector3d(1, -2, 1000);
  CHECK(together.time() == 1);
}

TEST_CASE("the first of many pairs limits the motion, with any number of threads") {
  const int points = 5000;
  Positions obstacle(3, 3), x0(points, 3), x1(points, 3);
  obstacle << -100, -100, 0, 100, -100, 0, 0, 100, 0;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.5, 1);
  std::vector<ContactPair> pairs;
  SafeFraction first;
  for (int i = 0; i < points; ++i) {
    x0.row(i) << unit(random), unit(random), unit(random);
    x1.row(i) = x0.row(i) - Eigen::RowVector3d(unit(random), 0, unit(random));
    pairs.push_back({{i, points, points + 1, points + 2}});
    pairs.back().offset = i % 3 ? 0 : 0.1;
  }
  for (int i = 0; i < points; ++i) {
    const double t = additive_ccd(x0, x1, obstacle, {pairs[i]}, 0.1).fraction;
    if (t < first.fraction) first = {t, i};
  }
  REQUIRE(first.blocking >= 0);
  REQUIRE(first.fraction > 0);
  CHECK((same_with_any_threads([&] { return additive_ccd(x0, x1, obstacle, pairs, 0.1); }) == first));
  CHECK((additive_ccd(x0, x1, obstacle, {}, 0.1) == SafeFraction()));
  // Every gap keeps a tenth, and the blocking one no more than the tolerance above that.
  const Positions x = x0 + first.fraction * (x1 - x0);
  for (int i = 0; i < points; ++i) {
    const double part = (x(i, 2) - pairs[i].offset) / (x0(i, 2) - pairs[i].offset);
    if (part < 0.1 || (i == first.blocking && part > 0.12 + 1e-9))
      FAIL_CHECK("pair " << i << " keeps " << part);
  }
}

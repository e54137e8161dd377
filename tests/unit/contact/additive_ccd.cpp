#include <CGAL/Gmpq.h>
#include <CGAL/Interval_nt.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <random>

#include "core/numerics/contact/pair_contacts.h"
#include "core/numerics/contact/pair_geometry.h"
#include "tests/support/any_threads.h"

using namespace drape;
using Eigen::Vector3d;

// The check is exact. Vertices move on straight lines, so for a fixed direction n every n·(a(τ) - b(τ)) is
// linear in τ: where all of them, a of one side and b of the other, are positive at both ends of an interval,
// n separates the two sides throughout it. The signs are computed with intervals and, where those do not
// decide, rationals; n may be any, so how it is found does not matter. An interval without such an n is
// halved.

namespace {

struct Query {
  PairKind kind = PairKind::point_triangle;
  PairPositions x0, x1;
  double offset = 0, min_gap_fraction = 0.1;

  double time() const {
    ContactPair pair;
    pair.vertices = {0, 1, 2, 3};
    pair.kind = kind;
    pair.offset = offset;
    const SafeFraction safe =
        additive_ccd(x0.transpose(), x1.transpose(), Positions(0, 3), {pair}, min_gap_fraction);
    CHECK(safe.blocking == (safe.fraction == 1 ? -1 : 0));
    return safe.fraction;
  }
  PairPositions at(double t) const { return x0 + t * (x1 - x0); }
  double gap(double t) const { return gap_of(at(t)); }
  double gap_of(const PairPositions& x) const { return connection(x, closest(kind, x)).norm() - offset; }
};

bool positive(const CGAL::Interval_nt<>& value) { return value.inf() > 0; }
bool positive(const CGAL::Gmpq& value) { return CGAL::sign(value) == CGAL::POSITIVE; }

template <class Number>
using Triple = std::array<Number, 3>;

template <class Number>
Number dot(const Triple<Number>& a, const Triple<Number>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

template <class Number>
Triple<Number> position(const Query& q, int k, double tau) {
  Triple<Number> x;
  for (int c = 0; c < 3; ++c) {
    const Number from(q.x0(c, k)), to(q.x1(c, k));
    x[c] = from + Number(tau) * (to - from);
  }
  return x;
}

/// Whether n·(a(τ) - b(τ)) > offset |n| for all a and b.
template <class Number>
bool separates(const Query& q, const Triple<Number>& n, double tau) {
  Number along[4];
  for (int k = 0; k < 4; ++k) along[k] = dot(n, position<Number>(q, k, tau));
  const int first = first_primitive_size(q.kind);
  for (int a = 0; a < first; ++a)
    for (int b = first; b < 4; ++b) {
      const Number apart = along[a] - along[b], offset(q.offset);
      if (!positive(apart) || !positive(apart * apart - offset * offset * dot(n, n))) return false;
    }
  return true;
}

/// Σ c_k x_k, made exactly orthogonal to the free directions: where a gap is made of the last digits, doubles
/// do not give a direction that separates.
Triple<CGAL::Gmpq> exact_direction(const Query& q, const Closest& closest, double tau) {
  using Number = CGAL::Gmpq;
  Triple<Number> x[4], n, along[2];
  for (int k = 0; k < 4; ++k) x[k] = position<Number>(q, k, tau);
  for (int c = 0; c < 3; ++c) {
    n[c] = 0;
    for (int k = 1; k < 4; ++k) n[c] += Number(closest.c[k]) * (x[k][c] - x[0][c]);
  }
  const auto remove = [](Triple<Number>& from, const Triple<Number>& a) {
    const Number part = dot(from, a) / dot(a, a);
    for (int c = 0; c < 3; ++c) from[c] -= part * a[c];
  };
  for (int m = 0; m < closest.free; ++m) {
    for (int c = 0; c < 3; ++c) {
      along[m][c] = 0;
      for (int k = 0; k < 4; ++k) along[m][c] += Number(closest.direction(k, m)) * x[k][c];
    }
    if (m == 1) remove(along[1], along[0]);
    remove(n, along[m]);
  }
  return n;
}

bool apart_between(const Query& q, double begin, double end, int depth) {
  const double middle = begin + (end - begin) / 2;
  const PairPositions x = q.at(middle);
  const Closest nearest = closest(q.kind, x);
  const auto by = [&](const auto& n) { return separates(q, n, begin) && separates(q, n, end); };
  const Vector3d n = separating_direction(x, nearest);
  if (by(Triple<CGAL::Interval_nt<>>{n[0], n[1], n[2]})) return true;
  if (depth % 8 == 0 && by(exact_direction(q, nearest, middle))) return true;
  if (depth == 0) {
    // Of such gaps even the nearest features are a guess.
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (int i = 1; i <= 300; ++i) {
      const Vector3d m = n + 0.001 * i * Vector3d(normal(random), normal(random), normal(random));
      if (by(Triple<CGAL::Gmpq>{m[0], m[1], m[2]})) return true;
    }
  }
  return depth > 0 && apart_between(q, begin, middle, depth - 1) && apart_between(q, middle, end, depth - 1);
}

/// The motion up to t, and the state that rounding makes of its end.
bool safe(const Query& q, double t) {
  Query end = q;
  end.x0 = end.x1 = q.at(t);
  return apart_between(q, 0, t, 63) && apart_between(end, 0, 0, 0);
}

constexpr int families = 12;

Query random_query(std::mt19937& random, int family) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0, 1);
  const auto any = [&] { return PairPositions(PairPositions::NullaryExpr([&] { return normal(random); })); };
  const auto size = [&](double least, double most) { return least * std::pow(most / least, unit(random)); };
  Query q;
  q.kind = random() % 2 ? PairKind::point_triangle : PairKind::edge_edge;
  const bool edges = q.kind == PairKind::edge_edge;
  const int first = first_primitive_size(q.kind), second = 4 - first;
  q.x0 = any();
  q.x1 = any();
  // A pair that nearly touches in its middle, and the direction from the second side to the first.
  const auto touching = [&](double gap) {
    const double s = unit(random), t = unit(random);
    Vector3d n;
    if (edges) {
      const Vector3d u = q.x0.col(1) - q.x0.col(0), v = q.x0.col(3) - q.x0.col(2);
      n = u.cross(v).normalized();
      q.x0.col(2) = q.x0.col(0) + s * u - t * v - gap * n;
      q.x0.col(3) = q.x0.col(2) + v;
    } else {
      const Vector3d e1 = q.x0.col(2) - q.x0.col(1), e2 = q.x0.col(3) - q.x0.col(1);
      n = e1.cross(e2).normalized();
      q.x0.col(0) = q.x0.col(1) + s * (1 - t) * e1 + s * t * e2 + gap * n;
    }
    return n;
  };
  const auto push = [&](const Vector3d& p) {
    q.x1 = q.x0;
    q.x1.leftCols(first).colwise() += p;
  };
  switch (family) {
    case 0:  // anything
      break;
    case 1:  // straight through
      push(-size(1e-3, 10) * touching(size(1e-3, 1)));
      break;
    case 2: {  // tiny gaps
      const Vector3d n = touching(1e-9);
      push(size(1e-9, 1e3) * (any().col(0) - n));
      break;
    }
    case 3: {  // tiny gaps, all vertices move
      touching(size(1e-9, 1e-3));
      q.x1 = q.x0 + size(1e-9, 10) * any();
      break;
    }
    case 4:  // in one plane
      q.x0.row(2).setConstant(0.5);
      q.x1.row(2).setConstant(0.5);
      break;
    case 5: {  // parallel edges, or a triangle's plane moving onto the point
      const double gap = size(1e-9, 0.1);
      const Vector3d u = q.x0.col(1) - q.x0.col(0), n = u.unitOrthogonal();
      if (edges) {
        q.x0.col(2) = q.x0.col(0) + unit(random) * u + gap * n;
        q.x0.col(3) = q.x0.col(2) + (random() % 2 ? 0.7 : -0.7) * u;
        push(size(gap, 100 * gap) * n);
      } else {
        push(-size(gap, 100 * gap) * touching(gap));
      }
      break;
    }
    case 6: {  // grazing: past a corner or along a face, closing slowly or not at all
      const double gap = size(1e-9, 1e-2);
      const Vector3d n = touching(gap);
      push(size(0.1, 100) * n.unitOrthogonal() - gap * (0.9 + 0.2 * unit(random)) * n);
      break;
    }
    case 7:  // huge motions
      q.x1 = size(10, 1e6) * q.x1;
      break;
    case 8: {  // far from the origin
      q.x1 = q.x0 + size(1e-6, 1) * any();
      const Vector3d far = 100 * any().col(0);
      q.x0.colwise() += far;
      q.x1.colwise() += far;
      break;
    }
    case 9: {  // slivers and nearly parallel edges
      const double thin = size(1e-12, 1e-2);
      q.x0.col(3) = q.x0.col(edges ? 2 : 1) +
                    (edges ? q.x0.col(1) - q.x0.col(0) : q.x0.col(2) - q.x0.col(1)) + thin * q.x0.col(3);
      touching(size(1e-9, 1e-1));
      q.x1 = q.x0 + size(1e-9, 1) * any();
      break;
    }
    case 10: {  // sides that turn about each other
      touching(size(1e-6, 1e-1));
      q.x1.leftCols(first) = -q.x0.leftCols(first);
      q.x1.rightCols(second) = q.x0.rightCols(second) + size(1e-6, 1) * any().rightCols(second);
      break;
    }
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
Query point_over_triangle(double height, const Vector3d& motion) {
  Query q;
  q.x0 << 0.2, 0, 1, 0, 0.3, 0, 0, 1, height, 0, 0, 0;
  q.x1 = q.x0;
  q.x1.col(0) += motion;
  return q;
}

}  // namespace

TEST_CASE("no motion leads to an intersection, by exact arithmetic") {
  const char* wanted = std::getenv("DRAPE_CCD_QUERIES");  // a million take about a minute
  const int count = wanted ? std::atoi(wanted) : 120000;
  std::mt19937 random(1);
  int ended[families] = {};   // before their motion's end, by family
  int unsafe = 0, early = 0;  // early: with more of the gap left than `min_gap_fraction` and the slack
  for (int i = 0; i < count; ++i) {
    const Query q = random_query(random, i % families);
    const double t = q.time();
    if (!(t >= 0 && t <= 1) || (t > 0 && !safe(q, t))) ++unsafe;
    if (t == 1) continue;
    ++ended[i % families];
    const double rounding = 1e-14 * std::max(q.x0.cwiseAbs().maxCoeff(), q.x1.cwiseAbs().maxCoeff());
    if (q.gap(t) > (q.min_gap_fraction + 0.02) * q.gap(0) + rounding) ++early;
  }
  CHECK(unsafe == 0);
  CHECK(early < count / 1000);
  for (const int of_family : ended) CHECK(of_family > count / families / 100);
}

TEST_CASE("the exact check detects intersections") {
  const Query q = point_over_triangle(0.5, {0, 0, -1});
  CHECK(safe(q, 0.49));
  CHECK_FALSE(safe(q, 0.5));
  CHECK_FALSE(safe(q, 0.51));
  Query rounded = q;
  rounded.offset = 0.25;
  CHECK(safe(rounded, 0.249));
  CHECK_FALSE(safe(rounded, 0.251));
}

TEST_CASE("how close to the impact the step ends") {
  std::mt19937 random(2);
  std::vector<double> all;
  int straight = 0;
  for (int i = 0; i < 12000; ++i) {
    Query q = random_query(random, i % families);
    q.min_gap_fraction = 0.1;
    const double t = q.time();
    if (t == 0 || t == 1) continue;
    const double end = impact(q);
    if (end == 1) continue;
    all.push_back(t / end);
    if (i % families != 1) continue;  // these close at a constant speed
    ++straight;
    CHECK(t / end >= 0.88 - 1e-9);
    CHECK(t / end <= 0.9 + 1e-9);
  }
  CHECK(straight > 300);
  REQUIRE(all.size() > 3000);
  std::sort(all.begin(), all.end());
  CHECK(all.back() <= 1);
  CHECK(all[all.size() / 2] > 0.88);
  CHECK(all[all.size() / 100] > 0.5);
}

TEST_CASE("fractions that are known in closed form") {
  CHECK(point_over_triangle(0.5, {0, 0, -1}).time() == Approx(0.45).epsilon(0.03));
  CHECK(point_over_triangle(0.5, {0, 0, -0.449}).time() == 1);
  CHECK(point_over_triangle(0.5, {0, 0, 0}).time() == 1);
  CHECK(point_over_triangle(0.5, {3, 4, 0}).time() == 1);
  CHECK(point_over_triangle(1e-9, {3, 4, 0}).time() == 1);
  CHECK(point_over_triangle(1e-9, {0, 0, 5}).time() == 1);
  CHECK(point_over_triangle(0, {0, 0, 1}).time() == 0);  // touching
  Query rounded = point_over_triangle(0.5, {0, 0, -1});
  rounded.offset = 0.3;
  CHECK(rounded.time() == Approx(0.18).epsilon(0.03));
  Query half = point_over_triangle(0.5, {0, 0, -1});
  half.min_gap_fraction = 0.5;
  CHECK(half.time() == Approx(0.25).epsilon(0.05));
  CHECK(half.time() <= 0.25);
  // A common translation: no gap changes.
  Query together = point_over_triangle(1e-6, {0, 0, 0});
  together.x1.colwise() += Vector3d(1, -2, 1000);
  CHECK(together.time() == 1);
}

TEST_CASE("A motion along a triangle is free, however much of the gap is to be kept") {
  for (const double kept : {0.1, 0.9, 0.98, 0.99}) {
    CAPTURE(kept);
    Query q = point_over_triangle(0.5, {0.2, 0, -2e-3});
    q.min_gap_fraction = kept;
    CHECK(q.time() == 1);
  }
}

TEST_CASE("the first of many pairs limits the motion, with any number of threads") {
  const int points = 5000;
  Positions obstacle(3, 3), x0(points, 3), x1(points, 3);
  obstacle << -100, -100, 0, 100, -100, 0, 0, 100, 0;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.5, 1);
  std::vector<ContactPair> pairs;
  for (int i = 0; i < points; ++i) {
    x0.row(i) << unit(random), unit(random), unit(random);
    x1.row(i) = x0.row(i) - Eigen::RowVector3d(unit(random), 0, unit(random));
    ContactPair pair;
    pair.vertices = {i, points, points + 1, points + 2};
    pair.offset = i % 3 ? 0 : 0.1;
    pairs.push_back(pair);
  }
  SafeFraction first;
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

#pragma once

#include <CGAL/Gmpq.h>
#include <CGAL/Interval_nt.h>
#include <CGAL/Simple_cartesian.h>

#include "tests/unit/contact/pairs.h"

// The check is exact. Vertices move on straight lines, so for a fixed direction n every n·(a(τ) - b(τ)) is
// linear in τ: where all of them, a of one side and b of the other, are positive at both ends of an interval,
// n separates the two sides throughout it. The signs are computed with intervals and, where those do not
// decide, rationals; n may be any, so how it is found does not matter. An interval without such an n is
// halved.

namespace exact_check {

using namespace drape;
using Eigen::Vector3d;

struct Query {
  PairKind kind = PairKind::point_triangle;
  PairPositions x0, x1;
  double offset = 0, min_gap_fraction = 0.1;

  double time() const {
    ContactPair pair{{0, 1, 2, 3}, kind};
    pair.offset = offset;
    const SafeFraction safe =
        additive_ccd(x0.transpose(), x1.transpose(), Positions(0, 3), {pair}, min_gap_fraction);
    CHECK(safe.blocking == (safe.fraction == 1 ? -1 : 0));
    return safe.fraction;
  }
  PairPositions at(double t) const { return x0 + t * (x1 - x0); }
  double gap(double t) const { return connection(at(t), closest(kind, at(t))).norm() - offset; }
};

using Rounded = CGAL::Simple_cartesian<CGAL::Interval_nt<>>;
using Exact = CGAL::Simple_cartesian<CGAL::Gmpq>;

template <class Kernel>
CGAL::Vector_3<Kernel> vector_of(const Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

template <class Kernel>
CGAL::Vector_3<Kernel> position(const Query& q, int k, double tau) {
  const auto from = vector_of<Kernel>(q.x0.col(k)), to = vector_of<Kernel>(q.x1.col(k));
  return from + typename Kernel::FT(tau) * (to - from);
}

/// Whether n·(a(τ) - b(τ)) > offset |n| for all a and b, and certainly so.
template <class Kernel>
bool separates(const Query& q, const CGAL::Vector_3<Kernel>& n, double tau) {
  typename Kernel::FT along[4];
  const typename Kernel::FT offset(q.offset);
  for (int k = 0; k < 4; ++k) along[k] = n * position<Kernel>(q, k, tau);
  const int first = first_primitive_size(q.kind);
  for (int a = 0; a < first; ++a)
    for (int b = first; b < 4; ++b) {
      const typename Kernel::FT apart = along[a] - along[b];
      const bool is_apart = CGAL::certainly(apart > 0) &&
                            CGAL::certainly(apart * apart - offset * offset * n.squared_length() > 0);
      if (!is_apart) return false;
    }
  return true;
}

/// Σ c_k x_k, made exactly orthogonal to the free directions: where a gap is made of the last digits, doubles
/// do not give a direction that separates.
inline Exact::Vector_3 exact_direction(const Query& q, const Closest& closest, double tau) {
  using Vector = Exact::Vector_3;
  Vector r = CGAL::NULL_VECTOR, along[2] = {r, r};
  for (int k = 1; k < 4; ++k) {
    const Vector x = position<Exact>(q, k, tau) - position<Exact>(q, 0, tau);
    r = r + Exact::FT(closest.c[k]) * x;
    for (int m = 0; m < closest.free; ++m) along[m] = along[m] + Exact::FT(closest.direction(k, m)) * x;
  }
  if (closest.free == 0) return r;
  if (closest.free == 1) return r - Exact::FT((r * along[0]) / along[0].squared_length()) * along[0];
  const Vector n = CGAL::cross_product(along[0], along[1]);
  return n * r < 0 ? -n : n;
}

inline bool apart_between(const Query& q, double begin, double end, int depth) {
  const double middle = begin + (end - begin) / 2;
  const PairPositions x = q.at(middle);
  const Closest nearest = closest(q.kind, x);
  const auto by = [&](const auto& n) { return separates(q, n, begin) && separates(q, n, end); };
  const Vector3d n = separating_direction(x, nearest);
  if (by(vector_of<Rounded>(n))) return true;
  if (depth % 8 == 0 && by(exact_direction(q, nearest, middle))) return true;
  if (depth == 0) {
    // Of such gaps even the nearest features are a guess.
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    for (int i = 1; i <= 300; ++i)
      if (by(vector_of<Exact>(n + 0.001 * i * Vector3d(normal(random), normal(random), normal(random)))))
        return true;
  }
  return depth > 0 && apart_between(q, begin, middle, depth - 1) && apart_between(q, middle, end, depth - 1);
}

/// The motion up to t, and the state that rounding makes of its end.
inline bool safe(const Query& q, double t) {
  Query end = q;
  end.x0 = end.x1 = q.at(t);
  return apart_between(q, 0, t, 63) && apart_between(end, 0, 0, 0);
}

}  // namespace exact_check

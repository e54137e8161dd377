#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

#include "core/numerics/contact/pair_geometry.h"
#include "core/numerics/linear_algebra/pack.h"

namespace drape {

/// The vertices of up to W pairs, to be gathered and tested together.
template <int W>
struct PairLanes {
  const double *begin[4][W], *end[4][W];  ///< where each vertex begins and ends its motion [m]
  int size = 0;

  void add(const std::array<int, 4>& vertices, const LinearMotion& motion) {
    const auto n = static_cast<int>(motion.x0.rows());
    for (int k = 0; k < 4; ++k) {
      const int v = vertices[k];
      begin[k][size] = v < n ? motion.x0.data() + 3L * v : motion.obstacles0.data() + 3L * (v - n);
      end[k][size] = v < n ? motion.x1.data() + 3L * v : motion.obstacles1.data() + 3L * (v - n);
    }
    ++size;
  }
  bool full() const { return size == W; }
  /// Lets lanes that are not in use repeat the first.
  void pad() {
    for (int k = 0; k < 4; ++k) {
      std::fill(begin[k] + size, begin[k] + W, begin[k][0]);
      std::fill(end[k] + size, end[k] + W, end[k][0]);
    }
  }
};

/// Bounds on the distances of W pairs, point_triangle or edge_edge, and on their linear motion, by SIMD. They
/// decide on most pairs; the others take the exact functions, whose results they imply.
template <PairKind kind, int W>
class MovingPairs {
 public:
  using T = Pack<W>;

  T separation;  ///< a lower bound of the distance at x0: the width of a slab that separates the pair [m]
  T distance;    ///< the distance at x0, not below it but for round-off [m]
  T size;        ///< of the pair [m]
  T speed;       ///< an upper bound of the rate at which the distance shrinks [m per whole motion]

  __attribute__((flatten)) explicit MovingPairs(const PairLanes<W>& pairs) {
    Vector x[4], p[4], mean = Vector::Zero();
    for (int k = 0; k < 4; ++k) {
      gather(pairs.begin[k], x[k]);
      gather(pairs.end[k], p[k]);
      p[k] -= x[k];
      mean += p[k];
    }
    mean *= T(0.25);
    T largest[2] = {0.0, 0.0}, square = 0.0;
    for (int k = 0; k < 4; ++k) {
      T& of_primitive = largest[k >= first_end];
      of_primitive = max(of_primitive, (p[k] - mean).squaredNorm());
      if (k == 0) continue;
      x[k] -= x[0];
      square = max(square, x[k].squaredNorm());
    }
    speed = sqrt(largest[0]) + sqrt(largest[1]);
    size = sqrt(square);
    // Every direction gives a valid slab, that of the shortest connection the widest.
    const Vector r = kind == PairKind::edge_edge ? between_edges(x) : to_triangle(x);
    distance = r.norm();
    T low = 0.0, high = r.dot(x[first_end]);  // of the first primitive and of the second, along r
    for (int k = 1; k < first_end; ++k) low = min(low, r.dot(x[k]));
    for (int k = first_end + 1; k < 4; ++k) high = max(high, r.dot(x[k]));
    separation = select(distance > 0.0, (low - high) / distance, 0.0) - rounding * size;
  }

  /// Lanes that are certainly farther apart than `reach` [m], and those that certainly are not.
  PackMask<W> beyond(T reach) const { return separation > reach * (1 + margin); }
  PackMask<W> within(T reach) const { return distance + rounding * size < reach * (1 - margin); }

 private:
  using Vector = Eigen::Matrix<T, 3, 1>;
  static constexpr int first_end = kind == PairKind::edge_edge ? 2 : 1;
  // Far above the round-off of the exact functions and of these.
  static constexpr double rounding = 1e-12, margin = 1e-9;

  static void gather(const double* const (&rows)[W], Vector& v) {
    double lanes[3][W];
    for (int i = 0; i < W; ++i)
      for (int c = 0; c < 3; ++c) lanes[c][i] = rows[i][c];
    for (int c = 0; c < 3; ++c) std::memcpy(&v[c].v, lanes[c], sizeof v[c].v);
  }
  static T quotient(T a, T b) { return a / select(b > 0.0, b, 1.0); }
  static T clamped(T a) { return min(max(a, T(0.0)), T(1.0)); }
  static T nearest_on_segment(const Vector& u, const Vector& p) {
    return clamped(quotient(p.dot(u), u.squaredNorm()));
  }

  // x[1], x[2] and x[3] are relative to vertex 0.

  static Vector between_edges(const Vector* x) {
    const Vector u = x[1], v = x[3] - x[2], w = x[2], n = u.cross(v);
    T s = clamped(quotient(w.cross(v).dot(n), n.squaredNorm()));
    const T t = nearest_on_segment(v, s * u - w);
    s = select((t == 0.0) | (t == 1.0), nearest_on_segment(u, t * v + w), s);
    return s * u - w - t * v;
  }

  static Vector to_triangle(const Vector* x) {
    const Vector e1 = x[2] - x[1], e2 = x[3] - x[1], from = -x[1], n = e1.cross(e2);
    const T square = n.squaredNorm(), b1 = quotient(from.cross(e2).dot(n), square),
            b2 = quotient(e1.cross(from).dot(n), square);
    const auto inside = (b1 > 0.0) & (b2 > 0.0) & (b1 + b2 < 1.0);
    Vector r = quotient(from.dot(n), square) * n;
    T smallest = select(inside, 0.0, T(std::numeric_limits<double>::infinity()));
    for (int k = 1; k < 4; ++k) {
      const Vector edge = x[k % 3 + 1] - x[k], beside = -x[k] - nearest_on_segment(edge, -x[k]) * edge;
      const T other = beside.squaredNorm();
      const auto nearer = other < smallest;
      smallest = select(nearer, other, smallest);
      for (int c = 0; c < 3; ++c) r[c] = select(nearer, beside[c], r[c]);
    }
    return r;
  }
};

/// Calls visit(moving, indices, size) for packs of the pairs of one kind that have no offset.
template <PairKind kind, class Pair, class Visit>
void for_each_pack_of(const Pair* pairs, int count, const LinearMotion& motion, const Visit& visit) {
  PairLanes<native_pack_width> lanes;
  int indices[native_pack_width];
  const auto test = [&] {
    if (lanes.size == 0) return;
    lanes.pad();
    visit(MovingPairs<kind, native_pack_width>(lanes), indices, lanes.size);
    lanes.size = 0;
  };
  for (int i = 0; i < count; ++i) {
    if (pairs[i].kind != kind || pairs[i].offset != 0) continue;
    indices[lanes.size] = i;
    lanes.add(pairs[i].vertices, motion);
    if (lanes.full()) test();
  }
  test();
}

/// Calls visit(moving, indices, size) for packs of those pairs that have no offset, each of one kind, whose
/// indices the pack's first `size` lanes have.
template <class Pair, class Visit>
void for_each_pack(const Pair* pairs, int count, const LinearMotion& motion, const Visit& visit) {
  for_each_pack_of<PairKind::point_triangle>(pairs, count, motion, visit);
  for_each_pack_of<PairKind::edge_edge>(pairs, count, motion, visit);
}

}  // namespace drape

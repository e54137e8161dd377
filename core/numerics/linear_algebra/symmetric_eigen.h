#pragma once

#include <cmath>
#include <utility>

#include "core/numerics/linear_algebra/pack.h"

namespace drape {

/// A symmetric N×N matrix of double or Pack (one matrix in each lane), stored as its upper triangle.
template <int N, class T>
struct SymmetricMatrix {
  T upper[N * (N + 1) / 2];  ///< column by column

  SymmetricMatrix() = default;
  /// From the upper triangle of anything with entries (i, j).
  template <class Matrix>
  explicit SymmetricMatrix(const Matrix& m) {
    for (int j = 0; j < N; ++j)
      for (int i = 0; i <= j; ++i) (*this)(i, j) = m(i, j);
  }

  static constexpr int index(int i, int j) { return i <= j ? j * (j + 1) / 2 + i : i * (i + 1) / 2 + j; }
  T& operator()(int i, int j) { return upper[index(i, j)]; }
  const T& operator()(int i, int j) const { return upper[index(i, j)]; }
};

namespace eigen_detail {

/// All pairs p < q in rounds of disjoint pairs (a round-robin tournament), whose rotations are independent.
/// For odd N index r has no partner in round r.
template <int N>
struct Rounds {
  static constexpr int pairs = N / 2, rounds = N - 1 + N % 2;
  int pair[rounds][pairs][2] = {};

  constexpr Rounds() {
    for (int r = 0; r < rounds; ++r) {
      int count = 0;
      if (N % 2 == 0) set(r, count++, r, N - 1);
      for (int k = 1; count < pairs; ++k) set(r, count++, (r + k) % rounds, (r - k + rounds) % rounds);
    }
  }
  constexpr void set(int round, int k, int p, int q) {
    pair[round][k][0] = p < q ? p : q;
    pair[round][k][1] = p < q ? q : p;
  }
};
template <int N>
inline constexpr Rounds<N> rounds_of{};

/// Cosine and sine of a plane rotation [c s; -s c].
template <class T>
struct Rotation {
  T c, s;
};

/// (p, q) becomes (c p - s q, s p + c q).
template <class T>
inline void turn(Rotation<T> r, T& p, T& q) {
  const T old = p;
  p = r.c * old - r.s * q;
  q = r.s * old + r.c * q;
}

/// Rotation of at most π/4 that reduces the off-diagonal entry of the 2×2 block (app, apq; apq, aqq) to about
/// 1e-8 of apq; the next sweep removes the rest. Square roots and divisions to full precision would dominate
/// the cost. The rotation itself is orthonormal to round-off.
template <class T>
inline Rotation<T> diagonalising(const T& app, const T& apq, const T& aqq) {
  using std::abs, std::max;
  constexpr double tiny = 1e-300;
  const T d = aqq - app, b = 2.0 * apq, square = d * d + b * b;
  T root = reciprocal_sqrt(max(square, T(tiny)));
  root = root * (1.5 - 0.5 * square * root * root);
  const T h = abs(d) + square * root;  // tan = ± b / h
  root = reciprocal_sqrt(max(h * h + b * b, T(tiny)));
  const T c = select(square > tiny, h * root, T(1.0)), s = select(d < 0.0, -b, b) * root;
  const T short_of = 1.0 - (c * c + s * s);
  const T scale = 1.0 + short_of * (0.5 + short_of * (0.375 + short_of * 0.3125));
  return {c * scale, s * scale};
}

/// Jᵀ A J of a pair's own 2×2 block.
template <class T>
inline void turn_block(Rotation<T> r, T& app, T& apq, T& aqq) {
  const T difference = app - aqq, change = r.s * (r.s * difference + 2.0 * r.c * apq);  // c² = 1 - s²
  apq = r.c * (r.s * difference + r.c * apq) - r.s * r.s * apq;
  app -= change;
  aqq += change;
}

/// Jᵀ A J without the pairs' own 2×2 blocks, J the round's rotations. Unrolled: every index into A is a
/// constant.
template <int Round, int N, class T>
inline void rotate_others(SymmetricMatrix<N, T>& a, const Rotation<T>* rotations) {
  constexpr auto& all = rounds_of<N>;
#pragma GCC unroll 8
  for (int i = 0; i < all.pairs; ++i) {
    const int p = all.pair[Round][i][0], q = all.pair[Round][i][1];
    const Rotation<T> r = rotations[i];
    if (N % 2 == 1) turn(r, a(p, Round), a(q, Round));
#pragma GCC unroll 8
    for (int j = 0; j < i; ++j) {
      const int u = all.pair[Round][j][0], v = all.pair[Round][j][1];
      T pu = a(p, u), pv = a(p, v), qu = a(q, u), qv = a(q, v);
      turn(r, pu, qu);
      turn(r, pv, qv);
      turn(rotations[j], pu, pv);
      turn(rotations[j], qu, qv);
      a(p, u) = pu, a(p, v) = pv, a(q, u) = qu, a(q, v) = qv;
    }
  }
}

template <int Round, int N, class T>
inline void find_and_rotate(SymmetricMatrix<N, T>& a, Rotation<T>* rotations) {
  constexpr auto& all = rounds_of<N>;
#pragma GCC unroll 8
  for (int i = 0; i < all.pairs; ++i) {
    const int p = all.pair[Round][i][0], q = all.pair[Round][i][1];
    rotations[i] = diagonalising(a(p, p), a(p, q), a(q, q));
    turn_block(rotations[i], a(p, p), a(p, q), a(q, q));
  }
  rotate_others<Round>(a, rotations);
}

template <int Round, int N, class T>
inline void rotate_back(SymmetricMatrix<N, T>& a, const Rotation<T>* rotations) {
  constexpr auto& all = rounds_of<N>;
  Rotation<T> inverse[all.pairs];
#pragma GCC unroll 8
  for (int i = 0; i < all.pairs; ++i) {
    inverse[i] = {rotations[i].c, -rotations[i].s};
    const int p = all.pair[Round][i][0], q = all.pair[Round][i][1];
    turn_block(inverse[i], a(p, p), a(p, q), a(q, q));
  }
  rotate_others<Round>(a, inverse);
}

template <int... Round, int N, class T>
void sweep(SymmetricMatrix<N, T>& a, Rotation<T> (*rotations)[N / 2], std::integer_sequence<int, Round...>) {
  (find_and_rotate<Round>(a, rotations[Round]), ...);
}

template <int... Round, int N, class T>
void sweep_back(SymmetricMatrix<N, T>& a, const Rotation<T> (*rotations)[N / 2],
                std::integer_sequence<int, Round...>) {
  (rotate_back<sizeof...(Round) - 1 - Round>(a, rotations[sizeof...(Round) - 1 - Round]), ...);
}

}  // namespace eigen_detail

/// Replaces A = V Λ Vᵀ by V f(Λ) Vᵀ. Cyclic Jacobi rotations, all lanes in step, reduce the off-diagonal part
/// to 1e-13 of the norm; then the same rotations run backwards.
template <int N, class T, class Function>
void map_eigenvalues(SymmetricMatrix<N, T>& a, Function f) {
  using namespace eigen_detail;
  constexpr int max_sweeps = 10, rounds = rounds_of<N>.rounds;
  constexpr auto sequence = std::make_integer_sequence<int, rounds>();
  Rotation<T> rotations[max_sweeps][rounds][N / 2];
  int done = 0;
  for (; done < max_sweeps; ++done) {
    T off = 0.0, diagonal = 0.0;
    for (int j = 0; j < N; ++j) {
      for (int i = 0; i < j; ++i) off += a(i, j) * a(i, j);
      diagonal += a(j, j) * a(j, j);
    }
    if (!any(off > 1e-26 * (diagonal + off))) break;
    sweep(a, rotations[done], sequence);
  }
  for (int j = 0; j < N; ++j) {
    for (int i = 0; i < j; ++i) a(i, j) = 0.0;
    a(j, j) = f(a(j, j));
  }
  while (done-- > 0) sweep_back(a, rotations[done], sequence);
}

/// True only if every lane's smallest eigenvalue is above -1e-13 of its trace (by LDLᵀ).
template <int N, class T>
bool positive_semidefinite(SymmetricMatrix<N, T> a) {
  T trace = 0.0;
  for (int j = 0; j < N; ++j) trace += a(j, j);
  for (int j = 0; j < N; ++j) {
    const T pivot = a(j, j) + 1e-13 * trace;
    if (any(!(pivot > 0.0))) return false;
    const T inverse = 1.0 / pivot;
    for (int k = j + 1; k < N; ++k) {
      const T factor = a(j, k) * inverse;
      for (int i = j + 1; i <= k; ++i) a(i, k) -= factor * a(j, i);
    }
  }
  return true;
}

}  // namespace drape

#pragma once

#include <algorithm>
#include <cmath>

#include "core/model/energy.h"
#include "core/numerics/symmetric_eigen.h"

namespace drape {
namespace projection_detail {

/// The reflection I - β v vᵀ that turns y = (I + w 1 1ᵀ) x into the last axis.
template <int Size, class T>
struct Reflection {
  T v[Size], beta;

  Reflection(const T* x, double w) {
    using std::abs, std::sqrt;
    T square = 0.0;
    for (int i = 0; i < Size; ++i) {
      T sum = x[i % 3];
      for (int j = 3 + i % 3; j < Size; j += 3) sum += x[j];
      v[i] = x[i] + w * sum;
      square += v[i] * v[i];
    }
    const T length = sqrt(square), last = v[Size - 1];
    v[Size - 1] += select(last < 0.0, -length, length);
    beta = 1.0 / (square + length * abs(last));
  }

  void apply(SymmetricMatrix<Size, T>& a) const {
    T w[Size], vw = 0.0;
    for (int i = 0; i < Size; ++i) {
      w[i] = 0.0;
      for (int j = 0; j < Size; ++j) w[i] += a(i, j) * v[j];
      w[i] *= beta;
      vw += v[i] * w[i];
    }
    vw *= 0.5 * beta;
    for (int i = 0; i < Size; ++i) w[i] -= vw * v[i];
    for (int j = 0; j < Size; ++j)
      for (int i = 0; i <= j; ++i) a(i, j) -= v[i] * w[j] + w[i] * v[j];
  }
};

/// (I + w 1 1ᵀ) h (I + w 1 1ᵀ), where 1 1ᵀ adds up 3×3 blocks.
template <int Size, class T>
void mix_blocks(SymmetricMatrix<Size, T>& h, double w) {
  constexpr int N = Size / 3;
  T sums[N][3][3], total[3][3];  // of each column of blocks, of all
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) {
      total[r][c] = 0.0;
      for (int j = 0; j < N; ++j) {
        sums[j][r][c] = h(r, 3 * j + c);
        for (int i = 1; i < N; ++i) sums[j][r][c] += h(3 * i + r, 3 * j + c);
        total[r][c] += sums[j][r][c];
      }
    }
  for (int j = 0; j < Size; ++j)
    for (int i = 0; i <= j; ++i)
      h(i, j) += w * (sums[j / 3][i % 3][j % 3] + sums[i / 3][j % 3][i % 3]) + w * w * total[i % 3][j % 3];
}

template <int Size, class T>
void project_eigenvalues(SymmetricMatrix<Size, T>& a, Projection projection) {
  map_eigenvalues(a, [projection](T eigenvalue) { return projection.map(eigenvalue); });
}

/// Has body(back) project h as it is in an orthonormal basis without translations, unless h is known to be
/// positive. With E the matrix of the differences x_i - x_0, the full Hessian is Eᵀ h E, and E = S Qᵀ with
/// orthonormal Q (which holds no translation) and S = √(E Eᵀ) = √(I + 1 1ᵀ): the matrix to project is S h S.
/// S⁻¹ = I + back 1 1ᵀ.
template <int Size, class T, class Body>
void in_vertex_metric(SymmetricMatrix<Size, T>& h, const Body& body) {
  constexpr int N = Size / 3;
  const double shift = (std::sqrt(N + 1.0) - 1) / N, back = -shift / std::sqrt(N + 1.0);
  const SymmetricMatrix<Size, T> unprojected = h;
  mix_blocks(h, shift);
  if (positive_semidefinite(h)) {
    h = unprojected;
    return;
  }
  body(back);
  mix_blocks(h, back);
}

}  // namespace projection_detail

/// Projects the Hessian of a translation-invariant element of N + 1 vertices, given by its derivatives by the
/// N differences from vertex 0: the same as projecting the full (3N + 3)² matrix.
template <int Size, class T>
void project_hessian(SymmetricMatrix<Size, T>& h, Projection projection) {
  using namespace projection_detail;
  if (projection.is_exact()) return;
  in_vertex_metric(h, [&](double) { project_eigenvalues(h, projection); });
}

/// The same with a column `null` that h takes to zero. It saves a dimension, a third of the work for N = 3.
template <int Size, class T>
void project_hessian(SymmetricMatrix<Size, T>& h, Projection projection, const T* null) {
  using namespace projection_detail;
  if (projection.is_exact()) return;
  in_vertex_metric(h, [&](double back) {
    const Reflection<Size, T> reflection(null, back);
    reflection.apply(h);
    SymmetricMatrix<Size - 1, T> rest;  // what is left are the first columns
    std::copy_n(h.upper, Size * (Size - 1) / 2, rest.upper);
    project_eigenvalues(rest, projection);
    std::copy_n(rest.upper, Size * (Size - 1) / 2, h.upper);
    for (int i = 0; i < Size; ++i) h(i, Size - 1) = 0.0;
    reflection.apply(h);
  });
}

}  // namespace drape

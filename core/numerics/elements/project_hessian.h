#pragma once

#include <cmath>

#include "core/kernel/interfaces/energy.h"
#include "core/numerics/linear_algebra/symmetric_eigen.h"

namespace drape {
namespace projection_detail {

/// h becomes (I + w 1 1ᵀ) h (I + w 1 1ᵀ), where 1 1ᵀ sums 3×3 blocks.
template <int Size, class T>
void mix_blocks(SymmetricMatrix<Size, T>& h, double w) {
  constexpr int N = Size / 3;
  T sums[N][3][3], total[3][3];  // of each block column, and of all
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

}  // namespace projection_detail

/// Projects one of the independent symmetric parts of a Hessian: an Eigen matrix, upper triangle.
template <class Part>
void project_part(Part& part, Projection projection) {
  constexpr int n = Part::RowsAtCompileTime;
  if (projection.is_exact()) return;
  SymmetricMatrix<n, typename Part::Scalar> m(part);
  if (positive_semidefinite(m)) return;
  projection_detail::project_eigenvalues(m, projection);
  for (int j = 0; j < n; ++j)
    for (int i = 0; i <= j; ++i) part(i, j) = m(i, j);
}

/// Projects the Hessian of a translation-invariant element of N + 1 vertices, given as the second derivatives
/// h by the N differences from vertex 0. The result equals that of projecting the full (3N + 3)² matrix.
///
/// Let E map positions to the differences x_i - x_0. The full Hessian is Eᵀ h E, and E = S Qᵀ with
/// orthonormal Q, which is orthogonal to translations, and S = √(E Eᵀ) = √(I + 1 1ᵀ). So the matrix to
/// project is S h S.
template <int Size, class T>
void project_hessian(SymmetricMatrix<Size, T>& h, Projection projection) {
  using namespace projection_detail;
  if (projection.is_exact()) return;
  constexpr int N = Size / 3;
  const double shift = (std::sqrt(N + 1.0) - 1) / N,
               back = -shift / std::sqrt(N + 1.0);  // S, S⁻¹ = I + … 1 1ᵀ
  const SymmetricMatrix<Size, T> unprojected = h;
  mix_blocks(h, shift);
  if (positive_semidefinite(h)) {
    h = unprojected;
    return;
  }
  project_eigenvalues(h, projection);
  mix_blocks(h, back);
}

}  // namespace drape

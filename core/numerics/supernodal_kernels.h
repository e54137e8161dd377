#pragma once

#include <cstddef>

#include "core/numerics/pack.h"

namespace drape {

// Dense kernels under the supernodal factorisation. A matrix is kept in strips of rows, each column by
// column, so that every product reads its operands front to back without packing them first. A strip has as
// many rows as the register tile of the product: 3 vectors, which is also a whole number of vertices with 3
// unknowns.

inline constexpr int lanes = native_pack_width;
inline constexpr int strip_rows = 3 * lanes;

/// Rounds up to whole vectors.
inline int padded(int rows) { return (rows + lanes - 1) / lanes * lanes; }

/// At most strip_rows rows of a matrix, a multiple of `lanes`: entry (r, c) is data[c height + r], and data
/// is aligned to a vector.
struct Strip {
  double* data;
  int height;

  double* column(int c) const { return data + static_cast<std::ptrdiff_t>(c) * height; }
};

/// c −= a bᵀ, over the columns [begin, end) of a and b; c is a strip of a.height rows and b.height columns.
void subtract_product(const Strip& a, const Strip& b, int begin, int end, double* c);

/// Left-looking Cholesky of `lanes` columns in strip a, which lies below the columns' own rows: subtracts the
/// product of the columns [begin, column) and solves with the factorised diagonal block, which is at row
/// `row` of strip `diagonal`.
void factorise_columns_below(const Strip& a, const Strip& diagonal, int row, int begin, int column);

/// The same for the strip with the columns' own rows. The diagonal keeps reciprocals; what is above it is
/// undefined. False when a pivot is not positive.
bool factorise_columns_diagonal(const Strip& diagonal, int row, int begin, int column);

/// y −= a x over the columns [0, columns) of a.
void subtract_times(const Strip& a, int columns, const double* x, double* y);

/// y −= aᵀ x for the `lanes` columns of a from `column` on.
void subtract_transposed_times(const Strip& a, int column, const double* x, double* y);

/// Solves in place with the lower triangle at l (columns `height` apart, reciprocals on the diagonal), of
/// `size` rows, or with its transpose.
void solve_lower(const double* l, int height, int size, double* x);
void solve_lower_transposed(const double* l, int height, int size, double* x);

}  // namespace drape

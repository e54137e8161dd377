#pragma once

#include <cstddef>

#include "core/kernel/linear_algebra/pack.h"

namespace drape {

// Dense kernels of the supernodal factorisation. A matrix is stored in row panels, each column-major, so
// products read their operands contiguously without packing. A row panel is as high as the register tile of
// the product: 3 SIMD vectors, which is also a whole number of vertices with 3 unknowns.

inline constexpr int lanes = native_pack_width;
inline constexpr int row_panel_height = 3 * lanes;

/// Rounds up to whole SIMD vectors.
inline int padded(int rows) { return (rows + lanes - 1) / lanes * lanes; }

/// At most row_panel_height rows of a matrix, a multiple of `lanes`: entry (r, c) is data[c height + r], and
/// data is aligned to a vector.
struct RowPanel {
  double* data;
  int height;

  double* column(int c) const { return data + static_cast<std::ptrdiff_t>(c) * height; }
};

/// c −= a bᵀ, over the columns [begin, end) of a and b; c is a row panel of a.height rows and b.height
/// columns.
void subtract_product(const RowPanel& a, const RowPanel& b, int begin, int end, double* c);

/// Left-looking Cholesky of `lanes` columns in row panel a, below their diagonal block: subtracts the product
/// of the columns [begin, column) and solves with the factorised diagonal block, which is at row `row` of
/// `diagonal`.
void factorise_columns_below(const RowPanel& a, const RowPanel& diagonal, int row, int begin, int column);

/// The same for the row panel with the diagonal block. The diagonal receives reciprocals; entries above it
/// are undefined. Returns false if a pivot is not positive.
bool factorise_columns_diagonal(const RowPanel& diagonal, int row, int begin, int column);

/// y −= a x over the columns [0, columns) of a.
void subtract_times(const RowPanel& a, int columns, const double* x, double* y);

/// y −= aᵀ x for the `lanes` columns of a from `column` on.
void subtract_transposed_times(const RowPanel& a, int column, const double* x, double* y);

/// Solves in place with the lower triangle at l (columns `height` apart, reciprocals on the diagonal), of
/// `size` rows, or with its transpose.
void solve_lower(const double* l, int height, int size, double* x);
void solve_lower_transposed(const double* l, int height, int size, double* x);

}  // namespace drape

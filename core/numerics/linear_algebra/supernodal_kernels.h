#pragma once

#include <cstddef>
#include <type_traits>

#include "core/kernel/threads/flush_denormals.h"
#include "core/kernel/threads/parallel.h"
#include "core/numerics/linear_algebra/pack.h"

namespace drape {

// Dense kernels of the supernodal factorisation, for Scalar double and float. A matrix is stored in row
// panels, each column-major, so products read their operands contiguously without packing. A row panel is as
// high as the register tile of the product: 3 SIMD vectors, which is also a whole number of vertices with 3
// unknowns.

/// Numbers in a SIMD vector; vertices in a row panel.
template <class Scalar>
inline constexpr int lanes = native_pack_width* static_cast<int>(sizeof(double) / sizeof(Scalar));
template <class Scalar>
inline constexpr int row_panel_height = 3 * lanes<Scalar>;
/// Columns of the register tile. Registers bound them, so they are as many for float as for double.
inline constexpr int tile_columns = native_pack_width;

/// A SIMD vector of `lanes` scalars.
template <class Scalar>
using SimdVector = std::conditional_t<std::is_same_v<Scalar, float>, VectorOf<native_pack_width>::Floats,
                                      VectorOf<native_pack_width>::Doubles>;

/// Rounds up to whole SIMD vectors.
template <class Scalar>
int padded(int rows) {
  return (rows + lanes<Scalar> - 1) / lanes<Scalar> * lanes<Scalar>;
}

/// The processor's mode in which kernels run: for float, denormal numbers are zero.
template <class Scalar>
struct KernelMode {};
template <>
struct KernelMode<float> : FlushDenormals {};

/// parallel_for of a body that calls kernels, each thread in their mode.
template <class Scalar, class Body>
void parallel_kernels(int size, int grain, const Body& body) {
  parallel_for(size, grain, [&](int begin, int end) {
    [[maybe_unused]] const KernelMode<Scalar> mode;
    body(begin, end);
  });
}

/// At most row_panel_height rows of a matrix, a multiple of `lanes`: entry (r, c) is data[c height + r], and
/// data is aligned to a vector.
template <class Scalar>
struct RowPanel {
  Scalar* data;
  int height;

  Scalar* column(int c) const { return data + static_cast<std::ptrdiff_t>(c) * height; }
};

/// c −= a bᵀ, over the columns [begin, end) of a and b; c is a row panel of a.height rows and b.height
/// columns.
template <class Scalar>
void subtract_product(const RowPanel<Scalar>& a, const RowPanel<Scalar>& b, int begin, int end, Scalar* c);

/// Left-looking Cholesky of `tile_columns` columns in row panel a, below their diagonal block: subtracts the
/// product of the columns [begin, column) and solves with the factorised diagonal block, which is at row
/// `row` of `diagonal`.
template <class Scalar>
void factorise_columns_below(const RowPanel<Scalar>& a, const RowPanel<Scalar>& diagonal, int row, int begin,
                             int column);

/// Left-looking Cholesky of these columns in the row panel with their diagonal block. The diagonal receives
/// reciprocals; entries above it are undefined. Returns false if a pivot is not positive.
template <class Scalar>
bool factorise_columns_diagonal(const RowPanel<Scalar>& diagonal, int row, int begin, int column);

/// y −= a x over the columns [0, columns) of a.
template <class Scalar>
void subtract_times(const RowPanel<Scalar>& a, int columns, const Scalar* x, Scalar* y);

/// y −= aᵀ x for the `lanes` columns from `column` on of a, a matrix of `rows` × `columns` in row panels that
/// follow each other.
template <class Scalar>
void subtract_transposed_times(const Scalar* a, int rows, int columns, int column, const Scalar* x,
                               Scalar* y);

/// Solves in place with the lower triangle of a from `column` on, which has reciprocals on its diagonal, or
/// with its transpose. The columns from the `size`-th on are those of the unit matrix.
template <class Scalar>
void solve_lower(const RowPanel<Scalar>& a, int column, int size, Scalar* x);
template <class Scalar>
void solve_lower_transposed(const RowPanel<Scalar>& a, int column, int size, Scalar* x);

}  // namespace drape

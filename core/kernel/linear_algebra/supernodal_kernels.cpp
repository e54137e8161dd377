#include "core/kernel/linear_algebra/supernodal_kernels.h"

#include <cmath>

namespace drape {
namespace {

using Vector = VectorOf<lanes>::Doubles;

/// Keeps v in a register. For AVX2, GCC 12 would load a vector that several products share again for each of
/// them; at two loads a cycle that takes longer than the products.
[[gnu::always_inline]] inline Vector in_register(Vector v) {
#ifdef __AVX__
  asm("" : "+v"(v));
#endif
  return v;
}

/// `lanes` columns of V vectors each: fills the registers that the operands leave.
template <int V>
struct Tile {
  Vector columns[lanes][V];

  [[gnu::always_inline]] void load(const double* c) {
    const auto* from = reinterpret_cast<const Vector*>(c);
#pragma GCC unroll 8
    for (int j = 0; j < lanes; ++j)
#pragma GCC unroll 3
      for (int v = 0; v < V; ++v) columns[j][v] = from[j * V + v];
  }
  [[gnu::always_inline]] void store(double* c) const {
    auto* to = reinterpret_cast<Vector*>(c);
#pragma GCC unroll 8
    for (int j = 0; j < lanes; ++j)
#pragma GCC unroll 3
      for (int v = 0; v < V; ++v) to[j * V + v] = columns[j][v];
  }
  /// Subtracts a bᵀ over `depth` columns of a row panel of V vectors and of `lanes` rows at b.
  [[gnu::always_inline]] void subtract(const double* a, const double* b, int b_height, int depth) {
    for (int k = 0; k < depth; ++k, a += V * lanes, b += b_height) {
      Vector rows[V];
#pragma GCC unroll 3
      for (int v = 0; v < V; ++v) rows[v] = in_register(reinterpret_cast<const Vector*>(a)[v]);
#pragma GCC unroll 8
      for (int j = 0; j < lanes; ++j)
#pragma GCC unroll 3
        for (int v = 0; v < V; ++v) columns[j][v] -= rows[v] * b[j];
    }
  }
  /// Multiplies by the inverse transpose of the lower triangle at l, with reciprocals on its diagonal.
  [[gnu::always_inline]] void solve(const double* l, int height) {
#pragma GCC unroll 8
    for (int k = 0; k < lanes; ++k) {
#pragma GCC unroll 3
      for (int v = 0; v < V; ++v) columns[k][v] *= l[k * height + k];
#pragma GCC unroll 8
      for (int j = k + 1; j < lanes; ++j)
#pragma GCC unroll 3
        for (int v = 0; v < V; ++v) columns[j][v] -= columns[k][v] * l[k * height + j];
    }
  }
};

template <int V>
void subtract_product_of(const RowPanel& a, const RowPanel& b, int begin, int end, double* c) {
  for (int row = 0; row < b.height; row += lanes, c += lanes * V * lanes) {
    Tile<V> tile;
    tile.load(c);
    tile.subtract(a.column(begin), b.column(begin) + row, b.height, end - begin);
    tile.store(c);
  }
}

template <int V>
void columns_below(const RowPanel& a, const RowPanel& diagonal, int row, int begin, int column) {
  Tile<V> tile;
  tile.load(a.column(column));
  tile.subtract(a.column(begin), diagonal.column(begin) + row, diagonal.height, column - begin);
  tile.solve(diagonal.column(column) + row, diagonal.height);
  tile.store(a.column(column));
}

/// Unblocked Cholesky of the lower triangle of the block at l.
bool factorise_block(double* l, int height) {
  for (int k = 0; k < lanes; ++k) {
    double* column = l + k * height;
    if (!(column[k] > 0)) return false;
    const double reciprocal = 1 / std::sqrt(column[k]);
    column[k] = reciprocal;
    for (int i = k + 1; i < lanes; ++i) column[i] *= reciprocal;
    for (int j = k + 1; j < lanes; ++j)
      for (int i = j; i < lanes; ++i) l[j * height + i] -= column[i] * column[j];
  }
  return true;
}

template <int V>
bool diagonal_columns(const RowPanel& diagonal, int row, int begin, int column) {
  Tile<V> tile;
  tile.load(diagonal.column(column));
  tile.subtract(diagonal.column(begin), diagonal.column(begin) + row, V * lanes, column - begin);
  alignas(64) double block[lanes * lanes];
  tile.store(diagonal.column(column));
  for (int c = 0; c < lanes; ++c)
    for (int r = 0; r < lanes; ++r) block[c * lanes + r] = diagonal.column(column + c)[row + r];
  if (!factorise_block(block, lanes)) return false;
  tile.solve(block, lanes);
  tile.store(diagonal.column(column));
  for (int c = 0; c < lanes; ++c)
    for (int r = c; r < lanes; ++r) diagonal.column(column + c)[row + r] = block[c * lanes + r];
  return true;
}

template <int V>
void subtract_times_of(const RowPanel& a, int columns, const double* x, double* y) {
  auto* rows = reinterpret_cast<Vector*>(y);
  const auto* column = reinterpret_cast<const Vector*>(a.data);
  Vector sum[V];
  for (int v = 0; v < V; ++v) sum[v] = rows[v];
  for (int c = 0; c < columns; ++c, column += V)
    for (int v = 0; v < V; ++v) sum[v] -= column[v] * x[c];
  for (int v = 0; v < V; ++v) rows[v] = sum[v];
}

template <int V>
void subtract_transposed_times_of(const double* a, const double* x, double* y) {
  const auto* column = reinterpret_cast<const Vector*>(a);
  const auto* rows = reinterpret_cast<const Vector*>(x);
  for (int c = 0; c < lanes; ++c, column += V) {
    Vector products = column[0] * rows[0];
    for (int v = 1; v < V; ++v) products += column[v] * rows[v];
    double sum = 0;
    for (int l = 0; l < lanes; ++l) sum += products[l];
    y[c] -= sum;
  }
}

}  // namespace

void subtract_product(const RowPanel& a, const RowPanel& b, int begin, int end, double* c) {
  if (a.height == 3 * lanes)
    subtract_product_of<3>(a, b, begin, end, c);
  else if (a.height == 2 * lanes)
    subtract_product_of<2>(a, b, begin, end, c);
  else
    subtract_product_of<1>(a, b, begin, end, c);
}

void factorise_columns_below(const RowPanel& a, const RowPanel& diagonal, int row, int begin, int column) {
  if (a.height == 3 * lanes)
    columns_below<3>(a, diagonal, row, begin, column);
  else if (a.height == 2 * lanes)
    columns_below<2>(a, diagonal, row, begin, column);
  else
    columns_below<1>(a, diagonal, row, begin, column);
}

bool factorise_columns_diagonal(const RowPanel& diagonal, int row, int begin, int column) {
  if (diagonal.height == 3 * lanes) return diagonal_columns<3>(diagonal, row, begin, column);
  if (diagonal.height == 2 * lanes) return diagonal_columns<2>(diagonal, row, begin, column);
  return diagonal_columns<1>(diagonal, row, begin, column);
}

void subtract_times(const RowPanel& a, int columns, const double* x, double* y) {
  if (a.height == 3 * lanes)
    subtract_times_of<3>(a, columns, x, y);
  else if (a.height == 2 * lanes)
    subtract_times_of<2>(a, columns, x, y);
  else
    subtract_times_of<1>(a, columns, x, y);
}

void subtract_transposed_times(const RowPanel& a, int column, const double* x, double* y) {
  if (a.height == 3 * lanes)
    subtract_transposed_times_of<3>(a.column(column), x, y);
  else if (a.height == 2 * lanes)
    subtract_transposed_times_of<2>(a.column(column), x, y);
  else
    subtract_transposed_times_of<1>(a.column(column), x, y);
}

void solve_lower(const double* l, int height, int size, double* x) {
  for (int c = 0; c < size; ++c, l += height) {
    x[c] *= l[c];
    for (int r = c + 1; r < size; ++r) x[r] -= l[r] * x[c];
  }
}

void solve_lower_transposed(const double* l, int height, int size, double* x) {
  for (int c = size - 1; c >= 0; --c) {
    const double* column = l + c * height;
    for (int r = c + 1; r < size; ++r) x[c] -= column[r] * x[r];
    x[c] *= column[c];
  }
}

}  // namespace drape

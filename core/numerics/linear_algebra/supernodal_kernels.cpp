#include "core/numerics/linear_algebra/supernodal_kernels.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace drape {
namespace {

/// Keeps v in a register. For AVX2, GCC 12 would load a vector that several products share again for each of
/// them; at two loads a cycle that takes longer than the products.
template <class Vector>
[[gnu::always_inline]] inline Vector in_register(Vector v) {
#ifdef __AVX__
  asm("" : "+v"(v));
#endif
  return v;
}

/// `tile_columns` columns of V vectors each: fills the registers that the operands leave.
template <class Scalar, int V>
struct Tile {
  static constexpr int lanes = drape::lanes<Scalar>;
  using Vector = SimdVector<Scalar>;
  Vector columns[tile_columns][V];

  [[gnu::always_inline]] void load(const Scalar* c) {
    const auto* from = reinterpret_cast<const Vector*>(c);
#pragma GCC unroll 8
    for (int j = 0; j < tile_columns; ++j)
#pragma GCC unroll 3
      for (int v = 0; v < V; ++v) columns[j][v] = from[j * V + v];
  }
  [[gnu::always_inline]] void store(Scalar* c) const {
    auto* to = reinterpret_cast<Vector*>(c);
#pragma GCC unroll 8
    for (int j = 0; j < tile_columns; ++j)
#pragma GCC unroll 3
      for (int v = 0; v < V; ++v) to[j * V + v] = columns[j][v];
  }
  /// Subtracts a bᵀ over `depth` columns of a row panel of V vectors and of `tile_columns` rows at b.
  [[gnu::always_inline]] void subtract(const Scalar* a, const Scalar* b, int b_height, int depth) {
    for (int k = 0; k < depth; ++k, a += V * lanes, b += b_height) {
      Vector rows[V];
#pragma GCC unroll 3
      for (int v = 0; v < V; ++v) rows[v] = in_register(reinterpret_cast<const Vector*>(a)[v]);
#pragma GCC unroll 8
      for (int j = 0; j < tile_columns; ++j)
#pragma GCC unroll 3
        for (int v = 0; v < V; ++v) columns[j][v] -= rows[v] * b[j];
    }
  }
  /// Multiplies by the inverse transpose of the lower triangle at l, with reciprocals on its diagonal.
  [[gnu::always_inline]] void solve(const Scalar* l, int height) {
#pragma GCC unroll 8
    for (int k = 0; k < tile_columns; ++k) {
#pragma GCC unroll 3
      for (int v = 0; v < V; ++v) columns[k][v] *= l[k * height + k];
#pragma GCC unroll 8
      for (int j = k + 1; j < tile_columns; ++j)
#pragma GCC unroll 3
        for (int v = 0; v < V; ++v) columns[j][v] -= columns[k][v] * l[k * height + j];
    }
  }
};

/// Calls body<V>() for the V vectors of the row panel's height.
template <class Scalar, class Body>
[[gnu::always_inline]] inline auto with_vectors(const RowPanel<Scalar>& a, const Body& body) {
  if (a.height == 3 * lanes<Scalar>) return body.template operator()<3>();
  if (a.height == 2 * lanes<Scalar>) return body.template operator()<2>();
  return body.template operator()<1>();
}

/// Unblocked Cholesky of the lower triangle of the block at l.
template <class Scalar>
bool factorise_block(Scalar* l, int height) {
  for (int k = 0; k < tile_columns; ++k) {
    Scalar* column = l + k * height;
    if (!(column[k] > 0)) return false;
    const Scalar reciprocal = 1 / std::sqrt(column[k]);
    column[k] = reciprocal;
    for (int i = k + 1; i < tile_columns; ++i) column[i] *= reciprocal;
    for (int j = k + 1; j < tile_columns; ++j)
      for (int i = j; i < tile_columns; ++i) l[j * height + i] -= column[i] * column[j];
  }
  return true;
}

/// The sum of N scalars, a power of two, added by halves.
template <int N, class Scalar>
[[gnu::always_inline]] inline Scalar sum_of(const Scalar* from) {
  if constexpr (N == 1) {
    return *from;
  } else {
    typedef Scalar Half __attribute__((vector_size(N / 2 * sizeof(Scalar))));
    Half halves[2];
    std::memcpy(halves, from, sizeof halves);
    halves[0] += halves[1];
    return sum_of<N / 2>(reinterpret_cast<const Scalar*>(halves));
  }
}
template <class Scalar>
[[gnu::always_inline]] inline Scalar sum_of(const SimdVector<Scalar>& v) {
  return sum_of<lanes<Scalar>>(reinterpret_cast<const Scalar*>(&v));
}

/// products[c] += entries of column c of a row panel of V vectors times x.
template <int V, class Scalar>
[[gnu::always_inline]] inline void add_products(const Scalar* a, const Scalar* x,
                                                SimdVector<Scalar> (&products)[lanes<Scalar>]) {
  const auto* column = reinterpret_cast<const SimdVector<Scalar>*>(a);
  const auto* rows = reinterpret_cast<const SimdVector<Scalar>*>(x);
#pragma GCC unroll 16
  for (int c = 0; c < lanes<Scalar>; ++c)
#pragma GCC unroll 3
    for (int v = 0; v < V; ++v) products[c] += column[c * V + v] * rows[v];
}

}  // namespace

template <class Scalar>
void subtract_product(const RowPanel<Scalar>& a, const RowPanel<Scalar>& b, int begin, int end, Scalar* c) {
  with_vectors(a, [&]<int V>() {
    for (int row = 0; row < b.height; row += tile_columns, c += tile_columns * V * lanes<Scalar>) {
      Tile<Scalar, V> tile;
      tile.load(c);
      tile.subtract(a.column(begin), b.column(begin) + row, b.height, end - begin);
      tile.store(c);
    }
  });
}

template <class Scalar>
void factorise_columns_below(const RowPanel<Scalar>& a, const RowPanel<Scalar>& diagonal, int row, int begin,
                             int column) {
  with_vectors(a, [&]<int V>() {
    Tile<Scalar, V> tile;
    tile.load(a.column(column));
    tile.subtract(a.column(begin), diagonal.column(begin) + row, diagonal.height, column - begin);
    tile.solve(diagonal.column(column) + row, diagonal.height);
    tile.store(a.column(column));
  });
}

template <class Scalar>
bool factorise_columns_diagonal(const RowPanel<Scalar>& diagonal, int row, int begin, int column) {
  return with_vectors(diagonal, [&]<int V>() {
    Tile<Scalar, V> tile;
    tile.load(diagonal.column(column));
    tile.subtract(diagonal.column(begin), diagonal.column(begin) + row, V * lanes<Scalar>, column - begin);
    alignas(64) Scalar block[tile_columns * tile_columns];
    tile.store(diagonal.column(column));
    for (int c = 0; c < tile_columns; ++c)
      for (int r = 0; r < tile_columns; ++r)
        block[c * tile_columns + r] = diagonal.column(column + c)[row + r];
    if (!factorise_block(block, tile_columns)) return false;
    tile.solve(block, tile_columns);
    tile.store(diagonal.column(column));
    for (int c = 0; c < tile_columns; ++c)
      for (int r = c; r < tile_columns; ++r)
        diagonal.column(column + c)[row + r] = block[c * tile_columns + r];
    return true;
  });
}

template <class Scalar>
void subtract_times(const RowPanel<Scalar>& a, int columns, const Scalar* x, Scalar* y) {
  with_vectors(a, [&]<int V>() {
    auto* rows = reinterpret_cast<SimdVector<Scalar>*>(y);
    const auto* column = reinterpret_cast<const SimdVector<Scalar>*>(a.data);
    SimdVector<Scalar> sum[V];
    for (int v = 0; v < V; ++v) sum[v] = rows[v];
    for (int c = 0; c < columns; ++c, column += V)
      for (int v = 0; v < V; ++v) sum[v] -= column[v] * x[c];
    for (int v = 0; v < V; ++v) rows[v] = sum[v];
  });
}

template <class Scalar>
void subtract_transposed_times(const Scalar* a, int rows, int columns, int column, const Scalar* x,
                               Scalar* y) {
  if (rows == 0) return;
  constexpr int height = row_panel_height<Scalar>;
  SimdVector<Scalar> products[lanes<Scalar>] = {};
  int row = 0;
  for (; row + height <= rows; row += height, a += height * static_cast<std::ptrdiff_t>(columns))
    add_products<3>(a + column * height, x + row, products);
  if (rows - row == 2 * lanes<Scalar>) add_products<2>(a + column * (rows - row), x + row, products);
  if (rows - row == lanes<Scalar>) add_products<1>(a + column * (rows - row), x + row, products);
  for (int c = 0; c < lanes<Scalar>; ++c) y[c] -= sum_of<Scalar>(products[c]);
}

template <class Scalar>
void solve_lower(const RowPanel<Scalar>& a, int column, int size, Scalar* x) {
  for (int begin = 0; begin < size; begin += lanes<Scalar>) {
    const int below = begin + lanes<Scalar>, end = std::min(below, size);
    for (int c = begin; c < end; ++c) {
      const Scalar* l = a.column(column + c);
      x[c] *= l[c];
      for (int r = c + 1; r < end; ++r) x[r] -= l[r] * x[c];
    }
    for (int row = below; row < a.height; row += lanes<Scalar>) {
      auto& rows = *reinterpret_cast<SimdVector<Scalar>*>(x + row);
      for (int c = begin; c < end; ++c)
        rows -= *reinterpret_cast<const SimdVector<Scalar>*>(a.column(column + c) + row) * x[c];
    }
  }
}

template <class Scalar>
void solve_lower_transposed(const RowPanel<Scalar>& a, int column, int size, Scalar* x) {
  for (int begin = (size - 1) / lanes<Scalar> * lanes<Scalar>; begin >= 0; begin -= lanes<Scalar>) {
    const int below = begin + lanes<Scalar>, end = std::min(below, size);
    if (below < size)
      for (int c = begin; c < end; ++c) {
        SimdVector<Scalar> products = {};
        for (int row = below; row < a.height; row += lanes<Scalar>)
          products += *reinterpret_cast<const SimdVector<Scalar>*>(a.column(column + c) + row) *
                      *reinterpret_cast<const SimdVector<Scalar>*>(x + row);
        x[c] -= sum_of<Scalar>(products);
      }
    for (int c = end - 1; c >= begin; --c) {
      x[c] *= a.column(column + c)[c];
      for (int r = begin; r < c; ++r) x[r] -= a.column(column + r)[c] * x[c];
    }
  }
}

// The scalars for which there are kernels.
#define DRAPE_KERNELS(Scalar)                                                                             \
  template void subtract_product(const RowPanel<Scalar>&, const RowPanel<Scalar>&, int, int, Scalar*);    \
  template void factorise_columns_below(const RowPanel<Scalar>&, const RowPanel<Scalar>&, int, int, int); \
  template bool factorise_columns_diagonal(const RowPanel<Scalar>&, int, int, int);                       \
  template void subtract_times(const RowPanel<Scalar>&, int, const Scalar*, Scalar*);                     \
  template void subtract_transposed_times(const Scalar*, int, int, int, const Scalar*, Scalar*);          \
  template void solve_lower(const RowPanel<Scalar>&, int, int, Scalar*);                                  \
  template void solve_lower_transposed(const RowPanel<Scalar>&, int, int, Scalar*);
DRAPE_KERNELS(double)
DRAPE_KERNELS(float)
#undef DRAPE_KERNELS

}  // namespace drape

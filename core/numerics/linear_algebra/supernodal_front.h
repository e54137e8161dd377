#pragma once

#include <algorithm>
#include <cstddef>

#include "core/numerics/linear_algebra/supernodal_kernels.h"

namespace drape {

/// Frontal matrix of a supernode: `pivots` vertices that it eliminates, then `updates` further ones.
///
/// The panel holds the pivot columns of all these rows, the update matrix the lower triangle of the update
/// rows. Both are stored in row panels, pivots first, padded to whole SIMD vectors with rows of the unit
/// matrix.
template <class Scalar>
struct Front {
  static constexpr int lanes = drape::lanes<Scalar>;
  static constexpr int row_panel_height = drape::row_panel_height<Scalar>;

  int pivots, updates;  // vertices
  Scalar *panel, *update;

  int columns() const { return padded<Scalar>(3 * pivots); }
  int pivot_row_panels() const { return (pivots + lanes - 1) / lanes; }
  int row_panels() const { return pivot_row_panels() + (updates + lanes - 1) / lanes; }

  RowPanel<Scalar> panel_rows(int i) const {
    const int skipped = pivot_row_panels();
    if (i < skipped) return row_panel(panel, i * row_panel_height, columns());
    return row_panel(panel + square(columns()), (i - skipped) * row_panel_height,
                     padded<Scalar>(3 * updates));
  }
  /// Rows of the panel before row panel i.
  int first_row(int i) const {
    const int skipped = pivot_row_panels();
    return i < skipped ? i * row_panel_height : columns() + (i - skipped) * row_panel_height;
  }
  /// Row panel j of the update matrix; it ends with the column of its last row.
  RowPanel<Scalar> update_rows(int j) const {
    const int row = j * row_panel_height;
    return {update + static_cast<std::size_t>(row) * (row + row_panel_height) / 2,
            std::min(row_panel_height, padded<Scalar>(3 * updates) - row)};
  }
  /// First column of the block of row panel i and the vertices of row panel k ≤ i.
  Scalar* block(int i, int k) const {
    const int skipped = pivot_row_panels();
    return k < skipped ? panel_rows(i).column(k * row_panel_height)
                       : update_rows(i - skipped).column((k - skipped) * row_panel_height);
  }
  /// The row panel of a vertex, and the vertex's first row in it.
  int row_panel_of(int vertex) const {
    return vertex < pivots ? vertex / lanes : pivot_row_panels() + (vertex - pivots) / lanes;
  }
  int row_of(int vertex) const { return 3 * ((vertex < pivots ? vertex : vertex - pivots) % lanes); }

  static std::size_t panel_size(int pivots, int updates) {
    return static_cast<std::size_t>(padded<Scalar>(3 * pivots)) *
           (padded<Scalar>(3 * pivots) + padded<Scalar>(3 * updates));
  }
  static std::size_t update_size(int updates) {
    if (updates == 0) return 0;
    const Front f{0, updates, nullptr, nullptr};
    const int last = f.row_panels() - 1, columns = padded<Scalar>(3 * updates);
    return static_cast<std::size_t>(last * row_panel_height) * (last + 1) * row_panel_height / 2 +
           static_cast<std::size_t>(columns - last * row_panel_height) * columns;
  }

  /// Extend-add: adds a child's update matrix to this front, where the child's update vertices have the given
  /// indices (ascending; pivots first).
  void add_update(const Front& child, const int* indices) const;
  /// Partial Cholesky of an assembled front: leaves the factor in the panel, with reciprocals on its
  /// diagonal, and the Schur complement in the update matrix. Returns false if a pivot is not positive.
  bool eliminate() const;
  /// The front's part of a triangular solve, on a vector in the order of the panel's rows. The forward solve
  /// divides the pivot rows by the factor and updates the others; the backward solve changes only the pivot
  /// rows.
  void solve_forward(Scalar* x) const;
  void solve_backward(Scalar* x) const;

 private:
  static std::size_t square(int n) { return static_cast<std::size_t>(n) * n; }
  RowPanel<Scalar> row_panel(Scalar* base, int row, int rows) const {
    return {base + static_cast<std::size_t>(row) * columns(), std::min(row_panel_height, rows - row)};
  }
};

}  // namespace drape

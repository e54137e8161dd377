#pragma once

#include <algorithm>
#include <cstddef>

#include "core/numerics/supernodal_kernels.h"

namespace drape {

/// The rows and columns of the matrix that one supernode touches: `own` vertices that it eliminates, then
/// `rest` further ones. The panel is the own columns of all of them; the update matrix is the lower triangle
/// of the rest. Both are in strips of vertices, the own first, filled up to whole vectors with rows of the
/// unit matrix.
struct Front {
  int own, rest;
  double *panel, *update;

  int columns() const { return padded(3 * own); }
  int own_strips() const { return (own + lanes - 1) / lanes; }
  int strips() const { return own_strips() + (rest + lanes - 1) / lanes; }

  Strip panel_strip(int i) const {
    const int skipped = own_strips();
    if (i < skipped) return strip(panel, i * strip_rows, columns());
    return strip(panel + square(columns()), (i - skipped) * strip_rows, padded(3 * rest));
  }
  /// The panel's rows before strip i.
  int first_row(int i) const {
    const int skipped = own_strips();
    return i < skipped ? i * strip_rows : columns() + (i - skipped) * strip_rows;
  }
  /// Strip j of the rows of the update matrix; it ends with the column of its last row.
  Strip update_strip(int j) const {
    const int row = j * strip_rows;
    return {update + static_cast<std::size_t>(row) * (row + strip_rows) / 2,
            std::min(strip_rows, padded(3 * rest) - row)};
  }
  /// In the rows of strip i, the first of the columns that belong to the vertices of strip k ≤ i.
  double* block(int i, int k) const {
    const int skipped = own_strips();
    return k < skipped ? panel_strip(i).column(k * strip_rows)
                       : update_strip(i - skipped).column((k - skipped) * strip_rows);
  }
  /// The strip of a vertex, and the vertex's first row in it.
  int strip_of(int vertex) const {
    return vertex < own ? vertex / lanes : own_strips() + (vertex - own) / lanes;
  }
  int row_of(int vertex) const { return 3 * ((vertex < own ? vertex : vertex - own) % lanes); }

  static std::size_t panel_size(int own, int rest) {
    return static_cast<std::size_t>(padded(3 * own)) * (padded(3 * own) + padded(3 * rest));
  }
  static std::size_t update_size(int rest) {
    if (rest == 0) return 0;
    const Front f{0, rest, nullptr, nullptr};
    const int last = f.strips() - 1, columns = padded(3 * rest);
    return static_cast<std::size_t>(last * strip_rows) * (last + 1) * strip_rows / 2 +
           static_cast<std::size_t>(columns - last * strip_rows) * columns;
  }

 private:
  static std::size_t square(int n) { return static_cast<std::size_t>(n) * n; }
  Strip strip(double* base, int row, int rows) const {
    return {base + static_cast<std::size_t>(row) * columns(), std::min(strip_rows, rows - row)};
  }
};

/// Adds a child's update matrix to the front of its parent, where the child's rest has the given places
/// (index among the parent's own vertices, then its rest; ascending).
void add_update(const Front& child, const int* places, const Front& parent);

/// Cholesky of the own columns of an assembled front: leaves the factor in the panel, reciprocals on its
/// diagonal, and the Schur complement in the update matrix. False when a pivot is not positive.
bool eliminate(const Front& front);

/// The front's part of a triangular solve, on a vector in order of the panel's rows: divides the own rows by
/// the factor and subtracts what follows for the rest; and the reverse, which changes the own rows alone.
void solve_forward(const Front& front, double* x);
void solve_backward(const Front& front, double* x);

}  // namespace drape

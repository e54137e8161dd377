#include "core/numerics/linear_algebra/supernodal_front.h"

#include <array>
#include <utility>
#include <vector>

namespace drape {
namespace {

/// Row panels of a tile: 192 rows. Two tiles of as many columns and their product share a second-level cache
/// of 1 MB.
template <class Scalar>
constexpr int tile = 192 / row_panel_height<Scalar>;

/// Consecutive rows of a child's row panel that are consecutive in a row panel of its parent too.
template <class Scalar>
struct Run {
  const Scalar* from;
  int from_height;
  Scalar *panel, *update;  // the first row in the parent's row panels, at the first pivot and update column
  int height;
  int vertices;
  int last;  // of the child's vertices
};

template <class Scalar>
std::vector<Run<Scalar>> runs_of(const Front<Scalar>& child, const int* indices,
                                 const Front<Scalar>& parent) {
  std::vector<Run<Scalar>> runs;
  for (int begin = 0, end; begin < child.updates; begin = end) {
    const int row_panel = parent.row_panel_of(indices[begin]);
    end = begin + 1;
    while (end < child.updates && end % lanes<Scalar> != 0 && indices[end] == indices[end - 1] + 1 &&
           parent.row_panel_of(indices[end]) == row_panel)
      ++end;
    const RowPanel<Scalar> from = child.update_rows(begin / lanes<Scalar>),
                           panel = parent.panel_rows(row_panel);
    const int row = parent.row_of(indices[begin]), skipped = parent.pivot_row_panels();
    Scalar* update = row_panel < skipped ? nullptr : parent.update_rows(row_panel - skipped).data + row;
    runs.push_back({from.data + 3 * (begin % lanes<Scalar>), from.height, panel.data + row, update,
                    panel.height, end - begin, end - 1});
  }
  return runs;
}

/// Adds the run's rows of all columns up to the diagonal. N: rows of the run.
template <class Scalar, int N>
void add_run(const Run<Scalar>& run, const int* indices, int pivots) {
  const Scalar* from = run.from;
  for (int j = 0; j <= run.last; ++j) {
    Scalar* to = indices[j] < pivots
                     ? run.panel + static_cast<std::ptrdiff_t>(3 * indices[j]) * run.height
                     : run.update + static_cast<std::ptrdiff_t>(3 * (indices[j] - pivots)) * run.height;
    for (int c = 0; c < 3; ++c, to += run.height, from += run.from_height)
      for (int r = 0; r < N; ++r) to[r] += from[r];
  }
}

template <class Scalar, int... K>
constexpr auto run_adders(std::integer_sequence<int, K...>) {
  return std::array{&add_run<Scalar, 3 * (K + 1)>...};
}

template <class Scalar>
void add_runs(const std::vector<Run<Scalar>>& runs, const int* indices, int pivots) {
  static constexpr auto adders = run_adders<Scalar>(std::make_integer_sequence<int, lanes<Scalar>>());
  parallel_kernels<Scalar>(static_cast<int>(runs.size()), 8, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) adders[runs[k].vertices - 1](runs[k], indices, pivots);
  });
}

/// Cholesky of the pivot rows of row panels [begin, end).
template <class Scalar>
bool factorise_diagonal(const Front<Scalar>& f, int begin, int end) {
  const int first = begin * row_panel_height<Scalar>,
            last = std::min(end * row_panel_height<Scalar>, f.columns());
  for (int column = first; column < last; column += tile_columns) {
    const int s = column / row_panel_height<Scalar>, row = column % row_panel_height<Scalar>;
    const RowPanel<Scalar> diagonal = f.panel_rows(s);
    if (!factorise_columns_diagonal(diagonal, row, first, column)) return false;
    for (int i = s + 1; i < end; ++i) factorise_columns_below(f.panel_rows(i), diagonal, row, first, column);
  }
  return true;
}

}  // namespace

template <class Scalar>
void Front<Scalar>::add_update(const Front& child, const int* indices) const {
  add_runs(runs_of(child, indices, *this), indices, pivots);
}

template <class Scalar>
bool Front<Scalar>::eliminate() const {
  const int panels = row_panels(), pivot_panels = pivot_row_panels();
  for (int begin = 0; begin < pivot_panels; begin += tile<Scalar>) {
    const int end = std::min(begin + tile<Scalar>, pivot_panels);
    if (!factorise_diagonal(*this, begin, end)) return false;
    const int first = begin * row_panel_height, last = std::min(end * row_panel_height, 3 * pivots);
    parallel_kernels<Scalar>(panels - end, 1, [&](int b, int e) {
      for (int i = end + b; i < end + e; ++i)
        for (int column = first; column < last; column += tile_columns)
          factorise_columns_below(panel_rows(i), panel_rows(column / row_panel_height),
                                  column % row_panel_height, first, column);
    });
    // A small front has smaller tiles, so that there are enough for threads to share.
    const int height = std::clamp((panels - end) / 4, 1, tile<Scalar>);
    const int tiles = (panels - end + height - 1) / height;
    parallel_kernels<Scalar>(tiles * (tiles + 1) / 2, 1, [&](int pair, int) {
      int row = 0;
      while ((row + 1) * (row + 2) / 2 <= pair) ++row;
      const int column = pair - row * (row + 1) / 2;
      const int row_begin = end + row * height, column_begin = end + column * height;
      for (int i = row_begin; i < std::min(row_begin + height, panels); ++i)
        for (int k = column_begin; k < std::min(column_begin + height, i + 1); ++k)
          subtract_product(panel_rows(i), panel_rows(k), first, last, block(i, k));
    });
  }
  return true;
}

template <class Scalar>
void Front<Scalar>::solve_forward(Scalar* x) const {
  const int pivot_panels = pivot_row_panels();
  for (int i = 0; i < pivot_panels; ++i) {
    const RowPanel<Scalar> a = panel_rows(i);
    const int first = i * row_panel_height;
    Scalar* rows = x + first;
    subtract_times(a, first, x, rows);
    solve_lower(a, first, std::min(a.height, 3 * pivots - first), rows);
  }
  parallel_kernels<Scalar>(row_panels() - pivot_panels, 4, [&](int begin, int end) {
    for (int i = pivot_panels + begin; i < pivot_panels + end; ++i)
      subtract_times(panel_rows(i), 3 * pivots, x, x + first_row(i));
  });
}

template <class Scalar>
void Front<Scalar>::solve_backward(Scalar* x) const {
  const int pivot_panels = pivot_row_panels(), width = columns(), height = padded<Scalar>(3 * updates);
  parallel_kernels<Scalar>(width / lanes, 3, [&](int begin, int end) {
    for (int column = begin * lanes; column < end * lanes; column += lanes)
      subtract_transposed_times(panel_rows(pivot_panels).data, height, width, column, x + width, x + column);
  });
  for (int i = pivot_panels - 1; i >= 0; --i) {
    const RowPanel<Scalar> a = panel_rows(i);
    const int first = i * row_panel_height, end = first + a.height;
    for (int column = first; column < end; column += lanes)
      subtract_transposed_times(a.data + static_cast<std::ptrdiff_t>(a.height) * width, width - end, width,
                                column, x + end, x + column);
    solve_lower_transposed(a, first, std::min(a.height, 3 * pivots - first), x + first);
  }
}

template struct Front<double>;
template struct Front<float>;

}  // namespace drape

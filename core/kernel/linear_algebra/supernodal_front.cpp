#include "core/kernel/linear_algebra/supernodal_front.h"

#include <array>
#include <utility>
#include <vector>

#include "core/kernel/linear_algebra/parallel.h"

namespace drape {
namespace {

/// Row panels of a tile: 192 rows. Two tiles of as many columns and their product share a second-level cache
/// of 1 MB.
constexpr int tile = 192 / row_panel_height;

/// Consecutive rows of a child's row panel that are consecutive in a row panel of its parent too.
struct Run {
  const double* from;
  int from_height;
  double *panel, *update;  // the first row in the parent's row panels, at the first pivot and update column
  int height;
  int vertices;
  int last;  // of the child's vertices
};

std::vector<Run> runs_of(const Front& child, const int* indices, const Front& parent) {
  std::vector<Run> runs;
  for (int begin = 0, end; begin < child.updates; begin = end) {
    const int row_panel = parent.row_panel_of(indices[begin]);
    end = begin + 1;
    while (end < child.updates && end % lanes != 0 && indices[end] == indices[end - 1] + 1 &&
           parent.row_panel_of(indices[end]) == row_panel)
      ++end;
    const RowPanel from = child.update_rows(begin / lanes), panel = parent.panel_rows(row_panel);
    const int row = parent.row_of(indices[begin]), skipped = parent.pivot_row_panels();
    double* update = row_panel < skipped ? nullptr : parent.update_rows(row_panel - skipped).data + row;
    runs.push_back({from.data + 3 * (begin % lanes), from.height, panel.data + row, update, panel.height,
                    end - begin, end - 1});
  }
  return runs;
}

/// Adds the run's rows of all columns up to the diagonal. N: rows of the run.
template <int N>
void add_run(const Run& run, const int* indices, int pivots) {
  const double* from = run.from;
  for (int j = 0; j <= run.last; ++j) {
    double* to = indices[j] < pivots
                     ? run.panel + static_cast<std::ptrdiff_t>(3 * indices[j]) * run.height
                     : run.update + static_cast<std::ptrdiff_t>(3 * (indices[j] - pivots)) * run.height;
    for (int c = 0; c < 3; ++c, to += run.height, from += run.from_height)
      for (int r = 0; r < N; ++r) to[r] += from[r];
  }
}

template <int... K>
constexpr auto run_adders(std::integer_sequence<int, K...>) {
  return std::array{&add_run<3 * (K + 1)>...};
}

/// Cholesky of the pivot rows of row panels [begin, end).
bool factorise_diagonal(const Front& f, int begin, int end) {
  const int first = begin * row_panel_height, last = std::min(end * row_panel_height, f.columns());
  for (int column = first; column < last; column += lanes) {
    const int s = column / row_panel_height, row = column % row_panel_height;
    const RowPanel diagonal = f.panel_rows(s);
    if (!factorise_columns_diagonal(diagonal, row, first, column)) return false;
    for (int i = s + 1; i < end; ++i) factorise_columns_below(f.panel_rows(i), diagonal, row, first, column);
  }
  return true;
}

}  // namespace

void add_update(const Front& child, const int* indices, const Front& parent) {
  static constexpr auto adders = run_adders(std::make_integer_sequence<int, lanes>());
  const std::vector<Run> runs = runs_of(child, indices, parent);
  parallel_for(static_cast<int>(runs.size()), 8, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) adders[runs[k].vertices - 1](runs[k], indices, parent.pivots);
  });
}

bool eliminate(const Front& f) {
  const int panels = f.row_panels(), pivot_panels = f.pivot_row_panels();
  for (int begin = 0; begin < pivot_panels; begin += tile) {
    const int end = std::min(begin + tile, pivot_panels);
    if (!factorise_diagonal(f, begin, end)) return false;
    const int first = begin * row_panel_height, last = std::min(end * row_panel_height, 3 * f.pivots);
    parallel_for(panels - end, 2, [&](int b, int e) {
      for (int i = end + b; i < end + e; ++i)
        for (int column = first; column < last; column += lanes)
          factorise_columns_below(f.panel_rows(i), f.panel_rows(column / row_panel_height),
                                  column % row_panel_height, first, column);
    });
    const int tiles = (panels - end + tile - 1) / tile;
    parallel_for(tiles * (tiles + 1) / 2, 1, [&](int pair, int) {
      int row = 0;
      while ((row + 1) * (row + 2) / 2 <= pair) ++row;
      const int column = pair - row * (row + 1) / 2;
      const int row_begin = end + row * tile, column_begin = end + column * tile;
      for (int i = row_begin; i < std::min(row_begin + tile, panels); ++i)
        for (int k = column_begin; k < std::min(column_begin + tile, i + 1); ++k)
          subtract_product(f.panel_rows(i), f.panel_rows(k), first, last, f.block(i, k));
    });
  }
  return true;
}

void solve_forward(const Front& f, double* x) {
  const int pivot_panels = f.pivot_row_panels();
  for (int i = 0; i < pivot_panels; ++i) {
    const RowPanel a = f.panel_rows(i);
    double* rows = x + f.first_row(i);
    subtract_times(a, i * row_panel_height, x, rows);
    solve_lower(a.column(i * row_panel_height), a.height, a.height, rows);
  }
  parallel_for(f.row_panels() - pivot_panels, 4, [&](int begin, int end) {
    for (int i = pivot_panels + begin; i < pivot_panels + end; ++i)
      subtract_times(f.panel_rows(i), 3 * f.pivots, x, x + f.first_row(i));
  });
}

void solve_backward(const Front& f, double* x) {
  const int pivot_panels = f.pivot_row_panels(), panels = f.row_panels();
  const auto subtract = [&](int group, int begin, int end) {
    for (int i = begin; i < end; ++i)
      subtract_transposed_times(f.panel_rows(i), group * lanes, x + f.first_row(i), x + group * lanes);
  };
  const int groups = f.columns() / lanes;
  parallel_for(groups, row_panel_height / lanes, [&](int begin, int end) {
    for (int i = pivot_panels; i < panels; ++i)
      for (int g = begin; g < end; ++g) subtract(g, i, i + 1);
  });
  for (int i = pivot_panels - 1; i >= 0; --i) {
    const RowPanel a = f.panel_rows(i);
    const int column = i * row_panel_height;
    for (int g = column / lanes; g < (column + a.height) / lanes; ++g) subtract(g, i + 1, pivot_panels);
    solve_lower_transposed(a.column(column), a.height, a.height, x + column);
  }
}

}  // namespace drape

#include "core/numerics/supernodal_front.h"

#include <array>
#include <utility>
#include <vector>

#include "core/numerics/parallel.h"

namespace drape {
namespace {

/// Strips of a tile: 192 rows, so that two tiles of as many columns and their product share a second-level
/// cache of 1 MB.
constexpr int tile = 192 / strip_rows;

/// Rows of a child's strip that are neighbours in a strip of its parent too.
struct Run {
  const double* from;
  int from_height;
  double *panel, *update;  // the row in the parent's strips, at the first own and the first further column
  int height;
  int vertices;
  int last;  // of the child's vertices
};

std::vector<Run> runs_of(const Front& child, const int* places, const Front& parent) {
  std::vector<Run> runs;
  for (int begin = 0, end; begin < child.rest; begin = end) {
    const int strip = parent.strip_of(places[begin]);
    end = begin + 1;
    while (end < child.rest && end % lanes != 0 && places[end] == places[end - 1] + 1 &&
           parent.strip_of(places[end]) == strip)
      ++end;
    const Strip from = child.update_strip(begin / lanes), panel = parent.panel_strip(strip);
    const int row = parent.row_of(places[begin]), skipped = parent.own_strips();
    double* update = strip < skipped ? nullptr : parent.update_strip(strip - skipped).data + row;
    runs.push_back({from.data + 3 * (begin % lanes), from.height, panel.data + row, update, panel.height,
                    end - begin, end - 1});
  }
  return runs;
}

/// Adds the run's rows of all columns up to the diagonal. N: rows of the run.
template <int N>
void add_run(const Run& run, const int* places, int own) {
  const double* from = run.from;
  for (int j = 0; j <= run.last; ++j) {
    double* to = places[j] < own
                     ? run.panel + static_cast<std::ptrdiff_t>(3 * places[j]) * run.height
                     : run.update + static_cast<std::ptrdiff_t>(3 * (places[j] - own)) * run.height;
    for (int c = 0; c < 3; ++c, to += run.height, from += run.from_height)
      for (int r = 0; r < N; ++r) to[r] += from[r];
  }
}

template <int... K>
constexpr auto run_adders(std::integer_sequence<int, K...>) {
  return std::array{&add_run<3 * (K + 1)>...};
}

/// Cholesky of the own rows of strips [begin, end).
bool factorise_diagonal(const Front& f, int begin, int end) {
  const int first = begin * strip_rows, last = std::min(end * strip_rows, f.columns());
  for (int column = first; column < last; column += lanes) {
    const int s = column / strip_rows, row = column % strip_rows;
    const Strip diagonal = f.panel_strip(s);
    if (!factorise_columns_diagonal(diagonal, row, first, column)) return false;
    for (int i = s + 1; i < end; ++i) factorise_columns_below(f.panel_strip(i), diagonal, row, first, column);
  }
  return true;
}

}  // namespace

void add_update(const Front& child, const int* places, const Front& parent) {
  static constexpr auto adders = run_adders(std::make_integer_sequence<int, lanes>());
  const std::vector<Run> runs = runs_of(child, places, parent);
  parallel_for(static_cast<int>(runs.size()), 8, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) adders[runs[k].vertices - 1](runs[k], places, parent.own);
  });
}

bool eliminate(const Front& f) {
  const int strips = f.strips(), own = f.own_strips();
  for (int begin = 0; begin < own; begin += tile) {
    const int end = std::min(begin + tile, own);
    if (!factorise_diagonal(f, begin, end)) return false;
    const int first = begin * strip_rows, last = std::min(end * strip_rows, 3 * f.own);
    parallel_for(strips - end, 2, [&](int b, int e) {
      for (int i = end + b; i < end + e; ++i)
        for (int column = first; column < last; column += lanes)
          factorise_columns_below(f.panel_strip(i), f.panel_strip(column / strip_rows), column % strip_rows,
                                  first, column);
    });
    const int tiles = (strips - end + tile - 1) / tile;
    parallel_for(tiles * (tiles + 1) / 2, 1, [&](int pair, int) {
      int row = 0;
      while ((row + 1) * (row + 2) / 2 <= pair) ++row;
      const int column = pair - row * (row + 1) / 2;
      const int row_begin = end + row * tile, column_begin = end + column * tile;
      for (int i = row_begin; i < std::min(row_begin + tile, strips); ++i)
        for (int k = column_begin; k < std::min(column_begin + tile, i + 1); ++k)
          subtract_product(f.panel_strip(i), f.panel_strip(k), first, last, f.block(i, k));
    });
  }
  return true;
}

void solve_forward(const Front& f, double* x) {
  const int own = f.own_strips();
  for (int i = 0; i < own; ++i) {
    const Strip a = f.panel_strip(i);
    double* rows = x + f.first_row(i);
    subtract_times(a, i * strip_rows, x, rows);
    solve_lower(a.column(i * strip_rows), a.height, a.height, rows);
  }
  parallel_for(f.strips() - own, 4, [&](int begin, int end) {
    for (int i = own + begin; i < own + end; ++i)
      subtract_times(f.panel_strip(i), 3 * f.own, x, x + f.first_row(i));
  });
}

void solve_backward(const Front& f, double* x) {
  const int own = f.own_strips(), strips = f.strips();
  const auto subtract = [&](int group, int begin, int end) {
    for (int i = begin; i < end; ++i)
      subtract_transposed_times(f.panel_strip(i), group * lanes, x + f.first_row(i), x + group * lanes);
  };
  const int groups = f.columns() / lanes;
  parallel_for(groups, strip_rows / lanes, [&](int begin, int end) {
    for (int i = own; i < strips; ++i)
      for (int g = begin; g < end; ++g) subtract(g, i, i + 1);
  });
  for (int i = own - 1; i >= 0; --i) {
    const Strip a = f.panel_strip(i);
    const int column = i * strip_rows;
    for (int g = column / lanes; g < (column + a.height) / lanes; ++g) subtract(g, i + 1, own);
    solve_lower_transposed(a.column(column), a.height, a.height, x + column);
  }
}

}  // namespace drape

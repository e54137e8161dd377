#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/kernel/threads/parallel.h"

namespace drape {

/// The columns that each row of a sparse matrix has, ascending: row i those from row_start[i] to row_start[i
/// + 1] of `columns`.
struct ColumnSets {
  std::vector<int> row_start, columns;

  /// Of `rows` rows with columns below `column_count`; find(i, add) calls add(column) for each column of row
  /// i, also repeatedly. Rows are found in parallel.
  template <class Find>
  static ColumnSets collect(int rows, int column_count, const Find& find) {
    const int grain = std::max(4096, rows / 16 + 1);
    std::vector<ColumnSets> pieces((rows + grain - 1) / grain);  // whose rows end at row_start
    parallel_for(rows, grain, [&](int begin, int end) {
      auto& [ends, found] = pieces[begin / grain];
      std::vector<int> last_row(column_count, -1);  // that has the column
      for (int i = begin; i < end; ++i) {
        const auto first = static_cast<std::ptrdiff_t>(found.size());
        find(i, [&, &all = found](int column) {
          if (std::exchange(last_row[column], i) != i) all.push_back(column);
        });
        std::sort(found.begin() + first, found.end());
        ends.push_back(static_cast<int>(found.size()));
      }
    });
    ColumnSets whole{{0}, {}};
    for (const auto& [ends, found] : pieces) {
      const int before = static_cast<int>(whole.columns.size());
      for (const int end : ends) whole.row_start.push_back(before + end);
      whole.columns.insert(whole.columns.end(), found.begin(), found.end());
    }
    return whole;
  }
};

}  // namespace drape

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/block_sink.h"
#include "core/kernel/interfaces/topology.h"
#include "core/kernel/interfaces/triangle_mesh.h"
#include "core/kernel/threads/parallel.h"

namespace drape {

/// The columns of each row of a sparse matrix, ascending and below `column_count`; find(i, add) calls
/// add(column) for each column of row i, also repeatedly. Rows are found in parallel.
template <class Find>
AdjacencyList collect_columns(int rows, int column_count, const Find& find) {
  const int grain = std::max(4096, rows / 16 + 1);
  std::vector<AdjacencyList> pieces((rows + grain - 1) / grain);  // whose rows end at `start`
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
  AdjacencyList whole{{0}, {}};
  for (const auto& [ends, found] : pieces) {
    const int before = static_cast<int>(whole.items.size());
    for (const int end : ends) whole.start.push_back(before + end);
    whole.items.insert(whole.items.end(), found.begin(), found.end());
  }
  return whole;
}

/// Sparsity of a symmetric matrix of 3×3 blocks, one block row for each vertex. Stores blocks (i, j) with i ≤
/// j row by row, columns ascending; every diagonal block is present. Immutable.
class BlockPattern {
 public:
  /// All pairs (i, j) that occur together in a row of any of the stencils.
  static std::shared_ptr<const BlockPattern> of(int vertex_count, const std::vector<Stencils>& stencils);

  /// The diagonal, and all pairs (i, j), i < j, for which find(i, add) calls add(j). It may repeat a j, and
  /// add smaller ones, which are left out. Rows are found in parallel.
  template <class Find>
  static std::shared_ptr<const BlockPattern> collect(int rows, const Find& find) {
    AdjacencyList all = collect_columns(rows, rows, [&](int i, const auto& add) {
      add(i);
      find(i, [&](int j) {
        if (j > i) add(j);
      });
    });
    return std::make_shared<const BlockPattern>(std::move(all.start), std::move(all.items));
  }

  /// From rows of ascending columns j ≥ i, diagonal first.
  BlockPattern(std::vector<int> row_start, std::vector<int> columns);

  int rows() const { return static_cast<int>(row_start.size()) - 1; }
  int blocks() const { return static_cast<int>(columns.size()); }
  /// The columns of row i.
  std::span<const int> row(int i) const {
    return {columns.data() + row_start[i], columns.data() + row_start[i + 1]};
  }
  /// Calls visit(i, j, b) for each block b = (i, j), in the order of b.
  template <class Visit>
  void for_each_block(const Visit& visit) const {
    for (int i = 0; i < rows(); ++i)
      for (int b = row_start[i]; b < row_start[i + 1]; ++b) visit(i, columns[b], b);
  }
  /// For each row i all j with a block (i, j) or (j, i), i itself included.
  AdjacencyList neighbours() const;
  /// Index of block (i, j), i ≤ j; -1 if it is not in the pattern.
  int find(int i, int j) const;

  const std::vector<int> row_start;  ///< rows() + 1
  const std::vector<int> columns;    ///< blocks()
};

/// A symmetric matrix over a BlockPattern; block b is values[9b … 9b + 8], row-major.
struct BlockMatrix {
  std::shared_ptr<const BlockPattern> pattern;
  std::vector<double> values;

  explicit BlockMatrix(std::shared_ptr<const BlockPattern> pattern = nullptr);  ///< zero
  void set_zero();
  double* block(int b) { return values.data() + 9 * static_cast<std::size_t>(b); }
  const double* block(int b) const { return values.data() + 9 * static_cast<std::size_t>(b); }
  /// y = A x for n×3 x and y.
  void multiply(const Positions& x, Positions& y) const;

 private:
  /// Adds to rows [begin, end) of y, zero before, those of A x.
  void multiply_rows(int begin, int end, const Positions& x, Positions& y) const;
};

/// The whole matrix (3n×3n), for small ones.
Eigen::MatrixXd dense(const BlockMatrix& matrix);

/// Indices in a pattern of the blocks of one energy's elements, computed once.
class BlockSlots {
 public:
  BlockSlots(const BlockPattern& pattern, const Stencils& stencils);
  /// Adds to `matrix`, over the pattern, `factor` times what it is given. Refers to both.
  BlockSink sink(BlockMatrix& matrix, double factor = 1) const {
    return {slots_.data(), pairs_, matrix.values.data(), factor};
  }

 private:
  int pairs_;               // k(k+1)/2 for each element
  std::vector<int> slots_;  // as BlockSink takes them
};

}  // namespace drape

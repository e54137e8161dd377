#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <vector>

namespace drape {

/// m×k vertex indices, one row for each element; -1 where an element has fewer vertices.
using Stencils = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Sparsity of a symmetric matrix of 3×3 blocks, one block row for each vertex. Stores blocks (i, j) with i ≤
/// j row by row, columns ascending; every diagonal block is present. Immutable.
class BlockPattern {
 public:
  /// All pairs (i, j) that occur together in a row of any of the stencils.
  static std::shared_ptr<const BlockPattern> of(int vertex_count, const std::vector<Stencils>& stencils);

  /// From rows of ascending columns j ≥ i, diagonal first.
  BlockPattern(std::vector<int> row_start, std::vector<int> columns);

  int rows() const { return static_cast<int>(row_start.size()) - 1; }
  int blocks() const { return static_cast<int>(columns.size()); }
  /// Index of block (i, j), i ≤ j; -1 if it is not in the pattern.
  int find(int i, int j) const;

  const std::vector<int> row_start;  ///< rows() + 1
  const std::vector<int> columns;    ///< blocks()
};

/// A symmetric matrix over a BlockPattern; block b is values[9b … 9b + 8], row-major.
struct BlockMatrix {
  std::shared_ptr<const BlockPattern> pattern;
  std::vector<double> values;

  explicit BlockMatrix(std::shared_ptr<const BlockPattern> pattern = nullptr);
  void set_zero();
  double* block(int b) { return values.data() + 9 * static_cast<std::size_t>(b); }
  const double* block(int b) const { return values.data() + 9 * static_cast<std::size_t>(b); }
  /// y = A x for n×3 x and y.
  void multiply(const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>& x,
                Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>& y) const;
};

/// Indices in a pattern of the blocks of one energy's elements, computed once.
class BlockSlots {
 public:
  BlockSlots(const BlockPattern& pattern, const Stencils& stencils);

 private:
  friend class BlockSink;
  int pairs_;               // k(k+1)/2 for each element
  std::vector<int> slots_;  // block index, bitwise complemented if transposed, or no_block
  static constexpr int no_block = std::numeric_limits<int>::min();  // a pair with a missing vertex
};

/// Adds elements' 3×3 blocks to a matrix. Concurrent calls are safe for elements that share no vertex.
class BlockSink {
 public:
  /// `factor` multiplies all added blocks.
  BlockSink(const BlockSlots& slots, BlockMatrix& matrix, double factor = 1)
      : slots_(slots.slots_.data()), pairs_(slots.pairs_), values_(matrix.values.data()), factor_(factor) {}

  /// A sink for the elements from row `first` of the stencils on.
  BlockSink from(int first) const {
    BlockSink part = *this;
    part.slots_ += static_cast<std::ptrdiff_t>(first) * pairs_;
    return part;
  }

  /// Adds the element's 3×3 block h, row-major, whose rows belong to its vertex a and whose columns belong to
  /// its vertex b. Only pairs a ≤ b are given: the other half follows by symmetry. Nothing is checked.
  void add(int element, int a, int b, const double* h) {
    const int slot = slots_[static_cast<std::size_t>(element) * pairs_ + b * (b + 1) / 2 + a];
    if (slot >= 0) {
      double* v = values_ + 9 * static_cast<std::size_t>(slot);
      for (int i = 0; i < 9; ++i) v[i] += factor_ * h[i];
    } else if (slot != BlockSlots::no_block) {
      double* v = values_ + 9 * static_cast<std::size_t>(~slot);
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) v[3 * r + c] += factor_ * h[3 * c + r];
    }
  }

 private:
  const int* slots_;
  int pairs_;
  double* values_;
  double factor_;
};

}  // namespace drape

#pragma once

#include <memory>
#include <vector>

#include "core/numerics/linear_algebra/block_matrix.h"

namespace drape {

/// Four numbers in single precision: a vertex's three and one of padding.
using Float4 = float __attribute__((vector_size(16)));

/// A symmetric matrix of 3×3 blocks in single precision, all of it stored by rows, with block Gauss–Seidel
/// sweeps.
///
/// The sweeps go through pieces of so many rows side by side, which see each other's old values, so that bits
/// do not depend on the number of threads. The diagonal blocks of such rows are raised by the norms of their
/// blocks in other pieces, without which a sweep may diverge (Baker, Falgout, Kolev and Yang 2011, l1 hybrid
/// smoothers).
class SmoothedMatrix {
 public:
  static constexpr int piece = 4096;  ///< rows

  int rows() const { return static_cast<int>(row_start.size()) - 1; }
  double flops_of_product() const { return 18.0 * static_cast<double>(columns.size()); }

  /// Inverts the diagonal blocks. Returns false if one is not positive definite.
  bool finish();

  /// x = the result of a forward sweep from x = 0; r = b − A x.
  void presmooth(const std::vector<Float4>& b, std::vector<Float4>& x, std::vector<Float4>& r) const;
  /// A backward sweep from x, the adjoint of the forward one. `old` is work space.
  void postsmooth(const std::vector<Float4>& b, std::vector<Float4>& x, std::vector<Float4>& old) const;

  std::vector<int> row_start;  ///< rows + 1
  std::vector<int> columns;    ///< ascending within a row
  std::vector<float> values;   ///< 9 a block, column by column, and some padding at the end

  float* block(std::size_t k) { return values.data() + 9 * k; }
  const float* block(std::size_t k) const { return values.data() + 9 * k; }
  /// Sets the number of blocks from `columns`.
  void allocate() { values.assign(9 * columns.size() + 4, 0.0F); }

 private:
  struct Row {
    int own, diagonal, own_end;  ///< first block of the row's own piece, diagonal block, end of the piece's
    float raise;                 ///< of the diagonal
  };

  Float4 solve_diagonal(int row, Float4 b) const {
    const Float4* inverse = &inverse_[3 * static_cast<std::size_t>(row)];
    return inverse[0] * b[0] + inverse[1] * b[1] + inverse[2] * b[2];
  }

  std::vector<Row> parts_;
  std::vector<Float4> inverse_;  // of the raised diagonal blocks, three columns each
};

}  // namespace drape

#pragma once

#include <vector>

#include "core/kernel/interfaces/topology.h"

namespace drape {

/// Four numbers in single precision: a vertex's three and one of padding.
using Float4 = float __attribute__((vector_size(16)));

/// A symmetric matrix of 3×3 blocks in single precision, all of it stored, with block Gauss–Seidel sweeps.
///
/// The sweeps go through pieces of 4096 rows side by side, which see each other's old values, so that bits
/// do not depend on the number of threads. The diagonal blocks are raised by the norms of their
/// blocks in other pieces, without which the preconditioner need not be positive definite (Baker, Falgout,
/// Kolev and Yang 2011, l1 hybrid smoothers).
class SmoothedMatrix {
 public:
  static constexpr int piece = 4096;  ///< rows

  /// Takes the columns of each row's blocks, the diagonal among them, and makes room for their values.
  void set_pattern(AdjacencyList pattern);
  const AdjacencyList& pattern() const { return pattern_; }

  int rows() const { return static_cast<int>(pattern_.start.size()) - 1; }
  /// The 9 numbers of the k-th block of the pattern, column by column.
  float* block(int k) { return values_.data() + 9 * static_cast<std::size_t>(place_[k]); }
  double flops_of_product() const { return 18.0 * static_cast<double>(pattern_.items.size()); }

  /// Inverts the diagonal blocks. Returns false if one is not positive definite.
  bool finish();

  /// x = the result of a forward sweep from x = 0; r = b − A x.
  void presmooth(const std::vector<Float4>& b, std::vector<Float4>& x, std::vector<Float4>& r) const;
  /// A backward sweep from x, the adjoint of the forward one. `old` is work space.
  void postsmooth(const std::vector<Float4>& b, std::vector<Float4>& x, std::vector<Float4>& old) const;

 private:
  /// Where the stored blocks of one kind begin, row by row, and end. A sweep reads them in the order in which
  /// they are stored, which takes a third of the time of leaps through memory.
  using Part = std::vector<int>;

  Float4 sum(const Part& part, int row, const std::vector<Float4>& x) const;
  Float4 sum_backward(const Part& part, int row, const std::vector<Float4>& x) const;
  Float4 solve_diagonal(int row, Float4 b) const {
    const Float4* inverse = &inverse_[3 * static_cast<std::size_t>(row)];
    return inverse[0] * b[0] + inverse[1] * b[1] + inverse[2] * b[2];
  }

  AdjacencyList pattern_;
  std::vector<int> place_;           // where each block is stored, in blocks
  Part below_, above_, elsewhere_;   // blocks of the row's own piece before and after the diagonal; others
  std::vector<int> stored_columns_;  // in the order of the values, the diagonal last
  std::vector<float> values_;        // 9 a block, and some padding at the end
  std::vector<float> raise_;         // of each row's diagonal
  std::vector<Float4> inverse_;      // of the raised diagonal blocks, three columns each
};

}  // namespace drape

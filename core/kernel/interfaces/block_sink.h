#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>

namespace drape {

/// m×k vertex indices, one row for each element; -1 where an element has fewer vertices.
using Stencils = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Adds elements' 3×3 blocks to a matrix (BlockSlots::sink), also concurrently if they share no vertex.
class BlockSink {
 public:
  /// The slot of a pair with a missing vertex.
  static constexpr int no_block = std::numeric_limits<int>::min();

  /// `slots` has one entry for each of an element's `pairs` pairs of vertices (a, b), a ≤ b, at b(b + 1)/2 +
  /// a: the block's index in `values`, bitwise complemented if the block is transposed, or no_block. `factor`
  /// multiplies all added blocks. Refers to both arrays.
  BlockSink(const int* slots, int pairs, double* values, double factor)
      : slots_(slots), pairs_(pairs), values_(values), factor_(factor) {}

  /// A sink for the elements from row `first` of the stencils on, with a further factor.
  BlockSink from(int first, double factor = 1) const {
    return {slots_ + static_cast<std::ptrdiff_t>(first) * pairs_, pairs_, values_, factor * factor_};
  }

  /// Adds the element's 3×3 block h, row-major, whose rows belong to its vertex a and whose columns belong to
  /// its vertex b. Only pairs a ≤ b are given: the other half follows by symmetry. Nothing is checked.
  void add(int element, int a, int b, const double* h) {
    const int slot = slots_[static_cast<std::size_t>(element) * pairs_ + b * (b + 1) / 2 + a];
    if (slot == no_block) return;
    double* v = values_ + 9 * static_cast<std::size_t>(slot >= 0 ? slot : ~slot);
    double sum[9];  // apart from both arrays, which might overlap for all that a compiler knows
    if (slot >= 0)
      for (int i = 0; i < 9; ++i) sum[i] = v[i] + factor_ * h[i];
    else
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) sum[3 * r + c] = v[3 * r + c] + factor_ * h[3 * c + r];
    for (int i = 0; i < 9; ++i) v[i] = sum[i];
  }

 private:
  const int* slots_;
  int pairs_;
  double* values_;
  double factor_;
};

}  // namespace drape

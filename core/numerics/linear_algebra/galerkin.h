#pragma once

#include <memory>

#include "core/kernel/interfaces/prolongation_matrix.h"
#include "core/kernel/interfaces/topology.h"
#include "core/numerics/linear_algebra/block_matrix.h"

namespace drape {

/// Galerkin product A_c = Pᵀ A_f P of a block matrix with a scalar prolongation, planned once. Every coarse
/// block is a fixed weighted sum of fine blocks, so each product is one pass over them.
class GalerkinProduct {
 public:
  GalerkinProduct(const BlockPattern& fine, const ProlongationMatrix& weights);

  const std::shared_ptr<const BlockPattern>& coarse_pattern() const { return coarse_; }
  /// coarse = Pᵀ fine P; `coarse` must be over coarse_pattern().
  void form(const BlockMatrix& fine, BlockMatrix& coarse) const;

 private:
  std::shared_ptr<const BlockPattern> coarse_;
  struct Term {
    int source;  // fine block, bitwise complemented if transposed
    double weight;
  };
  Grouped<Term> terms_;  // of each coarse block
};

}  // namespace drape

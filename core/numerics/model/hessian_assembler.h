#pragma once

#include <memory>
#include <vector>

#include "core/kernel/interfaces/energy.h"
#include "core/kernel/interfaces/topology.h"
#include "core/numerics/linear_algebra/block_matrix.h"

namespace drape {

/// The Hessian of the energies' sum at x (n×3) [N/m], projected per element, in a pattern of its own.
BlockMatrix hessian_of(const std::vector<const BoundEnergy*>& energies, const Positions& x,
                       Projection projection);
inline BlockMatrix hessian_of(const BoundEnergy& energy, const Positions& x, Projection projection) {
  return hessian_of(std::vector{&energy}, x, projection);
}

/// Adds the Hessians of limits, penalties and contacts to a smooth matrix whose pattern stays.
///
/// A new pattern costs the solver a new symbolic analysis, so the pattern changes only when an element needs
/// a block that is missing. It is then padded around the new contacts, where they will slide next, and blocks
/// that were unused for 20 calls are dropped.
class HessianAssembler {
 public:
  /// Blocks that the pattern has beyond the smooth matrix. They depend on all earlier calls.
  struct ExtraPattern {
    std::vector<std::pair<int, int>> blocks;  ///< i < j, ascending
    std::vector<int> idle;                    ///< calls since each block was last needed
  };
  const ExtraPattern& extra() const { return extra_; }
  /// Adopts these extra blocks over `base`, the pattern of the smooth matrix. Returns the whole pattern.
  const std::shared_ptr<const BlockPattern>& restore(const std::shared_ptr<const BlockPattern>& base,
                                                     ExtraPattern extra);

  /// smooth + Σ Hessians at x (n×3) [N/m]. Stencils of `persistent` energies must stay the same from call to
  /// call, those of `transient` ones may change. Returns `smooth` itself if its pattern has all blocks.
  const BlockMatrix& add(BlockMatrix& smooth, const std::vector<const BoundEnergy*>& persistent,
                         const std::vector<const BoundEnergy*>& transient, const Positions& x,
                         Projection projection);

 private:
  void reset(const std::shared_ptr<const BlockPattern>& base);
  void build_pattern();
  /// Makes matrix_ the smooth matrix in the whole pattern. Blocks are cleared or copied in one pass, and
  /// their memory is kept.
  void copy_to_whole(const BlockMatrix& smooth);
  void grow_pattern(const std::shared_ptr<const BlockPattern>& base, const std::vector<Stencils>& stencils);

  std::shared_ptr<const BlockPattern> base_;     // of the smooth matrix
  std::shared_ptr<const BlockPattern> pattern_;  // base_ and the extra blocks; base_ itself without any
  std::vector<BlockSlots> persistent_slots_;
  BlockMatrix matrix_;
  ExtraPattern extra_;
  AdjacencyList neighbours_;  // in base_; without rows until they are needed
};

}  // namespace drape

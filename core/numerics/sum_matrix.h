#pragma once

#include <memory>
#include <vector>

#include "core/model/energy.h"
#include "core/numerics/block_matrix.h"

namespace drape {

/// The sum of a matrix over a pattern that stays and of energies whose elements come and go. Every change of
/// its own pattern costs the solver a new analysis, so that it changes seldom: when elements need room that
/// it has not, it gets room around them too, where contacts slide to next, and loses what lay idle for long.
class SumMatrix {
 public:
  /// What its pattern has beyond the smooth matrix', which depends on all that it had room for before.
  struct Room {
    std::vector<std::pair<int, int>> blocks;  ///< i < j, ascending
    std::vector<int> idle;                    ///< of each block: calls since it was last needed
  };
  const Room& room() const { return room_; }
  /// Has this room over the pattern of the smooth matrix; the pattern with it.
  const std::shared_ptr<const BlockPattern>& restore(const std::shared_ptr<const BlockPattern>& base,
                                                     Room room);

  /// smooth + Σ Hessians at x. `lasting` energies keep their stencils from call to call, `passing` ones need
  /// not. The result is `smooth` itself where that has room for everything.
  const BlockMatrix& add(BlockMatrix& smooth, const std::vector<const BoundEnergy*>& lasting,
                         const std::vector<const BoundEnergy*>& passing, const Positions& x,
                         Projection projection);

 private:
  void begin_over(const std::shared_ptr<const BlockPattern>& base);
  void lay_out();
  void make_room(const std::shared_ptr<const BlockPattern>& base, const std::vector<Stencils>& stencils);

  std::shared_ptr<const BlockPattern> base_;     // of `smooth`
  std::shared_ptr<const BlockPattern> pattern_;  // at least base_
  std::vector<int> place_;                       // of each block of base_ in pattern_; empty if the same
  std::vector<std::unique_ptr<BlockSlots>> lasting_slots_;
  BlockMatrix matrix_;
  Room room_;                                 // blocks of pattern_ that base_ has not
  std::vector<std::vector<int>> neighbours_;  // of each vertex in base_, itself included
};

}  // namespace drape

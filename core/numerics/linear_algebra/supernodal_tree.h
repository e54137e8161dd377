#pragma once

#include <cstddef>
#include <vector>

#include "core/kernel/interfaces/topology.h"
#include "core/numerics/linear_algebra/numeric_factor.h"

namespace drape {

/// Assembly tree of a supernodal factorisation of a matrix of 3×3 blocks: which vertices are eliminated
/// together, the order of elimination, and the memory layout. Depends on the pattern and the scalar only.
class SupernodalTree {
 public:
  /// Scalars that a front's panel and update matrix take up, by its numbers of vertices.
  struct FrontSizes {
    std::size_t (*panel)(int pivots, int updates);
    std::size_t (*update)(int updates);
  };

  SupernodalTree() = default;
  /// Supernodes are in postorder.
  SupernodalTree(Supernodes supernodes, FrontSizes sizes);

  int count() const { return static_cast<int>(first_.size()) - 1; }
  int first(int s) const { return first_[s]; }
  int pivots(int s) const { return first_[s + 1] - first_[s]; }
  const AdjacencyList& rows() const { return rows_; }
  /// Supernodes whose rows begin in s, ascending.
  const AdjacencyList& children() const { return children_; }
  /// Index of each row of s in its parent's front: among the parent's pivots, then its rows.
  const int* indices_in_parent(int s) const { return relative_.data() + rows_.start[s]; }

  /// Independent subtrees of similar work, largest first, as ranges of supernodes. They do not depend on the
  /// number of threads.
  struct Range {
    int begin, end;
  };
  const std::vector<Range>& subtrees() const { return subtrees_; }
  /// The supernodes above them, ascending.
  const std::vector<int>& top() const { return top_; }

  /// Offset of the panel of s, and size of all panels [scalars].
  std::size_t panel(int s) const { return panel_[s]; }
  std::size_t panel_size() const { return panel_.back(); }
  /// Offset of the update matrix of s, and size of the space that they share [scalars].
  std::size_t update(int s) const { return update_[s]; }
  std::size_t update_size() const { return update_size_; }

 private:
  void find_children();
  void cut();
  void place_updates(const std::vector<int>& part, FrontSizes sizes);

  std::vector<int> first_;
  AdjacencyList rows_, children_;
  std::vector<int> parent_, relative_;
  std::vector<Range> subtrees_;
  std::vector<int> top_;
  std::vector<std::size_t> panel_, update_;
  std::size_t update_size_ = 0;
};

}  // namespace drape

#pragma once

#include <cstddef>
#include <vector>

#include "core/mesh/topology.h"

namespace drape {

/// The symbolic side of a supernodal factorisation of a matrix of 3×3 blocks: which vertices are eliminated
/// together, what is passed on to whom, in which order, and where it is kept. Depends on the pattern alone.
class SupernodalTree {
 public:
  SupernodalTree() = default;
  /// Supernode s eliminates the places first[s] … first[s + 1] - 1; below them its columns have the `rows` of
  /// s, ascending. Supernodes are in postorder.
  SupernodalTree(std::vector<int> first, AdjacencyList rows);

  int count() const { return static_cast<int>(first_.size()) - 1; }
  int first(int s) const { return first_[s]; }
  int own(int s) const { return first_[s + 1] - first_[s]; }
  const AdjacencyList& rows() const { return rows_; }
  /// Supernodes whose rows begin in s, ascending.
  const AdjacencyList& children() const { return children_; }
  /// Where each of the rows of s is in its parent: index among the parent's own vertices, then its rows.
  const int* places_in_parent(int s) const { return relative_.data() + rows_.start[s]; }

  /// Independent subtrees, those with most work first, as ranges of supernodes. They are few, of similar
  /// work, and do not depend on the number of threads.
  struct Range {
    int begin, end;
  };
  const std::vector<Range>& subtrees() const { return subtrees_; }
  /// The supernodes above them, ascending.
  const std::vector<int>& top() const { return top_; }

  /// Doubles before the panel of s, and of all panels.
  std::size_t panel(int s) const { return panel_[s]; }
  std::size_t panel_size() const { return panel_.back(); }
  /// Doubles before the update matrix of s, and of the space that they share.
  std::size_t update(int s) const { return update_[s]; }
  std::size_t update_size() const { return update_size_; }

 private:
  void find_children();
  void cut();
  void place_updates(const std::vector<int>& part);

  std::vector<int> first_;
  AdjacencyList rows_, children_;
  std::vector<int> parent_, relative_;
  std::vector<Range> subtrees_;
  std::vector<int> top_;
  std::vector<std::size_t> panel_, update_;
  std::size_t update_size_ = 0;
};

}  // namespace drape

#pragma once

#include <optional>
#include <vector>

#include "core/app/experiment/experiment_parameters.h"
#include "core/kernel/interfaces/level.h"
#include "core/numerics/collision_detection/box_tree.h"

namespace drape {

/// Finds the vertices of a level that pins and handles select. Both levels must outlive it.
class VertexSearch {
 public:
  /// For about so many selections: many are found by trees, in a time that does not grow with both numbers.
  VertexSearch(const Level& level, const Level& coarsest, std::size_t count);
  /// The selected vertices, ascending. "nearest" selects the vertex of the coarsest level that is nearest to
  /// the point, and on finer levels its child, which has the same index.
  std::vector<int> selected(const VertexSelection& selection) const;

 private:
  /// Those among which the selected ones are, ascending.
  std::vector<int> candidates(const VertexSelection& selection) const;

  const Level &level_, &coarsest_;
  std::vector<int> border_;
  std::optional<BoxTree> tree_, coarse_tree_;
};

}  // namespace drape

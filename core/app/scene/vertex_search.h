#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/app/experiment/experiment_parameters.h"
#include "core/kernel/interfaces/level.h"
#include "core/numerics/collision_detection/point_tree.h"

namespace drape {

/// Finds the vertices of a level that pins and handles select. Both levels must outlive it.
class VertexSearch {
 public:
  /// `count` is about how many selections will be asked for; more than 16 are searched by trees.
  VertexSearch(const Level& level, const Level& coarsest, std::size_t count);
  /// The selected vertices, ascending. "nearest" selects the vertex of the coarsest level that is nearest to
  /// the point, and on other levels the vertex that stands for it.
  std::vector<int> selected(const VertexSelection& selection) const;

 private:
  /// A superset of the selected vertices, ascending.
  std::vector<int> candidates(const VertexSelection& selection) const;
  std::vector<int> selected_by_name(const VertexSelection& selection) const;

  const Level &level_, &coarsest_;
  std::vector<int> border_;
  PointTree tree_, coarse_tree_;                       // the second one only of another level
  std::map<std::string, std::vector<int>> triangles_;  // of each piece
  mutable std::map<std::array<std::string, 3>, std::vector<int>> named_;  // found by region, piece and label
};

}  // namespace drape

#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"
#include "core/numerics/sewing/divide_edges.h"

namespace drape {

/// A panel in its plane (z = 0), meshed; its first vertices are on its loops.
struct PanelMesh {
  TriangleMesh flat;
  std::vector<int>
      stitches;           ///< of the loops' vertices, the stitches of the edge that begins there; -1 for none
  std::vector<int> ends;  ///< of the loops' vertices, the stitches of the edge that ends there; -1 for none
  std::set<std::pair<int, int>> sewn;  ///< sides of the loops that are sewn, the smaller vertex first
  std::map<std::pair<int, int>, int>
      sides;  ///< edges of the panel by the two vertices of each side, as `sewn`
  int border() const { return static_cast<int>(stitches.size()); }
};

/// Meshes every panel. Appends the faults of outlines: with fewer than three points, or that cross or touch
/// themselves or one another, and holes outside.
std::vector<PanelMesh> mesh_panels(const Pattern& pattern, double edge_length,
                                   const std::vector<std::vector<EdgeDivision>>& divisions,
                                   ConfigErrors& errors);

}  // namespace drape

#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/numerics/patterns/generate.h"
#include "core/numerics/sewing/pattern.h"

namespace drape {

/// Where an edge of a panel is divided: lengths along it, its two ends included.
struct EdgeDivision {
  std::vector<double> lengths;  ///< ascending [m]
  std::vector<int> stitches;    ///< of each, the stitch that joins it to another edge's; -1 without one
};

/// The division of every edge, `[panel][edge]`, at about `edge_length`. The two sides of a seam have the same
/// stitches, numbered over the whole pattern, as close as the longer side needs them; a chain of edges is
/// divided where an edge of the other chain ends. Appends the faults of seams that cannot be sewn: an edge
/// that is in two of them, and sides whose lengths differ by more than the seam's ease.
std::vector<std::vector<EdgeDivision>> divide_edges(const Pattern& pattern, double edge_length,
                                                    ConfigErrors& errors);

/// Meshes the region within loops of points with triangles of about `edge_length` [m]: the loops' points are
/// the first vertices, in their order, and no vertex is added between them. No two sides of the loops may
/// meet but at their ends, and every hole lies in the first loop. A mirrored region has a mirrored mesh.
TriangleMesh mesh_panel(const std::vector<Polygon>& loops, double edge_length);

/// Whether a point lies in the loop, by the parity of its sides on one side of the point.
bool is_inside(const Polygon& loop, const Eigen::Vector2d& point);

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

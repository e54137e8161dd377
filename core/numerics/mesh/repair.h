#pragma once

#include <string>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// Numbers of what repair_mesh found.
struct MeshRepair {
  /// Dropped.
  int loose_vertices = 0, doubled_triangles = 0, empty_triangles = 0;
  /// Kept: contact takes them as they are.
  int crowded_edges = 0, inverted_edges = 0, shared_vertices = 0;

  /// "dropped 3 loose vertices, 1 doubled and 1 empty triangle; kept 2 edges with more than two triangles";
  /// empty if there was nothing.
  std::string text() const;
};

/// A mesh, and how it was repaired.
struct RepairedMesh {
  std::vector<TriangleMesh> frames;  ///< one, or those of an animation, with the same triangles
  MeshRepair done;
};

/// Drops the vertices of no triangle, the triangles that repeat another or have no area, and numbers the rest
/// anew in their order. `frames` are one mesh or several with the same triangles, which lose the same
/// elements. Throws std::runtime_error if an index is out of range, no triangle is left, or a triangle has an
/// area in some frames only.
RepairedMesh repair_mesh(std::vector<TriangleMesh> frames);

/// A closed surface, free of self-intersections, at a distance of `offset` [m] around a mesh. It closes holes
/// that a ball of radius `alpha` [m] cannot enter (Portaneri et al. 2022, by CGAL).
TriangleMesh alpha_wrap(const TriangleMesh& mesh, double alpha, double offset);

}  // namespace drape

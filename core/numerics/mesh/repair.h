#pragma once

#include <string>
#include <vector>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// A mesh, and how it was repaired.
struct RepairedMesh {
  std::vector<TriangleMesh> frames;  ///< one, or those of an animation, with the same triangles
  /// "joined 2 vertices at the places of others; dropped 1 doubled triangle; kept 2 edges with more than two
  /// triangles", of which contact takes those kept as they are; empty if there was nothing.
  std::string remark;
};

/// Joins the vertices that are at one place, drops the vertices of no triangle, the triangles that repeat
/// another or have no area, and renumbers the rest in their order. `frames` are one mesh or several with
/// the same triangles, which lose the same elements; indices are in range, as in what read_mesh reads. Throws
/// std::runtime_error if no triangle is left or a triangle has an area in some frames only.
RepairedMesh repair_mesh(std::vector<TriangleMesh> frames);

/// A closed surface, free of self-intersections, at a distance of `offset` [m] around a mesh. It closes holes
/// that a ball of radius `alpha` [m] cannot enter (Portaneri et al. 2022, by CGAL).
TriangleMesh alpha_wrap(const TriangleMesh& mesh, double alpha, double offset);

}  // namespace drape

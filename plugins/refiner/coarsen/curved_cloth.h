#pragma once

#include "core/kernel/interfaces/level.h"
#include "core/kernel/interfaces/prolongation_matrix.h"

namespace drape {

/// A coarser mesh of a surface that is curved at rest.
struct CoarseSurface {
  std::vector<int> vertices;   ///< of the fine mesh, ascending
  Triangles triangles;         ///< of the fine mesh's vertices
  ProlongationMatrix weights;  ///< of the projection of each fine vertex to the plane of a triangle near it

  /// Removes the vertex whose triangles are the smallest, by the density of the mesh, again and again until
  /// 1/ratio of the vertices is left; corners of borders stay. The hole of a vertex is triangulated by
  /// Delaunay's criterion in polar coordinates around it.
  static CoarseSurface of(const Level& fine, double ratio);
};

}  // namespace drape

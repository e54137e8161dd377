#pragma once

#include <optional>
#include <vector>

#include "core/kernel/interfaces/topology.h"

namespace drape {

/// The texture coordinates of split_triangles: linear within each coarse triangle, so a seam keeps both of
/// its sides. Without rows if there are none.
CornerUv split_uv(const CornerUv& coarse);

/// A mesh's vertices, split so that each has one pair of texture coordinates. The first of a vertex keeps its
/// index, further ones follow the last vertex.
struct UvVertices {
  using Coordinates = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

  std::vector<int> vertex;  ///< the mesh's vertex of each
  Coordinates uv;           ///< one row each, v upwards; without rows if the mesh has none
  Triangles triangles;      ///< m×3

  /// Rows of the mesh's vertices (n×3) for these.
  Positions of(const Positions& rows) const { return rows(vertex, Eigen::all); }
};
UvVertices split_at_seams(const TriangleMesh& mesh);

/// The same of flat pieces that lie side by side in rows, in about a square, each with its size and direction
/// [m].
UvVertices laid_out(TriangleMesh cloth);

/// Texture coordinates for a flat mesh that has none of its own: coordinates in its plane over the longer
/// side of its box there, so from 0 to 1 and without distortion. Seen from the mesh's front, v points up:
/// along z, or along y where the plane is nearer to horizontal.
struct PlanarUv {
  Eigen::Matrix<double, 2, 3> axes;  ///< u and v [1/m]
  Eigen::Vector2d origin;            ///< at u = v = 0

  /// Texture coordinates of a mesh with triangles; nothing if a vertex is farther from the plane than a
  /// thousandth of the mesh's diagonal.
  static std::optional<PlanarUv> of(const TriangleMesh& mesh);
  CornerUv at(const TriangleMesh& mesh) const;
};

}  // namespace drape

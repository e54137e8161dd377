#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace drape {

/// n×3 vertex positions, one row a vertex [m]. Row-major so that one vertex is contiguous.
using Positions = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Box around the positions that are finite; empty without any.
inline Eigen::AlignedBox3d bounding_box(const Positions& x) {
  Eigen::AlignedBox3d box;
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    if (x.row(i).allFinite()) box.extend(x.row(i).transpose());
  return box;
}
/// Diagonal of the positions' bounding box, n ≥ 1 [m].
inline double bounding_box_diagonal(const Positions& x) {
  return (x.colwise().maxCoeff() - x.colwise().minCoeff()).norm();
}

/// m×3 vertex indices, one row a triangle, counter-clockwise.
using Triangles = Eigen::Matrix<int, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// m×6 texture coordinates u, v of the three corners of each triangle, v upwards. Corners at one vertex that
/// differ make a seam.
using CornerUv = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

/// Vertices and triangles; a plain value.
struct TriangleMesh {
  Positions vertices;   ///< n×3 [m]
  Triangles triangles;  ///< m×3
  CornerUv uv = {};     ///< m×6, or without rows
  Positions warp = {};  ///< m×3 unit vectors along a cloth's warp in its triangles; without rows, along x
};

/// A named scalar per vertex.
struct VertexField {
  std::string name;        ///< not empty, no white space; each of a mesh its own, none x, y or z
  Eigen::VectorXd values;  ///< n
};
using VertexFields = std::vector<VertexField>;

/// m×3 normals of the triangles, of the length of twice the area [m²].
inline Positions area_vectors(const TriangleMesh& mesh) {
  Positions areas(mesh.triangles.rows(), 3);
  for (Eigen::Index t = 0; t < areas.rows(); ++t) {
    const Eigen::RowVector3d a = mesh.vertices.row(mesh.triangles(t, 0));
    areas.row(t) =
        (mesh.vertices.row(mesh.triangles(t, 1)) - a).cross(mesh.vertices.row(mesh.triangles(t, 2)) - a);
  }
  return areas;
}

}  // namespace drape

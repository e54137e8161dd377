#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <optional>
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

/// m×6 texture coordinates u, v of each triangle's corners, v upwards; a seam where those of a vertex differ.
using CornerUv = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>;

/// How a cloth of flat pieces rests: each triangle as its texture coordinates lie in the plane.
struct Sewing {
  double uv_length = 1;       ///< of one unit of the texture coordinates [m]
  double seam_angle = 0;      ///< dihedral angle of folds along seams at rest [rad]
  double seam_stiffness = 1;  ///< factor on the stiffness of these folds [1]
};

/// Vertices and triangles; a plain value.
struct TriangleMesh {
  Positions vertices;                 ///< n×3 [m]
  Triangles triangles;                ///< m×3
  CornerUv uv = {};                   ///< m×6, or without rows
  Positions warp = {};                ///< m×3 unit vectors along warp in rest_corners; without rows, along x
  std::optional<Sewing> sewing = {};  ///< of a cloth of flat pieces, which has uv
  std::vector<int> piece = {};        ///< m indices of piece_names; or empty, as those are
  std::vector<std::string> piece_names = {};
};

/// The corners of triangle t at rest, one a column [m]: in space, or in its flat piece, where z = 0.
inline Eigen::Matrix3d rest_corners(const TriangleMesh& mesh, Eigen::Index t) {
  Eigen::Matrix3d corners = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 3; ++k)
    if (mesh.sewing)
      corners.col(k).head<2>() = mesh.sewing->uv_length * mesh.uv.block<1, 2>(t, 2 * k).transpose();
    else
      corners.col(k) = mesh.vertices.row(mesh.triangles(t, k)).transpose();
  return corners;
}

/// A named scalar per vertex.
struct VertexField {
  std::string name;        ///< not empty, no white space; each of a mesh its own, none x, y or z
  Eigen::VectorXd values;  ///< n
};
using VertexFields = std::vector<VertexField>;

}  // namespace drape

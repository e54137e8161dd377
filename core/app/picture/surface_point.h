#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

using Ray = Eigen::ParametrizedLine<float, 3>;

/// Where a ray first meets a surface. Normals point to the side that the ray comes from.
struct SurfacePoint {
  enum class Surface { cloth, obstacle, floor };
  Surface surface = Surface::cloth;
  bool front = true;   ///< whether the ray meets the side where the triangle runs counter-clockwise
  float distance = 0;  ///< along the ray
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< relative to the scene's centre [m]
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< interpolated between the vertices
  Eigen::Vector3f face_normal = Eigen::Vector3f::Zero();
  /// Where rays to lights start: off the smooth surface that the normals suggest.
  Eigen::Vector3f light_origin = Eigen::Vector3f::Zero();
  Eigen::Vector3f edge_distance = Eigen::Vector3f::Zero();  ///< across the ray, to the triangle's edges [m]
};

/// A mesh ready for rays: vertices relative to a scene's centre, and what is interpolated between them.
struct DrawnSurface {
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
  Rows x, normals;      ///< n×3
  Triangles triangles;  ///< those whose vertices are all finite

  DrawnSurface() = default;
  /// With n×3 unit normals.
  DrawnSurface(const TriangleMesh& mesh, const Eigen::Vector3d& centre, const Positions& normals);

  /// The point with barycentric coordinates (1 - u - v, u, v) of a triangle, met by a ray.
  SurfacePoint point(int triangle, float u, float v, const Ray& ray) const;
};

}  // namespace drape

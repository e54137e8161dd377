#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "core/app/picture/render.h"

struct RTCDeviceTy;  // of Embree
struct RTCSceneTy;

namespace drape {

using Ray = Eigen::ParametrizedLine<float, 3>;

/// What is seen along a ray. Normals point to the side that the ray comes from.
struct Seen {
  enum class Surface { nothing, cloth, obstacle, floor };
  Surface surface = Surface::nothing;
  bool front = true;  ///< whether the ray meets the side where the triangle runs counter-clockwise
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  ///< relative to the scene's centre [m]
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();    ///< interpolated between the vertices
  float facing = 1;  ///< cosine of the angle between the normal and the way back
};

/// Where a ray first meets a surface.
struct SurfacePoint : Seen {
  float distance = 0;  ///< along the ray
  int triangle = 0;    ///< of its mesh
  Eigen::Vector3f face_normal = Eigen::Vector3f::Zero();
  /// Where rays to lights start: off the smooth surface that the normals suggest.
  Eigen::Vector3f light_origin = Eigen::Vector3f::Zero();
  Eigen::Vector3f edge_distance = Eigen::Vector3f::Zero();  ///< across the ray, to the triangle's edges [m]
};

/// A mesh whose triangles share no vertices, and its normals, n×3, unit length: smooth, but not across edges
/// with more than 40° between their triangles' normals.
TriangleMesh split_at_creases(const TriangleMesh& mesh, Positions& normals);

/// A drawing's surfaces, ready for rays (Embree). Ray queries may run on any number of threads.
class RayScene {
 public:
  /// Throws std::runtime_error if Embree fails.
  explicit RayScene(const Drawing& drawing);

  /// From a camera's eye through a place in its picture, −1 … 1 to the right and up. Coordinates of rays are
  /// relative to the scene's centre: single precision holds offsets from it only [m].
  Ray through(const Camera& camera, double right, double up) const;

  std::optional<SurfacePoint> nearest(const Ray& ray) const;
  /// As nearest, as if there were the obstacles alone.
  std::optional<SurfacePoint> nearest_obstacle(const Ray& ray) const;
  /// Whether cloth or an obstacle is in a ray's way.
  bool blocked(const Ray& ray, float length = std::numeric_limits<float>::infinity()) const;

 private:
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;
  struct Surface {
    Rows x, normals;  // n×3: vertices relative to the centre [m], unit normals
    Triangles triangles;
    SurfacePoint point(int triangle, float u, float v, const Ray& ray) const;
  };

  void add(const TriangleMesh& mesh, const Positions& normals);
  std::optional<SurfacePoint> hit(RTCSceneTy* scene, const Ray& ray) const;

  std::shared_ptr<RTCDeviceTy> device_;
  std::shared_ptr<RTCSceneTy> all_, obstacles_;
  std::vector<Surface> surfaces_;  // cloth, then obstacles
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  float radius_ = 0;  // of a sphere around the centre that holds cloth and obstacles [m]
  std::optional<float> floor_;
};

}  // namespace drape

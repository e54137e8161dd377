#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>

#include "core/app/picture/render.h"
#include "core/app/picture/surface_point.h"

namespace drape {

/// A drawing's surfaces, ready for rays (Embree). Ray queries may run on any number of threads.
class RayScene {
 public:
  /// Throws std::runtime_error if Embree fails.
  explicit RayScene(const Drawing& drawing);
  ~RayScene();

  /// Origin of the coordinates of rays: single precision holds offsets from it only [m].
  const Eigen::Vector3d& centre() const { return centre_; }

  std::optional<SurfacePoint> nearest(const Ray& ray) const;
  /// As nearest, as if there were the obstacle alone.
  std::optional<SurfacePoint> nearest_obstacle(const Ray& ray) const;
  /// Whether cloth or obstacle is in a ray's way.
  bool blocked(const Ray& ray) const;

 private:
  struct Embree;
  std::unique_ptr<Embree> embree_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  float radius_ = 0;  // of a sphere around the centre that holds cloth and obstacle [m]
  std::optional<float> floor_;
};

}  // namespace drape

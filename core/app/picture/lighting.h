#pragma once

#include <Eigen/Core>

#include "core/app/picture/ray_scene.h"
#include "core/app/picture/render.h"

namespace drape {

using Rgb = Eigen::Array3f;  ///< linear light

Rgb linear_of_srgb(const Eigen::Vector3f& colour);
unsigned char srgb_byte(float linear);

/// The shares of the key light and of the sky light that arrive.
using Arriving = Eigen::Array2f;

/// A warm key light of some width from the upper left of the picture, a faint fill light from the right, and
/// a sky that is brighter above than below.
class Lighting {
 public:
  /// Keeps a reference to the scene.
  Lighting(const RayScene& scene, const Camera& camera);

  /// From what a ray from the eye meets back to the eye; nothing and the lit floor are one backdrop.
  Rgb to_eye(const Seen& seen, const Arriving& arriving) const;
  /// By one random ray to each light, for a place in the grid of samples.
  Arriving arriving(const SurfacePoint& point, int column, int row) const;

 private:
  const RayScene& scene_;
  Eigen::Vector3f key_, fill_;  // towards the lights
};

}  // namespace drape

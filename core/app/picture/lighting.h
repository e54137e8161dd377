#pragma once

#include <Eigen/Core>

#include "core/app/picture/ray_scene.h"
#include "core/app/picture/render.h"

namespace drape {

using Rgb = Eigen::Array3f;  ///< linear light

Rgb linear_of_srgb(const Eigen::Vector3f& colour);
unsigned char srgb_byte(float linear);

/// Light from a surface to the eye if nothing is in the lights' way, by the light that it came from.
struct Light {
  Rgb key = Rgb::Zero(), sky = Rgb::Zero(), other = Rgb::Zero();
};

/// The shares of the key light and of the sky light that arrive.
using Arriving = Eigen::Array2f;

/// A warm key light of some width from the upper left of the picture, a faint fill light from the right, and
/// a sky that is brighter above than below.
class Lighting {
 public:
  /// Keeps a reference to the scene.
  Lighting(const RayScene& scene, const Camera& camera);

  /// From a point to the eye, which the ray comes from.
  Light at(const SurfacePoint& point, const Ray& ray) const;
  /// By one ray to each light, through sample points in [0, 1)².
  Arriving arriving(const SurfacePoint& point, const Eigen::Vector2f& key_sample,
                    const Eigen::Vector2f& sky_sample) const;

  /// What is seen where there is nothing, and of what the floor is.
  static Rgb backdrop();

 private:
  float sky_arriving(const SurfacePoint& point, const Eigen::Vector2f& sample) const;

  const RayScene& scene_;
  Eigen::Vector3f key_, key_u_, key_v_, fill_;  // towards the lights, and across the key light
};

}  // namespace drape

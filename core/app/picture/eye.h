#pragma once

#include <Eigen/Core>

#include "core/app/picture/render.h"
#include "core/app/picture/surface_point.h"

namespace drape {

/// A camera's rays in the coordinates of a scene.
class Eye {
 public:
  Eye(const Camera& camera, const Eigen::Vector3d& centre, int width, int height)
      : camera_(camera), centre_(centre), width_(width), height_(height) {}

  /// Through a place in the picture [pixels, from the upper left].
  Ray through(float column, float row) const {
    const Eigen::Vector3d ahead((2 * column / width_ - 1) * camera_.tangent[0],
                                (1 - 2 * row / height_) * camera_.tangent[1], -1);
    const auto world = camera_.frame.transpose();
    return {(world * camera_.eye - centre_).cast<float>(), (world * ahead).normalized().cast<float>()};
  }

  /// The size of a pixel that faces the eye at a point [m].
  float pixel_size(const Eigen::Vector3f& x) const {
    const double depth = camera_.seen(x.cast<double>() + centre_)[2];
    return static_cast<float>(2 * camera_.tangent[1] / height_ * depth);
  }

 private:
  const Camera& camera_;
  const Eigen::Vector3d centre_;
  int width_, height_;
};

}  // namespace drape

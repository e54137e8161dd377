#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/app/picture/ray_scene.h"
#include "core/app/picture/render.h"

namespace drape {

/// A camera's rays in the coordinates of a scene.
class Eye {
 public:
  Eye(const Camera& camera, const Eigen::Vector3d& centre, int width, int height)
      : width_(width), height_(height) {
    Eigen::Matrix4d clip = camera.projection * camera.view;
    clip.col(3) += clip.leftCols<3>() * centre;
    to_world_ = clip.inverse();
    depth_ = clip.row(3).cast<float>();
    pixel_size_ = static_cast<float>(2 / (camera.projection(1, 1) * height));
  }

  /// Through a place in the picture [pixels, from the upper left].
  Ray through(float column, float row) const {
    const double u = 2 * column / width_ - 1, v = 1 - 2 * row / height_;
    const Eigen::Vector4d near = to_world_ * Eigen::Vector4d(u, v, -1, 1);
    const Eigen::Vector4d far = to_world_ * Eigen::Vector4d(u, v, 1, 1);
    const Eigen::Vector3d origin = near.head<3>() / near[3];
    return {origin.cast<float>(), (far.head<3>() / far[3] - origin).normalized().cast<float>()};
  }

  /// The size of a pixel that faces the eye at a point [m].
  float pixel_size(const Eigen::Vector3f& x) const {
    return pixel_size_ * (depth_.head<3>().dot(x) + depth_[3]);
  }

 private:
  int width_, height_;
  Eigen::Matrix4d to_world_;  // from clip coordinates
  Eigen::RowVector4f depth_;
  float pixel_size_;
};

}  // namespace drape

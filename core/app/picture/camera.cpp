#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/app/picture/render.h"

namespace drape {

Camera Camera::around(const std::vector<const Positions*>& states, const Eigen::Vector3d& direction,
                      double aspect) {
  constexpr double half_angle_tangent = 0.22;  // of the vertical field of view, 25°: little distortion
  constexpr double margin = 1.06;              // of the picture's size to the cloth's
  Camera camera;
  Eigen::Matrix3d& frame = camera.frame;
  frame.row(2) = direction.normalized();
  const bool along_z = std::abs(frame(2, 2)) > 0.9999;
  frame.row(0) = Eigen::Vector3d::Unit(along_z ? 1 : 2).cross(frame.row(2).transpose()).normalized();
  frame.row(1) = frame.row(2).cross(frame.row(0));
  camera.tangent = {half_angle_tangent * aspect, half_angle_tangent};
  const Eigen::Vector2d tangent = camera.tangent / margin;

  // The eye slides in its own frame until the tightest points on opposite sides touch opposite borders:
  // |u − eye_u| ≤ (eye_w − w)·tan for all points, and the same for v.
  constexpr double none = -std::numeric_limits<double>::infinity();
  Eigen::Array2d low(none, none), high = low;
  Eigen::AlignedBox3d box;
  for (const Positions* x : states)
    for (Eigen::Index i = 0; i < x->rows(); ++i) {
      const Eigen::Vector3d p = frame * x->row(i).transpose();
      if (!p.allFinite()) continue;
      box.extend(p);
      const Eigen::Array2d place = p.head<2>().array() / tangent.array();
      high = high.max(place + p[2]);
      low = low.max(p[2] - place);
    }
  if (box.isEmpty()) return camera;
  const double size = std::max(box.diagonal().norm(), 1e-6);
  camera.eye.head<2>() = (high - low) / 2 * tangent.array();
  camera.eye[2] = std::max(((high + low) / 2).maxCoeff(), box.max()[2] + 1e-3 * size);
  return camera;
}

}  // namespace drape

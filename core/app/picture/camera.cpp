#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/app/picture/render.h"

namespace drape {

namespace {

constexpr double half_angle_tangent = 0.22;  // of the vertical field of view, 25°: little distortion
constexpr double margin = 1.06;              // of the picture's size to the cloth's

/// What is up in a picture: z, unless the camera looks along it.
Eigen::Vector3d up_of(const Eigen::Vector3d& towards) {
  const bool along_z = std::abs(towards.normalized()[2]) > 0.9999;
  return along_z ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
}

/// Rows: right, up and towards the camera.
Eigen::Matrix3d camera_frame(const Eigen::Vector3d& towards, const Eigen::Vector3d& up) {
  Eigen::Matrix3d frame;
  frame.row(2) = towards.normalized();
  frame.row(0) = up.cross(frame.row(2).transpose()).normalized();
  frame.row(1) = frame.row(2).cross(frame.row(0));
  return frame;
}

Eigen::AlignedBox3d bounds_in(const Eigen::Matrix3d& frame, const std::vector<const Positions*>& states) {
  Eigen::AlignedBox3d box;
  for (const Positions* x : states) {
    for (Eigen::Index i = 0; i < x->rows(); ++i) {
      const Eigen::Vector3d p = frame * x->row(i).transpose();
      if (p.allFinite()) box.extend(p);
    }
  }
  if (box.isEmpty()) box.extend(Eigen::Vector3d::Zero());
  return box;
}

Eigen::Matrix4d view_matrix(const Eigen::Matrix3d& frame, const Eigen::Vector3d& eye) {
  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
  view.topLeftCorner<3, 3>() = frame;
  view.topRightCorner<3, 1>() = -eye;
  return view;
}

}  // namespace

Camera Camera::around(const std::vector<const Positions*>& states, const Eigen::Vector3d& direction,
                      double aspect) {
  const Eigen::Matrix3d frame = camera_frame(direction, up_of(direction));
  const Eigen::AlignedBox3d box = bounds_in(frame, states);
  const double tangent_v = half_angle_tangent / margin, tangent_u = tangent_v * aspect;

  // The eye slides in its own frame until the tightest points on opposite sides touch opposite borders:
  // |u − eye_u| ≤ (eye_w − w)·tan for all points, and the same for v.
  double low_u = -1e300, high_u = -1e300, low_v = -1e300, high_v = -1e300;
  for (const Positions* x : states) {
    for (Eigen::Index i = 0; i < x->rows(); ++i) {
      const Eigen::Vector3d p = frame * x->row(i).transpose();
      if (!p.allFinite()) continue;
      high_u = std::max(high_u, p[0] / tangent_u + p[2]);
      low_u = std::max(low_u, -p[0] / tangent_u + p[2]);
      high_v = std::max(high_v, p[1] / tangent_v + p[2]);
      low_v = std::max(low_v, -p[1] / tangent_v + p[2]);
    }
  }
  const double size = std::max(box.diagonal().norm(), 1e-6);
  const bool empty = high_u < -1e299;
  const double distance = empty ? size : std::max((high_u + low_u) / 2, (high_v + low_v) / 2);
  Eigen::Vector3d eye(0, 0, std::max(distance, box.max()[2] + 1e-3 * size));
  if (!empty) {
    eye[0] = (high_u - low_u) / 2 * tangent_u;
    eye[1] = (high_v - low_v) / 2 * tangent_v;
  }

  const double near = std::max(eye[2] - box.max()[2], 1e-3 * size) * 0.9;
  const double far = (eye[2] - box.min()[2]) * 1.1 + 1e-3 * size;
  Camera camera{view_matrix(frame, eye), Eigen::Matrix4d::Zero()};
  camera.projection(0, 0) = 1 / (half_angle_tangent * aspect);
  camera.projection(1, 1) = 1 / half_angle_tangent;
  camera.projection(2, 2) = -(far + near) / (far - near);
  camera.projection(2, 3) = -2 * far * near / (far - near);
  camera.projection(3, 2) = -1;
  return camera;
}

}  // namespace drape

#pragma once

#include <Eigen/Core>
#include <string>

namespace drape {

enum class SolidKind { sphere, box, capsule, cylinder, half_space };

/// The distance to a solid around one point: value, gradient and the two principal curvatures of its level
/// set. The distance's Hessian is curvature[0] a aᵀ + curvature[1] b bᵀ, a = tangent, b = normal × tangent.
struct Nearest {
  double distance = 0;                                  ///< [m]; negative inside
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();    ///< away from the solid
  Eigen::Vector3d tangent = Eigen::Vector3d::UnitX();   ///< unit, at right angles to it
  Eigen::Vector2d curvature = Eigen::Vector2d::Zero();  ///< [1/m], ≥ 0
};

/// A convex obstacle. Spheres and capsules are a box without extent across, made round by `radius`; the
/// distance to each is continuously differentiable outside.
struct Solid {
  SolidKind kind = SolidKind::sphere;
  std::string name;                                    ///< "ball: sphere"
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< [m]; a point of a half-space's plane
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns; z is the axis or the plane's normal
  Eigen::Vector3d half = Eigen::Vector3d::Zero();      ///< half extents of the core [m]
  double radius = 0;                                   ///< of the rounding, or the cylinder's [m]
  double friction = 0;                                 ///< μ
  Eigen::Vector3d turn = Eigen::Vector3d::Zero();      ///< what the axes are made of [degree], or …
  Eigen::Vector3d plane = Eigen::Vector3d::UnitZ();    ///< … of a half-space, its normal, of any length

  Eigen::Vector3d to_local(const Eigen::Vector3d& p) const { return axes.transpose() * (p - centre); }
  Eigen::Vector3d to_world(const Eigen::Vector3d& q) const { return centre + axes * q; }

  /// Makes the axes.
  void orient();

  /// Distance, gradient and curvature at p.
  Nearest nearest(const Eigen::Vector3d& p) const;
  /// The distance alone.
  double distance(const Eigen::Vector3d& p) const;
  /// max n · y over the solid, n a unit vector; +∞ where a half-space has none.
  double support(const Eigen::Vector3d& n) const;
  /// The parameter t ∈ [0, 1] at which a + t (b - a) is nearest (one of them, if there are many).
  double nearest_on_edge(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
};

}  // namespace drape

#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <string>

#include "core/numerics/collision_detection/signed_distance.h"

namespace drape::shapes {

enum class SolidKind { sphere, box, capsule, cylinder, half_space };

/// Calls the function for the form of a kind. For a kind of another form add a parameter: no use compiles
/// then until it has a function for it.
template <class RoundedBox, class Cylinder, class HalfSpace>
auto by_form(SolidKind kind, const RoundedBox& rounded_box, const Cylinder& cylinder,
             const HalfSpace& half_space) {
  switch (kind) {
    case SolidKind::sphere:
    case SolidKind::box:
    case SolidKind::capsule:
      return rounded_box();
    case SolidKind::cylinder:
      return cylinder();
    case SolidKind::half_space:
      return half_space();
  }
  throw std::logic_error("a solid of no kind");
}

/// A convex obstacle. A box, sphere or capsule is a core box, possibly degenerate, rounded by `radius`. The
/// distance is continuously differentiable outside.
struct Solid {
  SolidKind kind = SolidKind::sphere;
  std::string name;                                    ///< "ball: sphere"
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();    ///< [m]; a point of a half-space's plane
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns; z is the axis or the plane's normal
  Eigen::Vector3d half = Eigen::Vector3d::Zero();      ///< half extents of the core [m]
  double radius = 0;                                   ///< of the rounding, or the cylinder's [m]
  double friction = 0;                                 ///< μ
  Eigen::Vector3d rotate = Eigen::Vector3d::Zero();  ///< angles of the axes about x, then y, then z [degree]
  Eigen::Vector3d plane = Eigen::Vector3d::UnitZ();  ///< normal of a half-space, of any length

  Eigen::Vector3d to_local(const Eigen::Vector3d& p) const { return axes.transpose() * (p - centre); }
  Eigen::Vector3d to_world(const Eigen::Vector3d& q) const { return centre + axes * q; }

  /// Sets the axes from `rotate`, or from `plane` for a half-space.
  void update_axes();

  /// Signed distance, gradient and curvatures at p.
  SignedDistance nearest(const Eigen::Vector3d& p) const;
  /// The signed distance at p [m].
  double distance(const Eigen::Vector3d& p) const;
  /// The support function max n · y over the solid for a unit vector n [m]; +∞ if unbounded.
  double support(const Eigen::Vector3d& n) const;
  /// A parameter t in [0, 1] at which a + t (b - a) is nearest.
  double nearest_on_edge(const Eigen::Vector3d& a, const Eigen::Vector3d& b) const;
};

}  // namespace drape::shapes

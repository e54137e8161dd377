#pragma once

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <memory>
#include <vector>

#include "plugins/contact/shapes/shapes.h"

// Solids that tests of shapes share.

namespace drape::shapes {

inline constexpr double dhat = 1e-3, kappa = 20;

/// The plugin's own conversion is tested through the model; here the solid is made by hand.
inline Solid solid_of(const ShapeParameters& p) {
  Solid s;
  s.kind = p.shape;
  s.centre = p.translate;
  const Eigen::Vector3d angle = p.rotate * (M_PI / 180);
  s.axes = (Eigen::AngleAxisd(angle.z(), Eigen::Vector3d::UnitZ()) *
            Eigen::AngleAxisd(angle.y(), Eigen::Vector3d::UnitY()) *
            Eigen::AngleAxisd(angle.x(), Eigen::Vector3d::UnitX()))
               .toRotationMatrix();
  if (p.shape == SolidKind::half_space)
    s.axes = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), p.normal).toRotationMatrix();
  else if (p.shape == SolidKind::box)
    s.half = p.size / 2;
  else
    s.radius = p.radius;
  if (p.shape == SolidKind::capsule || p.shape == SolidKind::cylinder) s.half.z() = p.height / 2;
  return s;
}

/// The solid with its axis along z and its top at the height -gap.
inline ShapeParameters upright(ShapeParameters p, double gap = 0) {
  p.rotate.setZero();
  p.normal = {0, 0, 2};
  p.translate.setZero();
  p.translate.z() = -gap - solid_of(p).support({0, 0, 1});
  return p;
}
inline ShapeParameters upright(SolidKind kind, double gap = 0) {
  ShapeParameters p;
  p.name = "thing";
  p.shape = kind;
  p.radius = p.height = 0.1;
  p.size = {0.3, 0.3, 0.1};
  return upright(p, gap);
}

inline std::shared_ptr<const BoundContact> bound(const std::vector<ShapeParameters>& solids,
                                                 const Level& level, double friction = 0) {
  Shapes::Parameters p;
  p.obstacles = solids;
  p.dhat = dhat;
  p.stiffness = kappa;
  p.friction = friction;
  return Shapes(p).bind(level, Material());
}

/// A shape of about 0.1 m, turned and off the origin.
inline ShapeParameters some(SolidKind kind) {
  ShapeParameters p;
  p.shape = kind;
  p.translate = {0.03, -0.02, 0.05};
  p.radius = 0.06;
  p.size = {0.1, 0.14, 0.08};
  p.height = 0.1;
  p.rotate = {20, -35, 50};
  p.normal = {0.3, -0.2, 1.1};
  return p;
}

/// Runs the body on a solid of every kind.
template <class Body>
void for_each_solid(const Body& body) {
  for (const auto& [name, kind] : kind_names) {
    INFO(name);
    body(solid_of(some(kind)), some(kind));
  }
}

}  // namespace drape::shapes

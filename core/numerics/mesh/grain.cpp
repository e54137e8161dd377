#include "core/numerics/mesh/grain.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace drape {
namespace {

using Vector = Eigen::Vector3d;

/// Two edges of a triangle from its first corner, and its unit normal.
struct Sides {
  Vector e1, e2, normal;

  Sides(const TriangleMesh& mesh, Eigen::Index t) {
    const auto at = [&](int k) -> Vector { return mesh.vertices.row(mesh.triangles(t, k)); };
    e1 = at(1) - at(0), e2 = at(2) - at(0), normal = e1.cross(e2).normalized();
  }
  /// The axis within the triangle's plane; 0 where it is the normal, but for rounding.
  Vector projected(const Vector& axis) const {
    const Vector own = axis - axis.dot(normal) * normal;
    return own.norm() > 1e-6 * axis.norm() ? own.normalized() : Vector::Zero();
  }
};

/// The direction in which u rises and v stays; 0 where the texture coordinates have no area.
Vector along_u(const TriangleMesh& mesh, Eigen::Index t, const Sides& sides) {
  if (mesh.uv.rows() == 0) return Vector::Zero();
  const auto corner = [&](int k) -> Eigen::Vector2d { return mesh.uv.block<1, 2>(t, 2 * k).transpose(); };
  const Eigen::Vector2d a = corner(1) - corner(0), b = corner(2) - corner(0);
  const double det = a.x() * b.y() - a.y() * b.x();
  if (std::abs(det) <= 1e-12 * (a.squaredNorm() + b.squaredNorm())) return Vector::Zero();
  return sides.projected((b.y() * sides.e1 - a.y() * sides.e2) / det);
}

Vector direction(const TriangleMesh& mesh, Eigen::Index t, const Sides& sides) {
  const bool by_u = mesh.grain && mesh.grain->along == Grain::Axis::u;
  return by_u ? along_u(mesh, t, sides) : sides.projected(Vector::UnitX());
}

}  // namespace

Positions warp_directions(const TriangleMesh& rest) {
  Positions warp(rest.triangles.rows(), 3);
  for (Eigen::Index t = 0; t < warp.rows(); ++t) {
    const Sides sides(rest, t);
    Vector first = direction(rest, t, sides);
    for (int axis = 0; axis < 3 && first.isZero(0); ++axis) first = sides.projected(Vector::Unit(axis));
    if (rest.grain && rest.grain->angle != 0) {
      const double angle = rest.grain->angle * std::numbers::pi / 180;
      first = std::cos(angle) * first + std::sin(angle) * sides.normal.cross(first);
    }
    warp.row(t) = first.transpose();
  }
  return warp;
}

std::vector<std::string> grain_faults(const TriangleMesh& rest) {
  if (!rest.grain) return {};
  const bool by_u = rest.grain->along == Grain::Axis::u;
  if (by_u && rest.uv.rows() == 0)
    return {"\"grain_along: u\" needs a mesh with texture coordinates; write \"grain_along: x\""};
  for (Eigen::Index t = 0; t < rest.triangles.rows(); ++t)
    if (direction(rest, t, Sides(rest, t)).isZero(0))
      return {"\"grain\" has no direction in triangle " + std::to_string(t) +
              (by_u ? ", whose texture coordinates have no area; unwrap it, or write \"grain_along: x\""
                    : ", which is normal to x; turn the mesh with \"rotate\", or give it texture "
                      "coordinates and write \"grain_along: u\"")};
  return {};
}

}  // namespace drape

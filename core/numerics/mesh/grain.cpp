#include "core/numerics/mesh/grain.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/numerics/mesh/flat_pieces.h"

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
  /// The axis within the triangle's plane; 0 where it is the normal, but for rounding. One that is there
  /// keeps its bits.
  Vector projected(const Vector& axis) const {
    constexpr double rounding = 1e-9;  // that of a projection of an axis near the normal
    if (std::abs(axis.dot(normal)) <= rounding && std::abs(axis.squaredNorm() - 1) <= rounding) return axis;
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

Vector direction(const TriangleMesh& mesh, Eigen::Index t, const Sides& sides, GrainAxis along) {
  if (along == GrainAxis::u) return along_u(mesh, t, sides);
  if (along == GrainAxis::x || mesh.warp.rows() == 0) return sides.projected(Vector::UnitX());
  return mesh.warp.row(t).transpose();
}

}  // namespace

Positions warp_directions(const TriangleMesh& rest) {
  return rest.warp.rows() > 0 ? rest.warp : cut_directions(rest, GrainAxis::x, 0);
}

Positions cut_directions(const TriangleMesh& rest, GrainAxis along, double degrees) {
  return cut_directions(rest, along, Eigen::VectorXd::Constant(rest.triangles.rows(), degrees));
}

Positions cut_directions(const TriangleMesh& rest, GrainAxis along, const Eigen::VectorXd& degrees) {
  if (rest.sewing) return flat_directions(rest, along, degrees);
  Positions warp(rest.triangles.rows(), 3);
  for (Eigen::Index t = 0; t < warp.rows(); ++t) {
    const Sides sides(rest, t);
    const double angle = degrees[t] * std::numbers::pi / 180;
    Vector first = direction(rest, t, sides, along);
    for (int axis = 0; axis < 3 && first.isZero(0); ++axis) first = sides.projected(Vector::Unit(axis));
    if (angle != 0) first = std::cos(angle) * first + std::sin(angle) * sides.normal.cross(first);
    warp.row(t) = first.transpose();
  }
  return warp;
}

std::vector<std::string> grain_faults(const TriangleMesh& rest, GrainAxis along,
                                      const std::vector<char>& triangles) {
  if (along == GrainAxis::u && rest.uv.rows() == 0)
    return {"\"grain_along: u\" needs a mesh with texture coordinates; write \"grain_along: x\""};
  if (along == GrainAxis::file && rest.warp.rows() == 0)
    return {
        "\"grain_along: file\" needs a PLY file whose faces have warp_x, warp_y and warp_z; write "
        "\"grain_along: x\""};
  if (rest.sewing) return {};
  for (Eigen::Index t = 0; t < rest.triangles.rows(); ++t)
    if (triangles[t] && direction(rest, t, Sides(rest, t), along).isZero(0))
      return {"\"grain\" has no direction in triangle " + std::to_string(t) +
              (along == GrainAxis::u
                   ? ", whose texture coordinates have no area; unwrap it, or write \"grain_along: x\""
                   : ", which is normal to x; turn the mesh with \"rotate\", or give it texture "
                     "coordinates and write \"grain_along: u\"")};
  return {};
}

Positions split_warp(const Positions& coarse, const TriangleMesh& fine) {
  if (coarse.rows() == 0) return {};
  Positions warp(4 * coarse.rows(), 3);
  for (Eigen::Index t = 0; t < coarse.rows(); ++t)
    warp.middleRows<4>(4 * t) = coarse.row(t).colwise().replicate<4>();
  return projected_warp(warp, fine);
}

Positions projected_warp(const Positions& directions, const TriangleMesh& mesh) {
  if (mesh.sewing) return directions;  // they are in the pieces' plane
  Positions warp(directions.rows(), 3);
  for (Eigen::Index t = 0; t < warp.rows(); ++t) {
    const Vector own = Sides(mesh, t).projected(directions.row(t).transpose());
    if (!(own.norm() > 0))
      throw std::runtime_error("the direction of warp in triangle " + std::to_string(t) +
                               " has no part in the triangle's plane");
    warp.row(t) = own.transpose();
  }
  return warp;
}

}  // namespace drape

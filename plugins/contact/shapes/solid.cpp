#include "plugins/contact/shapes/solid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

#include "core/numerics/mesh/rotation.h"

namespace drape::shapes {

namespace {

using Eigen::Vector3d;

/// For a rounded box, in local coordinates.
SignedDistance nearest_to_box(const Solid& s, const Vector3d& q) {
  SignedDistance n;
  const Vector3d v = q - q.cwiseMax(-s.half).cwiseMin(s.half);
  const double length = v.norm();
  if (length == 0) {  // inside the core: the nearest face
    Eigen::Index k;
    n.distance = (q.cwiseAbs() - s.half).maxCoeff(&k) - s.radius;
    n.normal = Vector3d::Unit(k) * (q[k] < 0 ? -1 : 1);
    n.tangent = Vector3d::Unit((k + 1) % 3);
    return n;
  }
  n.distance = length - s.radius;
  n.normal = v / length;
  int outside = 0, along = 0;
  for (int k = 0; k < 3; ++k)
    if (s.half[k] == 0 || std::abs(q[k]) > s.half[k])
      ++outside;
    else
      along = k;
  n.tangent = outside == 2 ? Vector3d(Vector3d::Unit(along)) : Vector3d(n.normal.unitOrthogonal());
  if (outside > 1) n.curvature[1] = 1 / length;
  if (outside > 2) n.curvature[0] = 1 / length;
  return n;
}

SignedDistance nearest_to_cylinder(const Solid& s, const Vector3d& q) {
  SignedDistance n;
  const double rho = q.head<2>().norm(), out = rho - s.radius, up = std::abs(q.z()) - s.half.z();
  const Vector3d radial = rho > 0 ? Vector3d(q.x() / rho, q.y() / rho, 0) : Vector3d(1, 0, 0);
  const Vector3d axial(0, 0, q.z() < 0 ? -1 : 1);
  n.tangent = {-radial.y(), radial.x(), 0};
  if (out > 0 && up > 0) {  // the rim
    n.distance = std::hypot(out, up);
    n.normal = (out * radial + up * axial) / n.distance;
    n.curvature = {out / n.distance / rho, 1 / n.distance};
  } else if (out > up) {
    n.distance = out;
    n.normal = radial;
    n.curvature = {rho > 0 ? 1 / rho : 0, 0};
  } else {
    n.distance = up;
    n.normal = axial;
  }
  return n;
}

/// The root of a monotone function on [0, 1], clamped.
template <class Slope>
double monotone_root(const Slope& slope) {
  const double first = slope(0.0), last = slope(1.0);
  if (first >= 0) return 0;
  if (last <= 0) return 1;
  std::uintmax_t evaluations = 60;
  const auto [low, high] = boost::math::tools::toms748_solve(
      slope, 0.0, 1.0, first, last, boost::math::tools::eps_tolerance<double>(50), evaluations);
  return 0.5 * (low + high);
}

/// The derivative of half the squared distance to the core is piecewise linear, and its root exact.
double nearest_to_box_on_edge(const Vector3d& half, const Vector3d& a, const Vector3d& e) {
  const auto slope = [&](double t) {
    const Vector3d q = a + t * e;
    return (q - q.cwiseMax(-half).cwiseMin(half)).dot(e);
  };
  double low = 0, high = 1, low_slope = slope(0), high_slope = slope(1);
  if (low_slope >= 0) return 0;
  if (high_slope <= 0) return 1;
  for (int k = 0; k < 3; ++k)
    for (const double side : {-half[k], half[k]}) {
      const double t = (side - a[k]) / e[k];  // a kink of the derivative, unless e[k] is 0
      if (!(t > low && t < high)) continue;
      const double here = slope(t);
      (here < 0 ? low : high) = t;
      (here < 0 ? low_slope : high_slope) = here;
    }
  return low + (high - low) * low_slope / (low_slope - high_slope);
}

/// Exact where the nearest point lies on the cylinder's curved side: the edge is then nearest to the axis
/// there. Elsewhere, and along the axis, where t is NaN, a root.
double nearest_to_cylinder_on_edge(const Solid& s, const Vector3d& a, const Vector3d& e) {
  const double t = std::clamp(-a.head<2>().dot(e.head<2>()) / e.head<2>().squaredNorm(), 0.0, 1.0);
  const Vector3d nearest = a + t * e;
  if (nearest.head<2>().norm() > s.radius && std::abs(nearest.z()) <= s.half.z()) return t;
  const auto half_slope = [&](double u) {  // derivative of half the squared distance
    const Vector3d q = a + u * e;
    const double rho = q.head<2>().norm();
    const double out = std::max(0.0, 1 - s.radius / rho), up = std::abs(q.z()) - s.half.z();
    return out * (q.x() * e.x() + q.y() * e.y()) + (up > 0 ? std::copysign(up, q.z()) * e.z() : 0.0);
  };
  return monotone_root(half_slope);
}

/// The shortest rotation that takes +z to this unit vector; for -z, half a turn about y. Eigen's own
/// (Quaternion::FromTwoVectors) brings a singular value decomposition, which takes ten seconds to compile.
Eigen::Matrix3d rotation_of_z_to(const Vector3d& u) {
  const double sine = std::hypot(u.x(), u.y()), turned = 1 - u.z();
  const double x = sine > 0 ? u.x() / sine : 1, y = sine > 0 ? u.y() / sine : 0;
  Eigen::Matrix3d r;
  r << 1 - turned * x * x, -turned * x * y, u.x(), -turned * x * y, 1 - turned * y * y, u.y(), -u.x(), -u.y(),
      u.z();
  return r;
}

}  // namespace

void Solid::update_axes() {
  axes = kind == SolidKind::half_space ? rotation_of_z_to(plane.normalized()) : rotation_matrix(rotate);
}

SignedDistance Solid::nearest(const Vector3d& p) const {
  const Vector3d q = to_local(p);
  SignedDistance n = by_form(
      kind, [&] { return nearest_to_box(*this, q); }, [&] { return nearest_to_cylinder(*this, q); },
      [&] { return SignedDistance{q.z()}; });
  n.normal = axes * n.normal;
  n.tangent = axes * n.tangent;
  return n;
}

double Solid::distance(const Vector3d& p) const {
  const Vector3d q = to_local(p);
  const auto to_box = [&] {
    const double length = (q - q.cwiseMax(-half).cwiseMin(half)).norm();
    return (length > 0 ? length : (q.cwiseAbs() - half).maxCoeff()) - radius;
  };
  const auto to_cylinder = [&] {
    const double out = q.head<2>().norm() - radius, up = std::abs(q.z()) - half.z();
    return out > 0 && up > 0 ? std::hypot(out, up) : std::max(out, up);
  };
  return by_form(kind, to_box, to_cylinder, [&] { return q.z(); });
}

double Solid::support(const Vector3d& n) const {
  const double middle = n.dot(centre);
  const Vector3d m = axes.transpose() * n;
  const auto across = [&] { return m.head<2>().norm(); };
  return by_form(
      kind, [&] { return middle + half.dot(m.cwiseAbs()) + radius; },
      [&] { return middle + radius * across() + half.z() * std::abs(m.z()); },
      [&] {  // 1e-7: m.z() then rounds to 1
        return m.z() > 0 && across() < 1e-7 ? middle : std::numeric_limits<double>::infinity();
      });
}

double Solid::nearest_on_edge(const Vector3d& a, const Vector3d& b) const {
  const Vector3d p = to_local(a), e = axes.transpose() * (b - a);
  return by_form(
      kind, [&] { return nearest_to_box_on_edge(half, p, e); },
      [&] { return nearest_to_cylinder_on_edge(*this, p, e); }, [&] { return e.z() < 0 ? 1.0 : 0.0; });
}

}  // namespace drape::shapes

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "core/numerics/linear_algebra/pack_functions.h"

namespace drape {

/// The turn from a dihedral angle at rest to another, in [-π, π]: a hinge that is flat shut at rest, at π or
/// -π by round-off alone, opens to either side alike.
template <class T>
T bend_from(const T& rest, const T& angle) {
  const T turn = angle - rest;
  return select(turn > M_PI, turn - 2 * M_PI, select(turn < -M_PI, turn + 2 * M_PI, turn));
}

/// Signed dihedral angle θ between the normals of triangles (0, 1, 2) and (1, 0, 3), positive if vertex 3
/// lies behind the first triangle, with its derivatives by e = x₁ - x₀, u = x₂ - x₀ and v = x₃ - x₀. T is
/// double or a Pack.
///
/// θ = φ(e, u) - φ(e, v) + π with the azimuth φ about the axis e, so all derivatives come from those of φ.
/// They equal those of Tamstorf & Grinspun 2013, "Discrete bending forces and their Jacobians".
template <class T>
class DihedralAngle {
 public:
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Block = Eigen::Matrix<T, 3, 3>;

  /// From e, u, v.
  explicit DihedralAngle(const Vector* x) : axis_(x[0]), u_(axis_, x[1]), v_(axis_, x[2]) {
    using std::atan2;
    // v is h_v m_v plus a component along the axis, so n_u·m_v = n_u·v / h_v.
    angle_ = atan2(-v_.inverse_height * u_.n.dot(x[2]), -u_.n.dot(v_.n));
  }

  const T& angle() const { return angle_; }

  /// g receives `scale` times the derivatives of θ by e, u and v.
  void gradient(const T& scale, Vector* g) const {
    g[0] = (u_.by_axis() - v_.by_axis()) * scale;
    g[1] = u_.by_point() * scale;
    g[2] = v_.by_point() * -scale;
  }

  /// Upper blocks of the 9×9 matrix stiffness ∇θ ∇θᵀ + moment ∇²θ by (e, u, v). It is assembled from two
  /// symmetric 4×4 parts after `map` has been applied to each part's upper triangle.
  ///
  /// In e, q = u - s_u e and r = v - s_v e (the points' offsets from their feet) the second derivatives of φ
  /// are those of n·q m·q / h² + n·e t·q / (h ‖e‖) + n·e m·e / (2 ‖e‖²), which decouples (n_u·q, m_u·q,
  /// n_v·r, m_v·r) from (n_u·e, m_u·e, t·q, t·r). Stretch along e has no effect.
  template <class Map>
  void hessian(const T& stiffness, const T& moment, Eigen::Matrix<T, 9, 9>& h, const Map& map) const {
    const Azimuth &u = u_, &v = v_;
    const T l = axis_.inverse_length, wu = u.inverse_height, wv = v.inverse_height;
    const T c = u.n.dot(v.n), k = u.m.dot(v.n), zero = 0.0;

    Eigen::Matrix<T, 4, 4> across, along;
    across(0, 0) = stiffness * wu * wu, across(0, 1) = moment * wu * wu, across(1, 1) = zero;
    across(2, 2) = stiffness * wv * wv, across(2, 3) = -moment * wv * wv, across(3, 3) = zero;
    across(0, 2) = -stiffness * wu * wv, across(0, 3) = across(1, 2) = across(1, 3) = zero;
    const T ll = moment * l * l;
    along(0, 0) = ll * c * k, along(0, 1) = ll * k * k, along(1, 1) = -along(0, 0);
    along(0, 2) = moment * l * wu, along(0, 3) = -moment * l * wv * c;
    along(1, 2) = zero, along(1, 3) = -moment * l * wv * k;
    along(2, 2) = along(2, 3) = along(3, 3) = zero;
    map(across);
    map(along);

    const Vector& t = axis_.unit;
    const Vector qn = u.n * across(0, 0) + u.m * across(0, 1), qm = u.n * across(0, 1) + u.m * across(1, 1);
    const Vector rn = v.n * across(2, 2) + v.m * across(2, 3), rm = v.n * across(2, 3) + v.m * across(3, 3);
    const Vector sn = u.n * across(0, 2) + u.m * across(1, 2), sm = u.n * across(0, 3) + u.m * across(1, 3);
    const Block qq = qn * u.n.transpose() + qm * u.m.transpose() + (t * along(2, 2)) * t.transpose();
    const Block rr = rn * v.n.transpose() + rm * v.m.transpose() + (t * along(3, 3)) * t.transpose();
    const Block qr = sn * v.n.transpose() + sm * v.m.transpose() + (t * along(2, 3)) * t.transpose();
    const Block eq = (u.n * along(0, 2) + u.m * along(1, 2)) * t.transpose();
    const Block er = (u.n * along(0, 3) + u.m * along(1, 3)) * t.transpose();
    const Vector en = u.n * along(0, 0) + u.m * along(0, 1), em = u.n * along(0, 1) + u.m * along(1, 1);

    const Block eu = eq - qq * u.s - qr.transpose() * v.s, ev = er - qr * u.s - rr * v.s;
    h.template block<3, 3>(0, 0) = en * u.n.transpose() + em * u.m.transpose() - (eq.transpose() + eu) * u.s -
                                   (er.transpose() + ev) * v.s;
    h.template block<3, 3>(0, 3) = eu;
    h.template block<3, 3>(0, 6) = ev;
    h.template block<3, 3>(3, 3) = qq;
    h.template block<3, 3>(3, 6) = qr;
    h.template block<3, 3>(6, 6) = rr;
  }

 private:
  struct Axis {
    T inverse_length;  // 1 / ‖e‖
    Vector unit;       // t = e / ‖e‖

    explicit Axis(const Vector& e) {
      using std::sqrt;
      inverse_length = 1.0 / sqrt(e.squaredNorm());
      unit = e * inverse_length;
    }
  };

  /// The azimuth φ(e, p) of a point about the axis, in the frame t, n, m: n normal to both,
  /// m = n × t towards the point, h the distance, s the foot's parameter along e (0 … 1 on the edge).
  struct Azimuth {
    T s, inverse_height;
    Vector n, m;

    Azimuth(const Axis& axis, const Vector& p) {
      using std::sqrt;
      const Vector normal = axis.unit.cross(p);
      inverse_height = 1.0 / sqrt(normal.squaredNorm());
      n = normal * inverse_height;
      m = n.cross(axis.unit);
      s = axis.unit.dot(p) * axis.inverse_length;
    }
    Vector by_point() const { return n * -inverse_height; }
    Vector by_axis() const { return n * (s * inverse_height); }
  };

  Axis axis_;
  Azimuth u_, v_;
  T angle_;
};

}  // namespace drape

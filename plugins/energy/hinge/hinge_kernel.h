#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace drape {

/// Discrete hinge c (θ - θ̄)², θ the signed angle between the normals of triangles (0, 1, 2) and (1, 0, 3),
/// positive where vertex 3 lies behind the first triangle. A function of the vectors e = x₁ - x₀, u = x₂ -
/// x₀, v = x₃ - x₀. T is double or a Pack.
///
/// θ = φ(e, u) - φ(e, v) + π, φ being the azimuth about the axis e, so that first and second derivatives are
/// those of φ twice (the same as in Tamstorf & Grinspun 2013, "Discrete bending forces and their Jacobians").
struct HingeKernel {
  static constexpr int vertices = 4;
  static constexpr bool convex = false;
  using Rest = Eigen::Matrix<double, 2, 1>;  // c [J], θ̄
  template <class T>
  using Vector = Eigen::Matrix<T, 3, 1>;
  template <class T>
  using Block = Eigen::Matrix<T, 3, 3>;

  /// From the rest vectors e, u, v [m] and k [J]: c = 3 k ‖ē‖² / (Ā₁ + Ā₂).
  static Rest rest(const Eigen::Vector3d* x, double k) {
    const double areas = (x[0].cross(x[1]).norm() + x[0].cross(x[2]).norm()) / 2;
    return {3 * k * x[0].squaredNorm() / areas, angle(x)};
  }

  template <class T>
  static T angle(const Vector<T>* x) {
    const Axis<T> axis(x[0]);
    return angle(Azimuth<T>(axis, x[1]), Azimuth<T>(axis, x[2]), x[2]);
  }

  template <class T>
  static T value(const Vector<T>* x, const T* rest) {
    const T bend = angle(x) - rest[1];
    return rest[0] * bend * bend;
  }

  /// g receives the derivatives by e, u and v; returns the energy.
  template <class T>
  static T gradient(const Vector<T>* x, const T* rest, Vector<T>* g) {
    const Axis<T> axis(x[0]);
    const Azimuth<T> u(axis, x[1]), v(axis, x[2]);
    const T bend = angle(u, v, x[2]) - rest[1], scale = 2.0 * rest[0] * bend;
    g[0] = (u.by_axis() - v.by_axis()) * scale;
    g[1] = u.by_point() * scale;
    g[2] = v.by_point() * -scale;
    return rest[0] * bend * bend;
  }

  /// The upper blocks of the 9×9 Hessian by (e, u, v): 2 c (∇θ ∇θᵀ + (θ - θ̄) ∇²θ).
  template <class T>
  static void hessian(const Vector<T>* x, const T* rest, Eigen::Matrix<T, 9, 9>& h) {
    hessian(x, rest, h, [](Eigen::Matrix<T, 4, 4>&) {});
  }

  /// The same of its two symmetric 4×4 parts, upper triangles, after `map` has changed them.
  ///
  /// By e, q = u - s_u e and r = v - s_v e (the points' distances from their feet) the second derivatives of
  /// φ are those of n·q m·q / h² + n·e t·q / (h ‖e‖) + n·e m·e / (2 ‖e‖²), so that (n_u·q, m_u·q, n_v·r,
  /// m_v·r) and (n_u·e, m_u·e, t·q, t·r) do not meet. Stretching along e changes nothing.
  template <class T, class Map>
  static void hessian(const Vector<T>* x, const T* rest, Eigen::Matrix<T, 9, 9>& h, const Map& map) {
    const Axis<T> axis(x[0]);
    const Azimuth<T> u(axis, x[1]), v(axis, x[2]);
    const T scale = 2.0 * rest[0], bend = scale * (angle(u, v, x[2]) - rest[1]);
    const T l = axis.inverse_length, wu = u.inverse_height, wv = v.inverse_height;
    const T c = u.n.dot(v.n), k = u.m.dot(v.n), zero = 0.0;

    Eigen::Matrix<T, 4, 4> across, along;
    across(0, 0) = scale * wu * wu, across(0, 1) = bend * wu * wu, across(1, 1) = zero;
    across(2, 2) = scale * wv * wv, across(2, 3) = -bend * wv * wv, across(3, 3) = zero;
    across(0, 2) = -scale * wu * wv, across(0, 3) = across(1, 2) = across(1, 3) = zero;
    const T ll = bend * l * l;
    along(0, 0) = ll * c * k, along(0, 1) = ll * k * k, along(1, 1) = -along(0, 0);
    along(0, 2) = bend * l * wu, along(0, 3) = -bend * l * wv * c;
    along(1, 2) = zero, along(1, 3) = -bend * l * wv * k;
    along(2, 2) = along(2, 3) = along(3, 3) = zero;
    map(across);
    map(along);

    const Vector<T>& t = axis.unit;
    const Vector<T> qn = u.n * across(0, 0) + u.m * across(0, 1),
                    qm = u.n * across(0, 1) + u.m * across(1, 1);
    const Vector<T> rn = v.n * across(2, 2) + v.m * across(2, 3),
                    rm = v.n * across(2, 3) + v.m * across(3, 3);
    const Vector<T> sn = u.n * across(0, 2) + u.m * across(1, 2),
                    sm = u.n * across(0, 3) + u.m * across(1, 3);
    const Block<T> qq = qn * u.n.transpose() + qm * u.m.transpose() + (t * along(2, 2)) * t.transpose();
    const Block<T> rr = rn * v.n.transpose() + rm * v.m.transpose() + (t * along(3, 3)) * t.transpose();
    const Block<T> qr = sn * v.n.transpose() + sm * v.m.transpose() + (t * along(2, 3)) * t.transpose();
    const Block<T> eq = (u.n * along(0, 2) + u.m * along(1, 2)) * t.transpose();
    const Block<T> er = (u.n * along(0, 3) + u.m * along(1, 3)) * t.transpose();
    const Vector<T> en = u.n * along(0, 0) + u.m * along(0, 1), em = u.n * along(0, 1) + u.m * along(1, 1);

    const Block<T> eu = eq - qq * u.s - qr.transpose() * v.s, ev = er - qr * u.s - rr * v.s;
    h.template block<3, 3>(0, 0) = en * u.n.transpose() + em * u.m.transpose() - (eq.transpose() + eu) * u.s -
                                   (er.transpose() + ev) * v.s;
    h.template block<3, 3>(0, 3) = eu;
    h.template block<3, 3>(0, 6) = ev;
    h.template block<3, 3>(3, 3) = qq;
    h.template block<3, 3>(3, 6) = qr;
    h.template block<3, 3>(6, 6) = rr;
  }

 private:
  /// The axis of a hinge.
  template <class T>
  struct Axis {
    T inverse_length;  // 1 / ‖e‖
    Vector<T> unit;    // t = e / ‖e‖

    explicit Axis(const Vector<T>& e) {
      using std::sqrt;
      inverse_length = 1.0 / sqrt(e.squaredNorm());
      unit = e * inverse_length;
    }
  };

  /// The azimuth φ(e, p) of a point about an axis, in the frame t, n, m: n normal to both,
  /// m = n × t towards the point, h the distance, s the foot's place along e (0 … 1 on the edge).
  template <class T>
  struct Azimuth {
    const Axis<T>& axis;
    T s, inverse_height;
    Vector<T> n, m;

    Azimuth(const Axis<T>& axis, const Vector<T>& p) : axis(axis) {
      using std::sqrt;
      const Vector<T> normal = axis.unit.cross(p);
      inverse_height = 1.0 / sqrt(normal.squaredNorm());
      n = normal * inverse_height;
      m = n.cross(axis.unit);
      s = axis.unit.dot(p) * axis.inverse_length;
    }
    Vector<T> by_point() const { return n * -inverse_height; }
    Vector<T> by_axis() const { return n * (s * inverse_height); }
  };

  /// θ from both azimuths; v is h_v m_v and a part along the axis, so that n_u·m_v = n_u·v / h_v.
  template <class T>
  static T angle(const Azimuth<T>& u, const Azimuth<T>& v, const Vector<T>& by_v) {
    using std::atan2;
    return atan2(-v.inverse_height * u.n.dot(by_v), -u.n.dot(v.n));
  }
};

}  // namespace drape

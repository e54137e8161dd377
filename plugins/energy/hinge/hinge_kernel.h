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
    using std::atan2, std::sqrt;
    const Vector<T> n1 = x[0].cross(x[1]), n2 = x[2].cross(x[0]);
    return atan2(-sqrt(x[0].squaredNorm()) * n1.dot(x[2]), n1.dot(n2));
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
    const T bend = angle(x) - rest[1], scale = 2.0 * rest[0] * bend;
    g[0] = (u.by_axis() - v.by_axis()) * scale;
    g[1] = u.by_point() * scale;
    g[2] = v.by_point() * -scale;
    return rest[0] * bend * bend;
  }

  /// The upper blocks of the 9×9 Hessian by (e, u, v): 2 c (∇θ ∇θᵀ + (θ - θ̄) ∇²θ).
  template <class T>
  static void hessian(const Vector<T>* x, const T* rest, Eigen::Matrix<T, 9, 9>& h) {
    const Axis<T> axis(x[0]);
    const Azimuth<T> u(axis, x[1]), v(axis, x[2]);
    const T scale = 2.0 * rest[0], bend = scale * (angle(x) - rest[1]);
    const Vector<T> ge = u.by_axis() - v.by_axis(), gu = u.by_point(), gv = -v.by_point();
    h.template block<3, 3>(0, 0) = (ge * scale) * ge.transpose() + (u.axis_axis() - v.axis_axis()) * bend;
    h.template block<3, 3>(0, 3) = (ge * scale) * gu.transpose() + u.axis_point() * bend;
    h.template block<3, 3>(0, 6) = (ge * scale) * gv.transpose() - v.axis_point() * bend;
    h.template block<3, 3>(3, 3) = (gu * scale) * gu.transpose() + u.point_point() * bend;
    h.template block<3, 3>(3, 6) = (gu * scale) * gv.transpose();
    h.template block<3, 3>(6, 6) = (gv * scale) * gv.transpose() - v.point_point() * bend;
  }

  /// Stretching everything along the axis changes neither the energy nor its gradient.
  template <class T>
  static void null_direction(const Vector<T>* x, Vector<T>* n) {
    const Axis<T> axis(x[0]);
    for (int i = 0; i < 3; ++i) n[i] = axis.unit * (axis.unit.dot(x[i]) * axis.inverse_length);
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

  /// Derivatives of the azimuth φ(e, p) of a point about an axis, in the frame t, n, m: n normal to both,
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
    Block<T> point_point() const { return symmetric(m * (inverse_height * inverse_height)); }
    Block<T> axis_point() const {
      const T w = inverse_height * inverse_height;
      return symmetric(m * (-s * w)) + (n * (axis.inverse_length * inverse_height)) * axis.unit.transpose();
    }
    /// Without its antisymmetric part [t]×/2‖e‖², which is the same for every point.
    Block<T> axis_axis() const {
      const T l = axis.inverse_length, w = s * inverse_height;
      return symmetric(m * (w * w + 0.5 * l * l) - axis.unit * (w * l));
    }
    /// n aᵀ + a nᵀ.
    Block<T> symmetric(const Vector<T>& a) const {
      const Block<T> product = n * a.transpose();
      return product + product.transpose();
    }
  };
};

}  // namespace drape

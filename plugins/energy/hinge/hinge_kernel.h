#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/kernel/elements/dihedral_angle.h"

namespace drape {

/// Discrete hinge c (θ - θ̄)² of the dihedral angle θ, by the shorter turn from θ̄. T is double or a Pack.
struct HingeKernel {
  static constexpr int vertices = 4;
  static constexpr bool convex = false;
  using Rest = Eigen::Matrix<double, 2, 1>;  // c [J], θ̄
  template <class T>
  using Vector = Eigen::Matrix<T, 3, 1>;

  /// From the rest vectors e, u, v [m] and k [J]: c = 3 k ‖ē‖² / (Ā₁ + Ā₂).
  static Rest rest(const Eigen::Vector3d* x, double k) {
    const double areas = (x[0].cross(x[1]).norm() + x[0].cross(x[2]).norm()) / 2;
    return {3 * k * x[0].squaredNorm() / areas, angle(x)};
  }

  template <class T>
  static T angle(const Vector<T>* x) {
    return DihedralAngle<T>(x).angle();
  }

  template <class T>
  static T value(const Vector<T>* x, const T* rest) {
    const T bend = bend_from(rest[1], angle(x));
    return rest[0] * bend * bend;
  }

  /// g receives the derivatives by e, u and v; returns the energy.
  template <class T>
  static T gradient(const Vector<T>* x, const T* rest, Vector<T>* g) {
    const DihedralAngle<T> dihedral(x);
    const T bend = bend_from(rest[1], dihedral.angle());
    dihedral.gradient(2.0 * rest[0] * bend, g);
    return rest[0] * bend * bend;
  }

  /// The upper blocks of the 9×9 Hessian by (e, u, v): 2 c (∇θ ∇θᵀ + (θ - θ̄) ∇²θ).
  template <class T>
  static void hessian(const Vector<T>* x, const T* rest, Eigen::Matrix<T, 9, 9>& h) {
    hessian(x, rest, h, [](Eigen::Matrix<T, 4, 4>&) {});
  }

  /// The same from its two symmetric 4×4 parts, after `map` has been applied to each part's upper triangle.
  template <class T, class Map>
  static void hessian(const Vector<T>* x, const T* rest, Eigen::Matrix<T, 9, 9>& h, const Map& map) {
    const DihedralAngle<T> dihedral(x);
    const T scale = 2.0 * rest[0];
    dihedral.hessian(scale, scale * bend_from(rest[1], dihedral.angle()), h, map);
  }
};

}  // namespace drape

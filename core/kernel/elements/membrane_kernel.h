#pragma once

#include <memory>
#include <vector>

#include "core/kernel/elements/element_energy.h"
#include "core/kernel/elements/stretch.h"
#include "core/kernel/model/material.h"

namespace drape {

/// Strain of one triangle, input of a membrane law. T is double or a Pack.
template <class T>
struct MembraneStrain {
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Block = Eigen::Matrix<T, 3, 3>;
  T mu, lambda;     ///< Lamé's constants of plane stress, times A d [J]
  Vector f1, f2;    ///< columns of F
  T g11, g12, g22;  ///< G = (C - I)/2, C = FᵀF; G keeps the digits of small strains

  MembraneStrain(const Vector& f1, const Vector& f2, const T& mu, const T& lambda)
      : mu(mu), lambda(lambda), f1(f1), f2(f2) {
    g11 = 0.5 * (f1.squaredNorm() - 1.0);
    g22 = 0.5 * (f2.squaredNorm() - 1.0);
    g12 = 0.5 * f1.dot(f2);
  }
};

/// Isotropic elastic energy of one triangle in plane stress, for ElementEnergy. Law<T> is a
/// MembraneStrain<T>, built from the same, and has, of A d ψ(F),
///
///     T energy() const;
///     void stress(Vector& p1, Vector& p2) const;                        // by the columns of F
///     void stiffness(Block& h11, Block& h12, Block& h22) const;         // and twice by them; h12 = ∂p₁/∂F₂
template <template <class> class Law>
struct MembraneKernel {
  static constexpr int vertices = 3;
  static constexpr bool convex = false;
  using Rest = Eigen::Matrix<double, 5, 1>;  ///< RestTriangle's a, b, c, then A d μ, A d λ
  template <class T>
  using Vector = Eigen::Matrix<T, 3, 1>;

  static Rest rest(const RestTriangle& triangle, const Material& material) {
    const double volume = triangle.area * material.thickness, nu = material.poisson_ratio;
    Rest r;
    r << triangle.a, triangle.b, triangle.c, volume * material.membrane_modulus / (2 * (1 + nu)),
        volume * material.membrane_modulus * nu / (1 - nu * nu);
    return r;
  }

  template <class T>
  static T value(const Vector<T>* e, const T* rest) {
    return law(e, rest).energy();
  }

  /// g receives the derivatives by e₁ and e₂; returns the energy.
  template <class T>
  static T gradient(const Vector<T>* e, const T* rest, Vector<T>* g) {
    const Law<T> s = law(e, rest);
    Vector<T> p1, p2;
    s.stress(p1, p2);
    g[0] = p1 * rest[0] + p2 * rest[1];
    g[1] = p2 * rest[2];
    return s.energy();
  }

  /// The upper blocks of the 6×6 Hessian by (e₁, e₂).
  template <class T>
  static void hessian(const Vector<T>* e, const T* rest, Eigen::Matrix<T, 6, 6>& h) {
    Eigen::Matrix<T, 3, 3> h11, h12, h22;
    law(e, rest).stiffness(h11, h12, h22);
    const T a = rest[0], b = rest[1], c = rest[2];
    h.template block<3, 3>(0, 0) = h11 * (a * a) + (h12 + h12.transpose()) * (a * b) + h22 * (b * b);
    h.template block<3, 3>(0, 3) = h12 * (a * c) + h22 * (b * c);
    h.template block<3, 3>(3, 3) = h22 * (c * c);
  }

 private:
  template <class T>
  static Law<T> law(const Vector<T>* e, const T* rest) {
    return Law<T>(e[0] * rest[0], e[0] * rest[1] + e[1] * rest[2], rest[3], rest[4]);
  }
};

/// Binds the law to all triangles of the level. Throws std::runtime_error naming a triangle without area.
template <template <class> class Law>
std::unique_ptr<BoundEnergy> bind_membrane(const Level& level, const Material& material) {
  using Kernel = MembraneKernel<Law>;
  std::vector<typename Kernel::Rest> rest;
  for (int t = 0; t < level.triangle_count(); ++t)
    rest.push_back(Kernel::rest(RestTriangle::of(level, t), material));
  return std::make_unique<ElementEnergy<Kernel>>(level.rest.triangles, rest, level.triangle_order);
}

}  // namespace drape

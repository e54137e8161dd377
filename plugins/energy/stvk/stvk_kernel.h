#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace drape {

/// St. Venant–Kirchhoff energy of one triangle, a function of its edge vectors e₁ = x₁ - x₀, e₂ = x₂ - x₀:
/// A d ψ with ψ = μ tr(G²) + λ/2 (tr G)², G = (FᵀF - I)/2. T is double or a Pack.
struct StvkKernel {
  static constexpr int vertices = 3;
  static constexpr bool convex = false;
  using Rest =
      Eigen::Matrix<double, 5, 1>;  // inverse rest edges a, b, c (F = [a e₁, b e₁ + c e₂]), A d μ, A d λ
  template <class T>
  using Vector = Eigen::Matrix<T, 3, 1>;

  /// From the rest edge vectors [m], thickness [m], Young's modulus [Pa] and Poisson's ratio.
  static Rest rest(const Eigen::Vector3d& e1, const Eigen::Vector3d& e2, double thickness, double modulus,
                   double poisson_ratio) {
    // Edges in the triangle's own plane: e₁ = (p, 0), e₂ = (q, h).
    const double p = e1.norm(), q = e2.dot(e1) / p, h = e1.cross(e2).norm() / p;
    const double volume = p * h / 2 * thickness;
    Rest r;
    r << 1 / p, -q / (p * h), 1 / h, volume * modulus / (2 * (1 + poisson_ratio)),
        volume * modulus * poisson_ratio / (1 - poisson_ratio * poisson_ratio);
    return r;
  }

  template <class T>
  static T value(const Vector<T>* e, const T* rest) {
    return State<T>(e, rest).energy();
  }

  /// g receives the derivatives by e₁ and e₂; returns the energy.
  template <class T>
  static T gradient(const Vector<T>* e, const T* rest, Vector<T>* g) {
    const State<T> s(e, rest);
    const Vector<T> p1 = s.f1 * s.s11 + s.f2 * s.s12, p2 = s.f1 * s.s12 + s.f2 * s.s22;
    g[0] = p1 * rest[0] + p2 * rest[1];
    g[1] = p2 * rest[2];
    return s.energy();
  }

  /// The upper blocks of the 6×6 Hessian by (e₁, e₂).
  template <class T>
  static void hessian(const Vector<T>* e, const T* rest, Eigen::Matrix<T, 6, 6>& h) {
    const State<T> s(e, rest);
    // ∂P_i/∂F_j = S_ij I + μ (F_j F_iᵀ + δ_ij F Fᵀ) + λ F_i F_jᵀ.
    using Block = Eigen::Matrix<T, 3, 3>;
    const Block f11 = s.f1 * s.f1.transpose(), f22 = s.f2 * s.f2.transpose(), f12 = s.f1 * s.f2.transpose();
    const Block ff = (f11 + f22) * s.mu;
    Block h11 = f11 * (s.mu + s.lambda) + ff, h22 = f22 * (s.mu + s.lambda) + ff;
    Block h12 = f12.transpose() * s.mu + f12 * s.lambda;
    for (int i = 0; i < 3; ++i) h11(i, i) += s.s11, h22(i, i) += s.s22, h12(i, i) += s.s12;
    const T a = rest[0], b = rest[1], c = rest[2];
    h.template block<3, 3>(0, 0) = h11 * (a * a) + (h12 + h12.transpose()) * (a * b) + h22 * (b * b);
    h.template block<3, 3>(0, 3) = h12 * (a * c) + h22 * (b * c);
    h.template block<3, 3>(3, 3) = h22 * (c * c);
  }

 private:
  template <class T>
  struct State {
    T mu, lambda;      // times A d
    Vector<T> f1, f2;  // columns of F
    T g11, g12, g22;   // G
    T s11, s12, s22;   // S = 2 μ G + λ tr G I

    State(const Vector<T>* e, const T* rest) : mu(rest[3]), lambda(rest[4]) {
      f1 = e[0] * rest[0];
      f2 = e[0] * rest[1] + e[1] * rest[2];
      g11 = 0.5 * (f1.squaredNorm() - 1.0);
      g22 = 0.5 * (f2.squaredNorm() - 1.0);
      g12 = 0.5 * f1.dot(f2);
      const T pressure = lambda * (g11 + g22);
      s11 = 2.0 * mu * g11 + pressure;
      s22 = 2.0 * mu * g22 + pressure;
      s12 = 2.0 * mu * g12;
    }

    T energy() const {
      const T trace = g11 + g22;
      return mu * (g11 * g11 + g22 * g22 + 2.0 * g12 * g12) + 0.5 * lambda * trace * trace;
    }
  };
};

}  // namespace drape

#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace drape {

/// Plane-stress neo-Hookean energy of one triangle, a function of its edge vectors e₁ = x₁ - x₀, e₂ = x₂ -
/// x₀: A d ψ with ψ = μ/2 (tr C - 2 - 2 ln J) + λ/2 (ln J)², C = FᵀF, J = √det C. T is double or a Pack.
///
/// Everything is written in G = (C - I)/2, so that small strains lose no digits to the 1 in C.
struct NeoHookeanKernel {
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
    // P = F S, S = 2 ∂ψ/∂C = C⁻¹ (2 μ G + λ ln J I).
    const T k11 = 2.0 * s.mu * s.g11 + s.lambda * s.log_j, k22 = 2.0 * s.mu * s.g22 + s.lambda * s.log_j,
            k12 = 2.0 * s.mu * s.g12;
    const T s11 = s.a11 * k11 + s.a12 * k12, s12 = s.a11 * k12 + s.a12 * k22, s22 = s.a12 * k12 + s.a22 * k22;
    const Vector<T> p1 = s.f1 * s11 + s.f2 * s12, p2 = s.f1 * s12 + s.f2 * s22;
    g[0] = p1 * rest[0] + p2 * rest[1];
    g[1] = p2 * rest[2];
    return s.energy();
  }

  /// The upper blocks of the 6×6 Hessian by (e₁, e₂).
  template <class T>
  static void hessian(const Vector<T>* e, const T* rest, Eigen::Matrix<T, 6, 6>& h) {
    const State<T> s(e, rest);
    // ∂P_i/∂F_j = μ δ_ij I - m A_ij n nᵀ + m f^j (f^i)ᵀ + λ f^i (f^j)ᵀ, with A = C⁻¹, f^i = Σ_k A_ik F_k the
    // dual basis, n the unit normal, m = μ - λ ln J.
    using Block = Eigen::Matrix<T, 3, 3>;
    const T m = s.mu - s.lambda * s.log_j;
    const Vector<T> d1 = s.f1 * s.a11 + s.f2 * s.a12, d2 = s.f1 * s.a12 + s.f2 * s.a22;
    const Block nn = (s.normal * (m * s.inverse_det)) * s.normal.transpose();
    Block h11 = (d1 * (m + s.lambda)) * d1.transpose() - nn * s.a11;
    Block h22 = (d2 * (m + s.lambda)) * d2.transpose() - nn * s.a22;
    const Block h12 = (d2 * m) * d1.transpose() + (d1 * s.lambda) * d2.transpose() - nn * s.a12;
    for (int i = 0; i < 3; ++i) h11(i, i) += s.mu, h22(i, i) += s.mu;
    const T a = rest[0], b = rest[1], c = rest[2];
    h.template block<3, 3>(0, 0) = h11 * (a * a) + (h12 + h12.transpose()) * (a * b) + h22 * (b * b);
    h.template block<3, 3>(0, 3) = h12 * (a * c) + h22 * (b * c);
    h.template block<3, 3>(3, 3) = h22 * (c * c);
  }

 private:
  template <class T>
  struct State {
    T mu, lambda;                       // times A d
    Vector<T> f1, f2, normal;           // columns of F and F₁ × F₂
    T g11, g12, g22;                    // G
    T det, inverse_det, a11, a12, a22;  // det C and C⁻¹
    T log_j;                            // ln J

    State(const Vector<T>* e, const T* rest) : mu(rest[3]), lambda(rest[4]) {
      using std::log, std::min;
      f1 = e[0] * rest[0];
      f2 = e[0] * rest[1] + e[1] * rest[2];
      const T c11 = f1.squaredNorm(), c22 = f2.squaredNorm();
      g11 = 0.5 * (c11 - 1.0);
      g22 = 0.5 * (c22 - 1.0);
      g12 = 0.5 * f1.dot(f2);
      normal = f1.cross(f2);
      det = normal.squaredNorm();
      inverse_det = 1.0 / det;
      a11 = c22 * inverse_det;
      a22 = c11 * inverse_det;
      a12 = -2.0 * g12 * inverse_det;
      // det C - 1 exactly enough: near 1, the digits that `det` lost are put back to first order.
      const T det_minus_1 = 2.0 * (g11 + g22) + 4.0 * (g11 * g22 - g12 * g12);
      log_j = 0.5 * (log(det) + (det_minus_1 - (det - 1.0)) * min(det, inverse_det));
    }

    T energy() const { return mu * (g11 + g22 - log_j) + 0.5 * lambda * log_j * log_j; }
  };
};

}  // namespace drape

#pragma once

#include "core/numerics/elements/stretch.h"

namespace drape {

/// Derivatives of a law φ of one principal stretch at σ₁ ≥ σ₂: φ', φ'' and (φ'(σ₁) - φ'(σ₂)) / (σ₁ - σ₂),
/// which is φ'' if σ₁ = σ₂.
template <class T>
struct StretchSlopes {
  T first1, first2, second1, second2, divided;
};

/// Slopes of an energy Φ(σ₁, σ₂) that is not a sum of two laws: by one stretch each, and ∂²Φ/∂σ₁∂σ₂.
template <class T>
struct CoupledSlopes : StretchSlopes<T> {
  T mixed;

  /// Sets `divided` from the other slopes at these stretches.
  void divide(const T& s1, const T& s2) {
    // Below this difference the quotient loses more digits than the derivative at equal stretches.
    const T difference = s1 - s2;
    const auto equal = difference < 1e-5;
    this->divided = select(equal, 0.5 * (this->second1 + this->second2) - mixed,
                           (this->first1 - this->first2) / select(equal, 1.0, difference));
  }
};

/// Derivatives by a triangle's edges of an energy that is given by principal stretches σ. They need only the
/// frame v₁, v₂, and stay accurate if stretches agree or vanish: with β = φ'/σ, q = (β₁ - β₂)/(σ₁² - σ₂²),
/// w = F v, the Hessian's blocks for δF v₁ and δF v₂ are
///     β₁ I + (φ₁'' - β₁)/σ₁² w₁w₁ᵀ + q w₂w₂ᵀ,   q w₂w₁ᵀ,   β₂ I + (φ₂'' - β₂)/σ₂² w₂w₂ᵀ + q w₁w₁ᵀ.
/// Divisors are bounded below by a stretch of 1e-6. `rest` has RestTriangle's a, b, c.
template <class T>
struct StretchDerivatives {
  using Vector = Eigen::Matrix<T, 3, 1>;

  /// g receives the derivatives by e₁ and e₂.
  [[gnu::always_inline]] static void gradient(const PrincipalStretch<T>& s, const StretchSlopes<T>& slopes,
                                              const T* rest, Vector* g) {
    const Vector p1 = s.w1 * (slopes.first1 / floored(s.largest)),
                 p2 = s.w2 * (slopes.first2 / floored(s.smallest));
    const Directions v(s, rest);
    g[0] = p1 * v.first1 + p2 * v.first2;
    g[1] = p1 * v.second1 + p2 * v.second2;
  }

  /// The upper blocks of the 6×6 Hessian by (e₁, e₂).
  template <class Slopes>
  [[gnu::always_inline]] static void hessian(const PrincipalStretch<T>& s, const Slopes& slopes,
                                             const T* rest, Eigen::Matrix<T, 6, 6>& h) {
    using Block = Eigen::Matrix<T, 3, 3>;
    const T s1 = floored(s.largest), s2 = floored(s.smallest);
    const T beta1 = slopes.first1 / s1, beta2 = slopes.first2 / s2;
    const T q = (slopes.divided - beta2) / (s1 * (s1 + s2));
    const Block w11 = s.w1 * s.w1.transpose(), w22 = s.w2 * s.w2.transpose();
    Block m11 = w11 * ((slopes.second1 - beta1) / (s1 * s1)) + w22 * q;
    Block m22 = w22 * ((slopes.second2 - beta2) / (s2 * s2)) + w11 * q;
    Block m12 = (s.w2 * q) * s.w1.transpose();
    if constexpr (requires { slopes.mixed; }) m12 += (s.w1 * (slopes.mixed / (s1 * s2))) * s.w2.transpose();
    for (int i = 0; i < 3; ++i) m11(i, i) += beta1, m22(i, i) += beta2;
    const Directions v(s, rest);
    h.template block<3, 3>(0, 0) = m11 * (v.first1 * v.first1) +
                                   (m12 + m12.transpose()) * (v.first1 * v.first2) +
                                   m22 * (v.first2 * v.first2);
    h.template block<3, 3>(0, 3) = m11 * (v.first1 * v.second1) + m12 * (v.first1 * v.second2) +
                                   m12.transpose() * (v.first2 * v.second1) + m22 * (v.first2 * v.second2);
    h.template block<3, 3>(3, 3) = m11 * (v.second1 * v.second1) +
                                   (m12 + m12.transpose()) * (v.second1 * v.second2) +
                                   m22 * (v.second2 * v.second2);
  }

  static T floored(const T& stretch) {
    using std::max;
    return max(stretch, T(1e-6));
  }

 private:
  /// F v₁ = first1 e₁ + second1 e₂, F v₂ = first2 e₁ + second2 e₂.
  struct Directions {
    T first1, second1, first2, second2;
    Directions(const PrincipalStretch<T>& s, const T* rest)
        : first1(rest[0] * s.cosine + rest[1] * s.sine),
          second1(rest[2] * s.sine),
          first2(rest[1] * s.cosine - rest[0] * s.sine),
          second2(rest[2] * s.cosine) {}
  };
};

/// Energy φ(σ₁) + φ(σ₂) of one triangle with principal stretches σ, for ElementEnergy. A Law has `constants`
/// (how many numbers each triangle has), `convex` (φ is convex and non-decreasing; then the energy is convex
/// in x) and, for T double or Pack,
///
///     T value(const T& s1, const T& s2, const T* constants);
///     StretchSlopes<T> slopes(const T& s1, const T& s2, const T* constants);
///
/// A symmetric function Φ(σ₁, σ₂) of both stretches has CoupledSlopes instead. Both are static, or const
/// members of a Law that holds numbers which all triangles share.
template <class Law>
struct StretchKernel {
  static constexpr int vertices = 3;
  static constexpr bool convex = Law::convex;
  using Rest = Eigen::Matrix<double, 3 + Law::constants, 1>;  ///< RestTriangle's a, b, c, then the Law's
  template <class T>
  using Vector = Eigen::Matrix<T, 3, 1>;

  [[no_unique_address]] Law law;

  template <class T>
  T value(const Vector<T>* e, const T* rest) const {
    return energy<T>(e, rest);
  }

  /// g receives the derivatives by e₁ and e₂; returns the energy.
  template <class T>
  T gradient(const Vector<T>* e, const T* rest, Vector<T>* g) const {
    const auto s = stretch(e, rest);
    StretchDerivatives<T>::gradient(s, law.slopes(s.largest, s.smallest, rest + 3), rest, g);
    return energy<T>(e, rest);
  }

  /// The upper blocks of the 6×6 Hessian by (e₁, e₂).
  template <class T>
  void hessian(const Vector<T>* e, const T* rest, Eigen::Matrix<T, 6, 6>& h) const {
    const auto s = stretch(e, rest);
    StretchDerivatives<T>::hessian(s, law.slopes(s.largest, s.smallest, rest + 3), rest, h);
  }

 private:
  // Out of line: value and gradient must return the same bits.
  template <class T>
  [[gnu::noinline]] T energy(const Vector<T>* e, const T* rest) const {
    const auto s = stretch(e, rest);
    return law.value(s.largest, s.smallest, rest + 3);
  }

  template <class T>
  static PrincipalStretch<T> stretch(const Vector<T>* e, const T* rest) {
    return PrincipalStretch<T>(e[0] * rest[0], e[0] * rest[1] + e[1] * rest[2]);
  }
};

}  // namespace drape

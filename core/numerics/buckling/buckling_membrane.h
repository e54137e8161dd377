#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "core/numerics/elements/element_energy.h"
#include "core/numerics/elements/green_strain.h"
#include "core/numerics/elements/stretch_kernel.h"

namespace drape {

/// A membrane's energy W [J] of a triangle by its principal stretches: W, ∂W/∂σ and ∂²W/∂σ².
template <class T>
struct PrincipalDerivatives {
  T energy, first1, first2, second1, second2, mixed;

  /// Newton's step in ln t2 towards ∂W/∂t2 = -s t2, for the function t2 ∂W/∂t2 + s t2², which is convex and
  /// rising for the usual laws.
  T log_step(const T& t2, const T& s) const {
    return -(first2 + s * t2) / (first2 + t2 * (second2 + 2.0 * s));
  }
  /// Newton's step in ln t where t1 = t2 = t.
  T both_log_step(const T& t, const T& s) const {
    return -(first2 + s * t) / (first2 + t * (second2 + mixed + 2.0 * s));
  }
};

/// An isotropic membrane on a level on which the cloth buckles below the mesh. Wrinkles that the triangle
/// cannot have take up a shortening A, under the stress σ at which they arise:
///
///     (1 - r) min_A [ W(G + A) + s tr A ] + r W(G),   s = A d σ,   0 ⪯ A,   C + 2 A ⪯ κ² C
///
/// This is the relaxed energy of tension field theory (Pipkin 1986) with a bending resistance left
/// (docs/theory/locking.md). Wrinkles shorten the cloth by κ at most, beyond which the triangle resists as
/// the law does at κ times its stretches: a law that resists collapse keeps doing so. The remainder r leaves
/// a stiffness where wrinkles have none.
///
/// The law is isotropic, so the minimum has the axes of C. Each stretch σ becomes τ, which is σ (taut), κ σ
/// (fully wrinkled), or in between (wrinkled), where the second Piola–Kirchhoff stress is -s. First
/// derivatives follow from the envelope theorem, second ones by elimination of the wrinkled τ.
///
/// Law is callable with two stretches t1 and t2 and returns PrincipalDerivatives of W.
template <class T>
class Buckling {
 public:
  /// κ [1]: of a fold that turns by half a circle, over its chord.
  static constexpr double largest_shortening = std::numbers::pi / 2;
  static constexpr double most = largest_shortening * largest_shortening;  ///< κ² [1]
  static constexpr double remainder = 0.01;                                ///< r [1]

  /// At stretches s1 ≥ s2, with s [J] and both_wrinkled(law, s).
  template <class Law>
  Buckling(const Law& law, const T& s1_in, const T& s2_in, const T& s_in, const T& both)
      : s1(s1_in), s2(s2_in), s(s_in), t1(s1), t2(s2), k1(1.0), k2(1.0), plain(law(s1, s2)), at(plain) {
    using std::max, std::min;
    constexpr double kappa = largest_shortening;
    const T floor = max(s1, both);
    const auto compressed = (floor > s1) | (plain.first2 + s * s2 < 0.0);
    if (!any(compressed)) return;
    const T free2 = wrinkled(law, floor, compressed), most1 = kappa * s1, most2 = kappa * s2;
    t1 = floor;
    t2 = select(compressed, min(max(free2, s2), most2), s2);
    const auto full = compressed & (free2 > most2);
    if (any(full)) t1 = select(full, min(max(wrinkled(law, t2, full), s1), most1), t1);
    at = law(t1, t2);
    const auto slope = [&](const T& t, const T& stretch, const T& most) {
      const T wrinkles = select(t == most, T(kappa), 0.0);
      return select(t == stretch, 1.0, wrinkles);
    };
    k1 = slope(t1, s1, most1);
    k2 = slope(t2, s2, most2);
  }

  /// The stretch of both axes if both wrinkle.
  template <class Law>
  static T both_wrinkled(const Law& law, const T& s) {
    T stretch = 1;
    iterate([&] { return law(stretch, stretch).both_log_step(stretch, s); }, stretch, true);
    return stretch;
  }

  T value() const {
    const T wrinkles = 0.5 * s * (t1 * t1 - s1 * s1 + t2 * t2 - s2 * s2);
    return (1 - remainder) * (at.energy + wrinkles) + remainder * plain.energy;
  }

  CoupledSlopes<T> slopes() const {
    const T m11 = at.second1 + s, m22 = at.second2 + s;
    const T zero = 0.0, square = at.mixed * at.mixed;
    const T eliminated2 = select(k2 == 0.0, square / m22, zero);
    const T eliminated1 = select(k1 == 0.0, square / m11, zero);
    const auto blend = [](const T& buckling, const T& own) {
      return (1 - remainder) * buckling + remainder * own;
    };
    CoupledSlopes<T> slopes;
    // Where an axis is taut the terms of s are exactly 0.
    slopes.first1 = blend(k1 * at.first1 + s * (k1 * t1 - s1), plain.first1);
    slopes.first2 = blend(k2 * at.first2 + s * (k2 * t2 - s2), plain.first2);
    slopes.second1 = blend(k1 * k1 * (at.second1 - eliminated2) + s * (k1 * k1 - 1.0), plain.second1);
    slopes.second2 = blend(k2 * k2 * (at.second2 - eliminated1) + s * (k2 * k2 - 1.0), plain.second2);
    slopes.mixed = blend(k1 * k2 * at.mixed, plain.mixed);
    slopes.divide(s1, s2);
    return slopes;
  }

 private:
  /// Multiplies `stretch` by about exp(step()), until a step is small in all lanes that count.
  template <class Step, class Mask>
  static void iterate(const Step& step, T& stretch, const Mask& counts) {
    using std::abs, std::max, std::min;
    constexpr int max_iterations = 20;
    for (int i = 0; i < max_iterations; ++i) {
      const T d = min(max(step(), T(-1.0)), T(1.0));
      stretch *= (1.0 + 0.5 * d) / (1.0 - 0.5 * d);
      if (!any(counts & (abs(d) > 1e-8))) return;
    }
  }

  /// τ of one axis that wrinkles, where the other's is `other`.
  template <class Law, class Mask>
  T wrinkled(const Law& law, const T& other, const Mask& counts) const {
    T stretch = 1.0;
    iterate([&] { return law(other, stretch).log_step(stretch, s); }, stretch, counts);
    return stretch;
  }

  /// Stretches t at the minimum over A, their derivatives k = ∂t/∂σ at fixed wrinkles of the other axis (1
  /// taut, 0 wrinkled, κ fully wrinkled), and the law at σ and there.
  T s1, s2, s, t1, t2, k1, k2;
  PrincipalDerivatives<T> plain, at;
};

/// A law that buckles below the mesh, for StretchKernel. Plain has `constants` (how many numbers each
/// triangle has) and is callable with two stretches and these numbers; it returns PrincipalDerivatives.
template <class Plain>
struct BucklingLaw {
  /// Plain's, then s [J], and the stretch τ of both axes wrinkled [1].
  static constexpr int constants = Plain::constants + 2;
  static constexpr bool convex = false;

  [[no_unique_address]] Plain plain;

  /// From Plain's constants and a bound s [J].
  Eigen::Matrix<double, constants, 1> constants_of(const double* own, double s) const {
    Eigen::Matrix<double, constants, 1> all;
    for (int i = 0; i < Plain::constants; ++i) all[i] = own[i];
    all[constants - 2] = s;
    all[constants - 1] = Buckling<double>::both_wrinkled(at(own), s);
    return all;
  }

  template <class T>
  T value(const T& s1, const T& s2, const T* c) const {
    return state(s1, s2, c).value();
  }
  template <class T>
  CoupledSlopes<T> slopes(const T& s1, const T& s2, const T* c) const {
    return state(s1, s2, c).slopes();
  }

 private:
  template <class T>
  auto at(const T* c) const {
    return [this, c](const T& t1, const T& t2) { return plain(t1, t2, c); };
  }
  template <class T>
  Buckling<T> state(const T& s1, const T& s2, const T* c) const {
    return Buckling<T>(at(c), s1, s2, c[constants - 2], c[constants - 1]);
  }
};

/// Binds a law of StretchKernel to all triangles of a level; constants_of(t) are those of triangle t. Throws
/// std::runtime_error naming a triangle without area.
template <class Law, class Constants>
std::unique_ptr<BoundEnergy> bind_stretches(const Law& law, const Level& level,
                                            const Constants& constants_of) {
  using Kernel = StretchKernel<Law>;
  std::vector<typename Kernel::Rest> rest;
  for (int t = 0; t < level.triangle_count(); ++t) {
    const RestTriangle triangle = RestTriangle::of(level, t);
    rest.emplace_back() << triangle.a, triangle.b, triangle.c, constants_of(t);
  }
  return std::make_unique<ElementEnergy<Kernel>>(level.rest.triangles, rest, level.triangle_order,
                                                 Kernel{law});
}

/// Binds a law to all triangles of a level on which the cloth buckles below the mesh. Plain's constants are
/// the numbers of a MaterialTriangle from its area on; s [J] as in Buckling, times
/// the level's factors.
template <class Plain>
std::unique_ptr<BoundEnergy> bind_buckling_membrane(const Plain& plain,
                                                    const std::vector<MaterialTriangle>& triangles,
                                                    const Level& level, double s) {
  const BucklingLaw<Plain> law{plain};
  return bind_stretches(law, level, [&](int t) {
    return law.constants_of(triangles[t].data() + 4, s * level.bound_factor(t));
  });
}

}  // namespace drape

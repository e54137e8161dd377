#pragma once

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "core/numerics/formulas/membrane_formula.h"
#include "tests/support/kernel_check.h"

/// Properties of every membrane that buckles below the mesh (core/numerics/buckling/buckling_membrane.h), for
/// one triangle.
template <class Law>
class BucklingCheck {
  using Buckling = drape::BucklingLaw<drape::PrincipalFormula<Law>>;
  using Kernel = drape::StretchKernel<Buckling>;
  using Plain = drape::MembraneFormulaKernel<Law, 5>;
  using Check = KernelCheck<Kernel>;
  using PlainCheck = KernelCheck<Plain>;
  using State = typename Check::State;

  static constexpr double kappa = drape::Buckling<double>::largest_shortening,
                          remainder = drape::Buckling<double>::remainder;
  const Eigen::Vector3d rest1_{0.9, 0.2, 0.1}, rest2_{0.1, 1.1, -0.3};
  const drape::RestTriangle triangle_ = drape::RestTriangle::of(rest1_, rest2_);
  drape::Material material_;
  typename Plain::Rest plain_;

 public:
  BucklingCheck() {
    material_.thickness = 3e-4;
    material_.membrane_modulus = 8e4;
    material_.poisson_ratio = 0.3;
    // The material's first axis is the first edge.
    plain_ << triangle_.a, 0, triangle_.b, triangle_.c, triangle_.area;
    const Law law({}, material_);
    PlainCheck::kernel() = {law};
    Check::kernel() = {law_of(law)};
  }

  void run() const {
    derivatives();
    boundaries();
    plain_in_tension_and_for_large_bounds();
    tension_field();
    bounded_stress();
    minimum();
    collapse();
  }

 private:
  static Buckling law_of(const Law& law) { return {{law}}; }
  const Buckling& law() const { return Check::kernel().law; }
  double stiffness() const {
    return triangle_.area * law().plain.law.thickness * law().plain.law.mu;
  }  // A d μ [J]

  typename Kernel::Rest rest(double s) const {
    typename Kernel::Rest r;
    const double own[] = {triangle_.area, 0, 0, 0};
    r << triangle_.a, triangle_.b, triangle_.c, law().constants_of(own, s);
    return r;
  }

  /// The edges whose principal stretches are s1 and s2, the first along `angle` in the rest triangle.
  State state(double s1, double s2, double angle = 0.4) const {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    const Eigen::Rotation2Dd v(angle);
    const Eigen::Matrix2d plane =
        v.toRotationMatrix() * Eigen::Vector2d(s1, s2).asDiagonal() * v.toRotationMatrix().transpose();
    const Eigen::Matrix<double, 3, 2> f = turn.leftCols<2>() * plane;
    State x;
    x << f.col(0) / triangle_.a, (f.col(1) - f.col(0) / triangle_.a * triangle_.b) / triangle_.c;
    return x;
  }

  /// Taut, one axis wrinkled, both, one fully, one fully and the other wrinkled, both fully, and equal ones.
  static std::vector<Eigen::Vector2d> stretches() {
    return {{1.06, 1.03}, {1.05, 0.8}, {0.96, 0.85}, {1.2, 0.3},
            {0.9, 0.3},   {0.4, 0.3},  {0.9, 0.9},   {1.02, 1.02}};
  }

  void derivatives() const {
    for (const double bound : {0.0, 1e-3, 0.02})
      for (const auto& s : stretches()) {
        INFO("s = " << bound << " of the stiffness, stretches " << s.transpose());
        const auto r = rest(bound * stiffness());
        const State x = state(s[0], s[1]);
        Check::derivatives(x, r, 1e-5, 2e-7);
        Check::template projections<double>(x, r);
      }
  }

  /// Value and stress pass each boundary between branches without a jump, along a line through all of them.
  void boundaries() const {
    const auto r = rest(0.01 * stiffness());
    int kinks = 0;
    for (const Eigen::Vector2d& end : {Eigen::Vector2d(1.04, 0.2), Eigen::Vector2d(0.3, 0.25)}) {
      const int n = 4000;
      auto last = Check::evaluate(state(1.05, 1.02), r);
      for (int i = 1; i <= n; ++i) {
        const Eigen::Vector2d s =
            Eigen::Vector2d(1.05, 1.02) + double(i) / n * (end - Eigen::Vector2d(1.05, 1.02));
        const State x = state(s[0], s[1]),
                    dx = x - state(s[0] - (end[0] - 1.05) / n, s[1] - (end[1] - 1.02) / n);
        const auto now = Check::evaluate(x, r);
        const double largest = std::max(now.hessian.norm(), last.hessian.norm());
        CHECK((now.gradient - last.gradient).norm() <= 1.1 * largest * dx.norm());
        CHECK(std::abs(now.value - last.value - 0.5 * (now.gradient + last.gradient).dot(dx)) <=
              largest * dx.squaredNorm());
        kinks += (now.hessian - last.hessian).norm() > 0.1 * largest;
        last = now;
      }
    }
    CHECK(kinks >= 3);
  }

  void plain_in_tension_and_for_large_bounds() const {
    const auto equal = [&](const Eigen::Vector2d& s, double bound) {
      const State x = state(s[0], s[1]);
      const auto buckling = Check::evaluate(x, rest(bound * stiffness()));
      const auto plain = PlainCheck::evaluate(x, plain_);
      CHECK(buckling.value == Approx(plain.value).epsilon(1e-11).margin(1e-14 * stiffness()));
      CHECK((buckling.gradient - plain.gradient).norm() <= 1e-12 * stiffness());
      CHECK((buckling.hessian - plain.hessian).norm() <= 1e-10 * plain.hessian.norm());
    };
    for (const double bound : {0.0, 1e-3, 0.1}) equal({1.06, 1.03}, bound);
    for (const auto& s : stretches()) equal(s, 1e9);
  }

  /// Without a bound and in the limit of no remainder a wrinkled triangle has the energy of uniaxial tension,
  /// and none if both axes wrinkle.
  void tension_field() const {
    const auto buckling = [&](double s1, double s2) {
      const State x = state(s1, s2);
      return (Check::evaluate(x, rest(0)).value - remainder * PlainCheck::evaluate(x, plain_).value) /
             (1 - remainder);
    };
    double uniaxial = std::numeric_limits<double>::infinity();
    for (double width = 0.9; width < 1; width += 1e-5)
      uniaxial = std::min(uniaxial, PlainCheck::evaluate(state(1.05, width), plain_).value);
    CHECK(buckling(1.05, 0.7) == Approx(uniaxial).epsilon(1e-6));
    CHECK(buckling(1.05, 0.65) == Approx(buckling(1.05, 0.7)).epsilon(1e-9));
    CHECK(std::abs(buckling(0.9, 0.7)) <= 1e-14 * stiffness());
  }

  /// The second Piola–Kirchhoff stress of a wrinkled axis is -s, but for the remainder's.
  void bounded_stress() const {
    const double s = 0.01 * stiffness();
    const typename Kernel::Rest r = rest(s);
    const double t1 = 1.05, t2 = 0.8;
    const auto slopes = law().slopes(t1, t2, r.data() + 3);
    const auto plain = law().slopes(t1, t2, rest(1e9 * stiffness()).eval().data() + 3);
    CHECK((slopes.first2 - remainder * plain.first2) / (1 - remainder) == Approx(-s * t2).epsilon(1e-12));
    CHECK(std::abs(plain.first2) > 10 * std::abs(slopes.first2));
    CHECK(slopes.first1 > 0);
  }

  static bool positive(const Eigen::Matrix2d& m) { return m.trace() >= -1e-12 && m.determinant() >= -1e-12; }

  /// The energy is the smallest over all shortenings, whatever their axes.
  void minimum() const {
    const double s = 0.01 * stiffness();
    for (const auto& p : stretches()) {
      const State x = state(p[0], p[1], 0);
      const double own = PlainCheck::evaluate(x, plain_).value;
      const double found = (Check::evaluate(x, rest(s)).value - remainder * own) / (1 - remainder);
      double smallest = own;
      for (int i = 0; i <= 150; ++i)
        for (int j = 0; j <= 150; ++j)
          for (const double angle : {0.0, 0.05, 0.3}) {
            // C + 2 A with eigenvalues t, turned by `angle` from the axes of C, where the constraints allow
            // it.
            const Eigen::Vector2d t = p + (kappa - 1) / 150 * p.cwiseProduct(Eigen::Vector2d(i, j));
            const Eigen::Rotation2Dd v(angle);
            const Eigen::Matrix2d whole = v.toRotationMatrix() * Eigen::Vector2d(t.cwiseAbs2()).asDiagonal() *
                                          v.toRotationMatrix().transpose();
            const Eigen::Matrix2d c = Eigen::Vector2d(p.cwiseAbs2()).asDiagonal(), a = (whole - c) / 2;
            if (!positive(a) || !positive(kappa * kappa * c - whole)) continue;
            smallest = std::min(smallest,
                                PlainCheck::evaluate(state(t[0], t[1], angle), plain_).value + s * a.trace());
          }
      INFO("stretches " << p.transpose());
      CHECK(found <= smallest + 1e-12 * stiffness());
      CHECK(found >= smallest - 2e-3 * stiffness());
    }
  }

  /// A triangle on its way to collapse resists at least as its law does at κ times the stretches.
  void collapse() const {
    for (const double width : {1e-2, 1e-4, 1e-6}) {
      const double own = PlainCheck::evaluate(state(1, kappa * width), plain_).value;
      CHECK(Check::evaluate(state(1, width), rest(0)).value >= 0.8 * own);
    }
  }
};

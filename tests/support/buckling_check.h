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
  const drape::RestTriangle triangle_ = drape::RestTriangle::of({0.9, 0.2, 0.1}, {0.1, 1.1, -0.3});
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
    Check::kernel() = {Buckling{{law}}};
  }

  void run() const {
    derivatives();
    boundaries();
    plain_in_tension_and_for_large_bounds();
    tension_field();
    minimum();
    collapse();
  }

 private:
  const Buckling& law() const { return Check::kernel().law; }
  /// A d μ [J].
  double stiffness() const { return triangle_.area * law().plain.law.thickness * law().plain.law.mu; }

  typename Kernel::Rest rest(double s) const {
    typename Kernel::Rest r;
    const double own[] = {triangle_.area, 0, 0, 0};
    r << triangle_.a, triangle_.b, triangle_.c, law().constants_of(own, s);
    return r;
  }

  /// The symmetric matrix with these eigenvalues, the first along `angle`.
  static Eigen::Matrix2d turned(const Eigen::Vector2d& values, double angle) {
    const Eigen::Matrix2d v = Eigen::Rotation2Dd(angle).toRotationMatrix();
    return v * values.asDiagonal() * v.transpose();
  }

  /// The edges with these principal stretches, the first along `angle` in the rest triangle.
  State state(const Eigen::Vector2d& stretches, double angle = 0.4) const {
    const Eigen::AngleAxisd turn(0.8, Eigen::Vector3d(1, 2, -1).normalized());
    const Eigen::Matrix<double, 3, 2> f = turn.toRotationMatrix().leftCols<2>() * turned(stretches, angle);
    State x;
    x << f.col(0) / triangle_.a, (f.col(1) - f.col(0) / triangle_.a * triangle_.b) / triangle_.c;
    return x;
  }

  /// Energy of the plain law, and without its part in that of the membrane which buckles.
  double plain(const Eigen::Vector2d& stretches, double angle = 0.4) const {
    return PlainCheck::evaluate(state(stretches, angle), plain_).value;
  }
  double buckled(const Eigen::Vector2d& stretches, double s, double angle = 0.4) const {
    const double all = Check::evaluate(state(stretches, angle), rest(s)).value;
    return (all - remainder * plain(stretches, angle)) / (1 - remainder);
  }

  /// Taut, one axis wrinkled, both, one fully, one fully and the other wrinkled, both fully, and equal ones.
  static std::vector<Eigen::Vector2d> stretches() {
    return {{1.06, 1.03}, {1.05, 0.8}, {0.96, 0.85}, {1.2, 0.3},
            {0.9, 0.3},   {0.4, 0.3},  {0.9, 0.9},   {1.02, 1.02}};
  }

  void derivatives() const {
    for (const double bound : {0.0, 1e-3, 0.02})
      for (const Eigen::Vector2d& s : stretches()) {
        INFO("s = " << bound << " of the stiffness, stretches " << s.transpose());
        Check::derivatives(state(s), rest(bound * stiffness()), 1e-5, 2e-7);
        Check::template projections<double>(state(s), rest(bound * stiffness()));
      }
  }

  /// Value and stress pass each boundary between branches without a jump, along a line through all of them.
  void boundaries() const {
    const auto r = rest(0.01 * stiffness());
    const Eigen::Vector2d start(1.05, 1.02);
    int kinks = 0;
    for (const Eigen::Vector2d& end : {Eigen::Vector2d(1.04, 0.2), Eigen::Vector2d(0.3, 0.25)}) {
      const int n = 4000;
      auto last = Check::evaluate(state(start), r);
      for (int i = 1; i <= n; ++i) {
        const Eigen::Vector2d s = start + double(i) / n * (end - start);
        const State dx = state(s) - state(s - (end - start) / n);
        const auto now = Check::evaluate(state(s), r);
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
      const auto found = Check::evaluate(state(s), rest(bound * stiffness()));
      const auto own = PlainCheck::evaluate(state(s), plain_);
      CHECK(found.value == Approx(own.value).epsilon(1e-11).margin(1e-14 * stiffness()));
      CHECK((found.gradient - own.gradient).norm() <= 1e-12 * stiffness());
      CHECK((found.hessian - own.hessian).norm() <= 1e-10 * own.hessian.norm());
    };
    for (const double bound : {0.0, 1e-3, 0.1}) equal({1.06, 1.03}, bound);
    for (const Eigen::Vector2d& s : stretches()) equal(s, 1e9);
  }

  /// Without a bound and in the limit of no remainder a wrinkled triangle has the energy of uniaxial tension,
  /// and none if both axes wrinkle.
  void tension_field() const {
    double uniaxial = std::numeric_limits<double>::infinity();
    for (double width = 0.9; width < 1; width += 1e-5) uniaxial = std::min(uniaxial, plain({1.05, width}));
    CHECK(buckled({1.05, 0.7}, 0) == Approx(uniaxial).epsilon(1e-6));
    CHECK(buckled({1.05, 0.65}, 0) == Approx(buckled({1.05, 0.7}, 0)).epsilon(1e-9));
    CHECK(std::abs(buckled({0.9, 0.7}, 0)) <= 1e-14 * stiffness());
  }

  static bool positive(const Eigen::Matrix2d& m) { return m.trace() >= -1e-12 && m.determinant() >= -1e-12; }

  /// The energy is the smallest over all shortenings, whatever their axes.
  void minimum() const {
    const double s = 0.01 * stiffness();
    for (const Eigen::Vector2d& p : stretches()) {
      double smallest = plain(p, 0);
      for (int i = 0; i <= 150; ++i)
        for (int j = 0; j <= 150; ++j)
          for (const double angle : {0.0, 0.05, 0.3}) {
            // C + 2 A with eigenvalues t², turned by `angle` from the axes of C, where the constraints allow.
            const Eigen::Vector2d t = p + (kappa - 1) / 150 * p.cwiseProduct(Eigen::Vector2d(i, j));
            const Eigen::Matrix2d whole = turned(t.cwiseAbs2(), angle), c = turned(p.cwiseAbs2(), 0),
                                  a = (whole - c) / 2;
            if (!positive(a) || !positive(kappa * kappa * c - whole)) continue;
            smallest = std::min(smallest, plain(t, angle) + s * a.trace());
          }
      INFO("stretches " << p.transpose());
      CHECK(buckled(p, s, 0) <= smallest + 1e-12 * stiffness());
      CHECK(buckled(p, s, 0) >= smallest - 2e-3 * stiffness());
    }
  }

  /// A triangle on its way to collapse resists at least as its law does at κ times the stretches.
  void collapse() const {
    for (const double width : {1e-2, 1e-4, 1e-6})
      CHECK(Check::evaluate(state({1, width}), rest(0)).value >= 0.8 * plain({1, kappa * width}));
  }
};

#pragma once

#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <functional>
#include <random>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/elements/element_energy.h"
#include "tests/support/decompositions.h"
#include "tests/support/evaluate.h"

// What every element kernel owes (see core/numerics/elements/element_energy.h), for one state of one element.
// A state is the column of its differences x_i - x_0.

template <class Kernel>
struct KernelCheck {
  static constexpr int n = 3 * (Kernel::vertices - 1);
  using Rest = typename Kernel::Rest;
  using State = Eigen::Matrix<double, n, 1>;
  /// To be set for a kernel that holds numbers of its own.
  static Kernel& kernel() {
    static Kernel own{};
    return own;
  }
  using Hessian = Eigen::Matrix<double, n, n>;

  /// Value, gradient and (mirrored) Hessian.
  template <class T>
  struct Result {
    T value, gradient_value;
    Eigen::Matrix<T, n, 1> gradient;
    Eigen::Matrix<T, n, n> hessian;
  };
  template <class T>
  [[gnu::noinline]] static Result<T> evaluate(const Eigen::Matrix<T, n, 1>& x, const T* rest) {
    Eigen::Matrix<T, 3, 1> d[n / 3], g[n / 3];
    for (int i = 0; i < n; ++i) d[i / 3][i % 3] = x[i];
    Result<T> r;
    r.value = kernel().value(d, rest);
    r.gradient_value = kernel().gradient(d, rest, g);
    for (int i = 0; i < n; ++i) r.gradient[i] = g[i / 3][i % 3];
    kernel().hessian(d, rest, r.hessian);
    for (int j = 0; j < n; ++j)
      for (int i = j + 1; i < n; ++i) r.hessian(i, j) = r.hessian(j, i);
    return r;
  }

  static Result<double> evaluate(const State& x, const Rest& rest) {
    return evaluate<double>(x, rest.data());
  }

  /// ∂f/∂x by central differences of fourth order.
  template <class Function>
  static Eigen::MatrixXd differences(const Function& f, const State& x, double h) {
    Eigen::MatrixXd result;
    for (int i = 0; i < n; ++i) {
      const State step = State::Unit(i) * h;
      const Eigen::VectorXd d =
          (8 * (f(x + step) - f(x - step)) - (f(x + 2 * step) - f(x - 2 * step))) / (12 * h);
      result.conservativeResize(d.size(), n);
      result.col(i) = d;
    }
    return result;
  }

  /// Gradient and Hessian against differences with step h, to `tolerance` of their norms.
  static void derivatives(const State& x, const Rest& rest, double h, double tolerance) {
    const auto r = evaluate(x, rest);
    REQUIRE(r.gradient.norm() > 0);
    REQUIRE(r.hessian.norm() > 0);
    CHECK(r.gradient_value == r.value);
    const auto value = [&](const State& y) { return Eigen::VectorXd::Constant(1, evaluate(y, rest).value); };
    const auto gradient = [&](const State& y) { return Eigen::VectorXd(evaluate(y, rest).gradient); };
    CHECK((differences(value, x, h).transpose() - r.gradient).norm() <= tolerance * r.gradient.norm());
    CHECK((differences(gradient, x, h) - r.hessian).norm() <= tolerance * r.hessian.norm());
  }

  /// Every lane of a Pack<W> against double. `value_scale` is what the value's error is measured by.
  template <int W>
  static void lanes(const State& x, const Rest& rest, double value_scale) {
    using T = drape::Pack<W>;
    Eigen::Matrix<T, n, 1> xs;
    T rests[Rest::SizeAtCompileTime];
    for (int i = 0; i < Rest::SizeAtCompileTime; ++i) rests[i] = rest[i];
    for (int lane = 0; lane < W; ++lane)
      for (int i = 0; i < n; ++i) xs[i].v[lane] = (1 + 0.01 * lane) * x[i];
    const auto all = evaluate<T>(xs, rests);
    for (int lane = 0; lane < W; ++lane) {
      const State own = (1 + 0.01 * lane) * x;
      const auto one = evaluate(own, rest);
      State g;
      Hessian h;
      for (int i = 0; i < n; ++i) g[i] = all.gradient[i][lane];
      for (int i = 0; i < n * n; ++i) h.data()[i] = all.hessian.data()[i][lane];
      CHECK(std::abs(all.value[lane] - one.value) <= 1e-13 * value_scale);
      CHECK((g - one.gradient).norm() <= 1e-13 * std::max(one.gradient.norm(), value_scale / own.norm()));
      CHECK((h - one.hessian).norm() <= 1e-13 * one.hessian.norm());
    }
  }

  /// Every width that this machine has registers for; Eigen's arrays are not aligned for wider ones.
  static void all_lanes(const State& x, const Rest& rest, double value_scale) {
    lanes<2>(x, rest, value_scale);
    if constexpr (drape::native_pack_width >= 4) lanes<4>(x, rest, value_scale);
    if constexpr (drape::native_pack_width >= 8) lanes<8>(x, rest, value_scale);
  }

  /// The full matrix by the k vertices.
  static Eigen::MatrixXd by_vertices(const Hessian& h) {
    Eigen::MatrixXd e = Eigen::MatrixXd::Zero(n, n + 3);
    for (int i = 0; i < n; ++i) e(i, i + 3) = 1, e(i, i % 3) = -1;
    return e.transpose() * h * e;
  }

  /// Projections against Eigen's eigenvalues of the full matrix, or of what else `matrix_of` makes of the
  /// Hessian by the differences, to 1e-10 of its norm; returns the smallest eigenvalue over the norm before.
  template <class T>
  static double projections(const State& x, const Rest& rest,
                            const std::function<Eigen::MatrixXd(const Hessian&)>& matrix_of = by_vertices) {
    const Hessian h = evaluate(x, rest).hessian;
    const Eigen::MatrixXd full = matrix_of(h);
    const Eigenpairs eigen = eigenpairs_of(full);
    using drape::Projection;
    for (const Projection projection :
         {Projection(Projection::clamp), Projection(Projection::absolute), Projection(Projection::none),
          Projection(Projection::clamp, 0.3), Projection(Projection::absolute, 0.2)}) {
      drape::SymmetricMatrix<n, T> a;
      Eigen::Matrix<T, 3, 1> d[n / 3];
      for (int i = 0; i < n; ++i) d[i / 3][i % 3] = x[i];
      T rests[Rest::SizeAtCompileTime];
      for (int i = 0; i < Rest::SizeAtCompileTime; ++i) rests[i] = rest[i];
      project(d, rests, projection, a);
      Hessian projected;
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) projected(i, j) = first_lane(a(i, j));
      Eigen::VectorXd values = eigen.values;
      const double blend = projection.blend;
      if (projection.kind == Projection::clamp) values = (1 - blend) * values + blend * values.cwiseMax(0);
      if (projection.kind == Projection::absolute) values = (1 - blend) * values + blend * values.cwiseAbs();
      const Eigen::MatrixXd expected = eigen.vectors * values.asDiagonal() * eigen.vectors.transpose();
      CHECK((matrix_of(projected) - expected).norm() <= 1e-10 * full.norm());
      if (projection.kind == Projection::none || blend < 1) continue;
      const double smallest = eigenvalues_of(matrix_of(projected))[0];
      CHECK(smallest >= -1e-12 * full.norm());
    }
    return eigen.values[0] / full.norm();
  }

 private:
  template <class T>
  [[gnu::noinline]] static void project(const Eigen::Matrix<T, 3, 1>* d, const T* rest,
                                        drape::Projection projection, drape::SymmetricMatrix<n, T>& a) {
    drape::projected_hessian(kernel(), d, rest, projection, a);
  }
  static double first_lane(double v) { return v; }
  template <int W>
  static double first_lane(drape::Pack<W> v) {
    return v[0];
  }
};

/// n independent normal numbers.
inline Eigen::VectorXd normal_numbers(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  return Eigen::VectorXd::NullaryExpr(n, [&] { return normal(random); });
}

/// Value, gradient and projected Hessian have the same bits with 1, 2 and 3 threads, and the gradient's value
/// is the value.
inline void check_threads(const drape::BoundEnergy& energy, const drape::Positions& x) {
  double value = 0;
  drape::Positions gradient;
  std::vector<double> hessian;
  for (const int threads : {1, 2, 3}) {
    drape::set_thread_count(threads);
    drape::Positions g = drape::Positions::Zero(x.rows(), 3);
    const double own = energy.value(x);
    CHECK(energy.add_gradient(x, g) == own);
    const std::vector<double> h = hessian_of(energy, x, drape::Projection::clamp).values;
    if (threads == 1) value = own, gradient = g, hessian = h;
    CHECK(own == value);
    CHECK(g == gradient);
    CHECK(h == hessian);
  }
  drape::set_thread_count(0);
  REQUIRE(std::isfinite(value));
  REQUIRE(gradient.norm() > 0);
}

#pragma once

#include <Eigen/Core>
#include <catch2/catch.hpp>
#include <functional>
#include <random>

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

  struct Result {
    double value, gradient_value;
    State gradient;
    Hessian hessian;  ///< both triangles
  };
  [[gnu::noinline]] static Result evaluate(const State& x, const Rest& rest) {
    Eigen::Vector3d d[n / 3], g[n / 3];
    State::Map(d[0].data()) = x;
    Result r;
    r.value = kernel().value(d, rest.data());
    r.gradient_value = kernel().gradient(d, rest.data(), g);
    r.gradient = State::Map(g[0].data());
    kernel().hessian(d, rest.data(), r.hessian);
    r.hessian.template triangularView<Eigen::StrictlyLower>() = r.hessian.transpose();
    return r;
  }

  /// Gradient and Hessian against differences with step h, to `tolerance` of their norms.
  static void derivatives(const State& x, const Rest& rest, double h, double tolerance) {
    const auto r = evaluate(x, rest);
    REQUIRE(r.gradient.norm() > 0);
    REQUIRE(r.hessian.norm() > 0);
    CHECK(r.gradient_value == r.value);
    const auto value = [&](const State& y) { return evaluate(y, rest).value; };
    const auto gradient = [&](const State& y) { return evaluate(y, rest).gradient; };
    CHECK((differences(value, x, h).transpose() - r.gradient).norm() <= tolerance * r.gradient.norm());
    CHECK((differences(gradient, x, h) - r.hessian).norm() <= tolerance * r.hessian.norm());
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
      CHECK((matrix_of(projected) - recomposed(eigen, projection)).norm() <= 1e-10 * full.norm());
      if (projection.kind != Projection::none && projection.blend == 1)
        CHECK(eigenvalues_of(matrix_of(projected))[0] >= -1e-12 * full.norm());
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

/// Every coordinate moved by an independent normal number of this size [m].
inline drape::Positions shaken(const drape::Positions& x, double size, unsigned seed) {
  const Eigen::VectorXd noise = size * normal_numbers(static_cast<int>(x.size()), seed);
  return x + Eigen::Map<const drape::Positions>(noise.data(), x.rows(), 3);
}

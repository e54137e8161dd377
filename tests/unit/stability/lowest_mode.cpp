// The lowest mode of a pencil (A, B), against a dense decomposition.

#include "core/numerics/stability/lowest_mode.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <catch2/catch.hpp>

using namespace drape;

namespace {

constexpr int vertices = 40, unknowns = 3 * vertices;
constexpr ModeAccuracy accuracy{1e-9, 1e-12, 1e-4, 400};

Eigen::Map<const Eigen::VectorXd> as_vector(const Positions& x) { return {x.data(), x.size()}; }

LinearOperator times(const Eigen::MatrixXd& matrix) {
  return [&matrix](const Positions& x, Positions& y) {
    y.resize(x.rows(), 3);
    Eigen::Map<Eigen::VectorXd>(y.data(), y.size()) = matrix * as_vector(x);
  };
}

/// Q diag(values) Qᵀ with a random Q.
Eigen::MatrixXd with_eigenvalues(const Eigen::VectorXd& values, unsigned seed) {
  std::srand(seed);
  const Eigen::MatrixXd q =
      Eigen::HouseholderQR<Eigen::MatrixXd>(Eigen::MatrixXd::Random(unknowns, unknowns)).householderQ();
  return q * values.asDiagonal() * q.transpose();
}

Positions start() {
  std::srand(7);
  return Positions::Random(vertices, 3);
}

}  // namespace

TEST_CASE("The lowest mode is that of a dense decomposition") {
  Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(unknowns, 1, 1000);
  const double lowest = GENERATE(-50., -0.3, 0.2);
  values[0] = lowest;
  const Eigen::MatrixXd a = with_eigenvalues(values, 1),
                        b = with_eigenvalues(Eigen::VectorXd::LinSpaced(unknowns, 0.5, 2), 2);
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> dense(a, b);
  // The inverse of a matrix near A, as V-cycles give it.
  const Eigen::MatrixXd near = (a + 60 * Eigen::MatrixXd::Identity(unknowns, unknowns)).inverse();
  const LowestMode mode = lowest_mode(times(a), times(b), times(near), {start()}, accuracy);
  REQUIRE(mode.converged);
  CHECK(mode.value == Approx(dense.eigenvalues()[0]).epsilon(1e-6));
  const Eigen::VectorXd v = as_vector(mode.vector);
  CHECK(v.dot(b * v) == Approx(1));
  CHECK((a * v - mode.value * b * v).norm() < 1e-3 * (a * v).norm());
}

TEST_CASE("Modes of value 0, which move a body as a whole, do not hide one below them") {
  Eigen::VectorXd values = Eigen::VectorXd::LinSpaced(unknowns, 1, 1000);
  values.head(6).setZero();
  values[6] = -0.5;
  const Eigen::MatrixXd a = with_eigenvalues(values, 3), b = Eigen::MatrixXd::Identity(unknowns, unknowns);
  const Eigen::MatrixXd near =
      (with_eigenvalues(values.cwiseMax(0), 3) + 1e-6 * Eigen::MatrixXd::Identity(unknowns, unknowns))
          .inverse();
  const LowestMode mode = lowest_mode(times(a), times(b), times(near), {start()}, accuracy);
  CHECK(mode.value == Approx(-0.5).epsilon(1e-6));
}

TEST_CASE("What an operator leaves at zero stays there") {
  const Eigen::MatrixXd a = with_eigenvalues(Eigen::VectorXd::LinSpaced(unknowns, 1, 9), 4);
  const auto fixed = [](const LinearOperator& whole) -> LinearOperator {
    return [whole](const Positions& x, Positions& y) {
      whole(x, y);
      y.topRows(5).setZero();
    };
  };
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(unknowns, unknowns);
  Positions begin = start();
  begin.topRows(5).setZero();
  const LowestMode mode =
      lowest_mode(fixed(times(a)), fixed(times(identity)), fixed(times(identity)), {begin}, accuracy);
  CHECK(mode.vector.topRows(5).isZero(0));
  const Eigen::MatrixXd part = a.bottomRightCorner(unknowns - 15, unknowns - 15);
  CHECK(mode.converged);
  CHECK(mode.value ==
        Approx(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(part).eigenvalues()[0]).epsilon(1e-6));
}

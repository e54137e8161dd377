#include "core/numerics/linear_algebra/symmetric_eigen.h"

#include <catch2/catch.hpp>

#include "tests/support/kernel_check.h"

using namespace drape;

namespace {

/// V diag(values) Vᵀ with random orthonormal V.
Eigen::MatrixXd with_eigenvalues(const Eigen::VectorXd& values, unsigned seed) {
  const int n = static_cast<int>(values.size());
  const Eigen::MatrixXd a = normal_numbers(n * n, seed).reshaped(n, n);
  const Eigen::MatrixXd v = eigenpairs_of(a + a.transpose()).vectors;
  const Eigen::MatrixXd m = v * values.asDiagonal() * v.transpose();
  return (m + m.transpose()) / 2;
}

/// Random, repeated, tiny beside large, and vanishing eigenvalues.
std::vector<Eigen::MatrixXd> matrices(int size) {
  std::vector<Eigen::MatrixXd> all;
  for (unsigned seed = 1; seed <= 8; ++seed)
    all.push_back(with_eigenvalues(Eigen::VectorXd::Random(size), seed));
  const Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(size, -1, 1);
  all.push_back(with_eigenvalues(v.array().sign(), 10));
  all.push_back(with_eigenvalues(v.array().pow(15), 11));
  all.push_back(Eigen::MatrixXd::Zero(size, size));
  all.push_back(with_eigenvalues(-3 * Eigen::VectorXd::Unit(size, 0), 13));
  all.push_back(1e-20 * all[0]);
  all.push_back(1e20 * all[0]);
  all.push_back(Eigen::MatrixXd(Eigen::VectorXd::Random(size).asDiagonal()));
  return all;
}

template <int N, class T>
[[gnu::noinline]] void keep_positive(SymmetricMatrix<N, T>& a) {
  using std::max;
  map_eigenvalues(a, [](T eigenvalue) { return max(eigenvalue, T(0.0)); });
}

template <int N>
void check_map() {
  const auto all = matrices(N);
  const int count = static_cast<int>(all.size());
  for (int m = 0; m < count; ++m) {
    INFO("matrix " << m << " of size " << N);
    SymmetricMatrix<N, double> one(all[m]);
    SymmetricMatrix<N, Pack<4>> four;  // this one and those after it
    for (int j = 0; j < N; ++j)
      for (int i = 0; i <= j; ++i)
        for (int lane = 0; lane < 4; ++lane) four(i, j).v[lane] = all[(m + lane) % count](i, j);
    keep_positive(one);
    keep_positive(four);
    for (int lane = -1; lane < 4; ++lane) {
      const auto& original = all[(m + std::max(lane, 0)) % count];
      const Eigen::MatrixXd expected = recomposed(eigenpairs_of(original), Projection::clamp),
                            found = Eigen::MatrixXd::NullaryExpr(N, N, [&](Eigen::Index i, Eigen::Index j) {
                              return lane < 0 ? one(i, j) : four(i, j)[lane];
                            });
      CHECK((found - expected).norm() <= 1e-12 * original.norm());
    }
  }
}

}  // namespace

TEST_CASE("map_eigenvalues gives V f(Λ) Vᵀ, one matrix or one a lane") {
  check_map<2>();
  check_map<3>();
  check_map<6>();
  check_map<9>();
  // It ends, whatever it is given.
  SymmetricMatrix<3, double> a(Eigen::Matrix3d{{1, NAN, 0}, {NAN, 2, 0}, {0, 0, 1}});
  map_eigenvalues(a, [](double e) { return e; });
}

TEST_CASE("The certificate of positive semidefiniteness holds for every lane") {
  const auto certified = [](const Eigen::MatrixXd& m, double other_lane) {
    SymmetricMatrix<6, Pack<2>> a;
    for (int j = 0; j < 6; ++j)
      for (int i = 0; i <= j; ++i) {
        a(i, j).v[0] = i == j ? other_lane : 0;
        a(i, j).v[1] = m(i, j);
      }
    return positive_semidefinite(a);
  };
  Eigen::VectorXd values{{1, 2, 3, 0, 0, 0.5}};
  CHECK(certified(with_eigenvalues(values, 1), 1));
  CHECK_FALSE(certified(with_eigenvalues(values, 1), -1));
  for (const double negative : {-1e-10, -1e-6, -1.0}) {
    values[3] = negative;
    CHECK_FALSE(certified(with_eigenvalues(values, 1), 1));
  }
  CHECK_FALSE(certified(Eigen::MatrixXd::Constant(6, 6, NAN), 1));
}

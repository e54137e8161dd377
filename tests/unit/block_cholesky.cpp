#include "core/numerics/block_cholesky.h"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>

#include "tests/support/dense_matrix.h"

using namespace drape;

namespace {

/// A random symmetric positive definite block matrix over four-vertex elements along a chain.
BlockMatrix random_matrix(int vertices, unsigned seed) {
  Stencils stencils(vertices - 3, 4);
  for (int e = 0; e < stencils.rows(); ++e) stencils.row(e) << e + 3, e, e + 1, e + 2;
  const auto pattern = BlockPattern::of(vertices, {stencils});
  BlockMatrix matrix(pattern);
  const BlockSlots slots(*pattern, stencils);
  BlockSink sink(slots, matrix);
  std::srand(seed);
  for (int e = 0; e < stencils.rows(); ++e) {
    const Eigen::Matrix<double, 12, 12> r = Eigen::Matrix<double, 12, 12>::Random();
    const Eigen::Matrix<double, 12, 12> h = r * r.transpose();
    for (int b = 0; b < 4; ++b)
      for (int a = 0; a <= b; ++a) {
        const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> block = h.block<3, 3>(3 * a, 3 * b);
        sink.add(e, a, b, block.data());
      }
  }
  return matrix;
}

}  // namespace

TEST_CASE("Block Cholesky solves what a dense factorisation solves, fixed vertices left out", "[cholesky]") {
  const int n = 60;
  const std::vector<int> held = {0, 7, 59};
  const BlockMatrix a = random_matrix(n, 3);
  const Eigen::VectorXd shift = Eigen::VectorXd::LinSpaced(n, 0.5, 6);
  std::vector<char> fixed(n, 0);
  for (int v : held) fixed[v] = 1;
  BlockCholesky cholesky;
  cholesky.analyse(a.pattern, fixed);
  REQUIRE(cholesky.unknowns() == 3 * (n - 3));
  REQUIRE(cholesky.factorise(a, shift));
  const Positions b = Positions::Random(n, 3);
  Positions x;
  cholesky.solve(b, x);

  Eigen::MatrixXd d = dense(a);
  Eigen::VectorXd right(3 * n);
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) {
      d(3 * i + c, 3 * i + c) += shift[i];
      right[3 * i + c] = b(i, c);
    }
  for (int v : held)
    for (int k = 3 * v; k < 3 * v + 3; ++k) {
      d.row(k).setZero();
      d.col(k).setZero();
      d(k, k) = 1;
      right[k] = 0;
    }
  const Eigen::VectorXd expected = d.llt().solve(right);
  REQUIRE(expected.norm() > 0.1);
  for (int i = 0; i < n; ++i)
    for (int c = 0; c < 3; ++c) REQUIRE(x(i, c) == Approx(expected[3 * i + c]).margin(1e-10));
}

TEST_CASE("Block Cholesky keeps its analysis until the pattern or the fixed vertices change", "[cholesky]") {
  const BlockMatrix a = random_matrix(30, 1);
  std::vector<char> fixed(30, 0);
  BlockCholesky cholesky;
  cholesky.analyse(a.pattern, fixed);
  cholesky.analyse(a.pattern, fixed);
  REQUIRE(cholesky.analyses() == 1);
  fixed[4] = 1;
  cholesky.analyse(a.pattern, fixed);
  REQUIRE(cholesky.analyses() == 2);
  REQUIRE(cholesky.unknowns() == 87);
}

TEST_CASE("Block Cholesky refuses an indefinite matrix, and factorises it once it is shifted", "[cholesky]") {
  BlockMatrix a = random_matrix(30, 2);
  a.block(a.pattern->row_start[11])[4] = -50;
  BlockCholesky cholesky;
  cholesky.analyse(a.pattern, std::vector<char>(30, 0));
  REQUIRE_FALSE(cholesky.factorise(a, Eigen::VectorXd::Zero(30)));
  REQUIRE(cholesky.factorise(a, Eigen::VectorXd::Constant(30, 500)));
}

TEST_CASE("Block Cholesky with every vertex fixed has nothing to solve", "[cholesky]") {
  const BlockMatrix a = random_matrix(10, 2);
  BlockCholesky cholesky;
  cholesky.analyse(a.pattern, std::vector<char>(10, 1));
  REQUIRE(cholesky.factorise(a, Eigen::VectorXd::Zero(10)));
  Positions x;
  cholesky.solve(Positions::Random(10, 3), x);
  REQUIRE(x.isZero(0));
}

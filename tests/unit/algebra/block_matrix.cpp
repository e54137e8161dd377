#include "core/numerics/linear_algebra/block_matrix.h"

#include <Eigen/SparseCore>
#include <catch2/catch.hpp>
#include <set>

#include "core/numerics/linear_algebra/galerkin.h"
#include "tests/support/any_threads.h"
#include "tests/support/evaluate.h"
#include "tests/support/random_block_matrix.h"

using namespace drape;

TEST_CASE("A block pattern is the union of the elements' pairs") {
  const int n = 30;
  const std::vector<Stencils> stencils = {tangle(n, 25, 1), Stencils(0, 1), tangle(n, 15, 2).leftCols(3)};
  std::set<std::pair<int, int>> expected;
  for (int i = 0; i < n; ++i) expected.insert({i, i});
  for (const Stencils& s : stencils)
    for (int e = 0; e < s.rows(); ++e)
      for (int a = 0; a < s.cols(); ++a)
        for (int b = 0; b < s.cols(); ++b) expected.insert(std::minmax(s(e, a), s(e, b)));
  REQUIRE(expected.size() > 100);

  const auto pattern = BlockPattern::of(n, stencils);
  REQUIRE(pattern->rows() == n);
  REQUIRE(pattern->columns.size() == expected.size());
  int block = 0;
  for (int i = 0; i < n; ++i) {
    CHECK(pattern->row_start[i] == block);
    for (int j = i; j < n; ++j) {
      const bool has = expected.count({i, j});
      CHECK(pattern->find(i, j) == (has ? block : -1));
      if (has) CHECK(pattern->columns[block++] == j);
    }
  }
  CHECK(BlockPattern::of(3, {})->columns == std::vector<int>({0, 1, 2}));
}

TEST_CASE("A block matrix is multiplied as a dense one is, in place too") {
  BlockMatrix matrix = random_matrix(60, tangle(60, 90, 4), 6);
  Positions x = Positions::Random(60, 3), y;
  const Eigen::VectorXd product = dense(matrix) * flat(x);
  REQUIRE(product.norm() > 1);
  matrix.multiply(x, y);
  CHECK((flat(y) - product).norm() <= 1e-14 * product.norm());
  matrix.multiply(x, x);
  CHECK(x == y);
  matrix.set_zero();
  CHECK(dense(matrix).norm() == 0);
}

TEST_CASE("A block matrix multiplies with the same bits on any number of threads") {
  const int n = 4000;
  const BlockMatrix matrix = random_matrix(n, tangle(n, 6000, 4), 6);
  REQUIRE(matrix.pattern->blocks() > 30000);
  const Positions x = Positions::Random(n, 3);
  same_with_any_threads([&] {
    Positions y;
    matrix.multiply(x, y);
    return y;
  });
}

TEST_CASE("Misuse of block matrices is named") {
  const Stencils pairs{{0, 1}, {2, 3}}, repeated{{0, 2, 0}}, missing{{3, 0}};
  CHECK_THROWS_WITH(BlockPattern::of(3, {pairs}),
                    "block pattern: element 1 of 2 vertices has vertex 3, outside 0 … 2");
  CHECK_THROWS_WITH(BlockPattern::of(3, {repeated}),
                    "block pattern: element 0 of 3 vertices repeats vertex 0");
  const auto pattern = BlockPattern::of(4, {pairs});
  CHECK_THROWS_WITH(BlockSlots(*pattern, missing),
                    "block pattern has no block for vertices 3 and 0 of element 0");
  CHECK_THROWS_WITH(BlockPattern({0, 1, 3}, {0, 0, 1}),
                    Catch::Contains("row 1 must have its diagonal first"));
  CHECK_THROWS_WITH(BlockPattern({0, 2}, {0}), Catch::Contains("row starts"));
  Positions x(3, 3), y;
  CHECK_THROWS_WITH(BlockMatrix(pattern).multiply(x, y), "block matrix of 4 rows times 3 vectors");
}

TEST_CASE("The Galerkin product is the dense triple product") {
  const int fine = 40, coarse = 13;
  const BlockMatrix a = random_matrix(fine, 5);
  std::vector<Eigen::Triplet<double>> weights;
  for (int i = 0; i < fine; ++i)
    for (int k = 0; k < 3; ++k)
      weights.emplace_back(i, (i + 5 * k * (i % 3 + 1)) % coarse, 0.2 + 0.1 * k + 0.01 * i);
  ProlongationMatrix P(fine, coarse);
  P.setFromTriplets(weights.begin(), weights.end());
  const GalerkinProduct product(*a.pattern, P);
  BlockMatrix c(product.coarse_pattern());
  product.form(a, c);

  Eigen::MatrixXd P3 = Eigen::MatrixXd::Zero(3 * fine, 3 * coarse);
  for (const auto& w : weights)
    P3.block<3, 3>(3 * w.row(), 3 * w.col()) += w.value() * Eigen::Matrix3d::Identity();
  const Eigen::MatrixXd expected = P3.transpose() * dense(a) * P3;
  REQUIRE(expected.norm() > 1);
  REQUIRE((dense(c) - expected).norm() < 1e-12 * expected.norm());
}

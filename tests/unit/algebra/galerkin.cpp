#include "core/numerics/linear_algebra/galerkin.h"

#include <Eigen/SparseCore>
#include <catch2/catch.hpp>
#include <vector>

#include "tests/support/random_block_matrix.h"

using namespace drape;

TEST_CASE("The Galerkin product is the dense triple product", "[galerkin]") {
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
    for (int d = 0; d < 3; ++d) P3(3 * w.row() + d, 3 * w.col() + d) += w.value();
  const Eigen::MatrixXd expected = P3.transpose() * dense(a) * P3;
  REQUIRE(expected.norm() > 1);
  REQUIRE((dense(c) - expected).norm() < 1e-12 * expected.norm());
}

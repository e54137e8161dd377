#include "core/numerics/linear_algebra/galerkin.h"

#include <catch2/catch.hpp>

#include "tests/support/dense_matrix.h"

using namespace drape;

namespace {

ProlongationMatrix random_weights(int fine, int coarse) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < fine; ++i)
    for (int k = 0; k < 3; ++k)
      entries.emplace_back(i, (i + 5 * k * (i % 3 + 1)) % coarse, 0.2 + 0.1 * k + 0.01 * i);
  ProlongationMatrix P(fine, coarse);
  P.setFromTriplets(entries.begin(), entries.end());
  return P;
}

}  // namespace

TEST_CASE("The Galerkin product is the dense triple product", "[galerkin]") {
  const int fine = 40, coarse = 13;
  Stencils stencils(fine - 2, 3);
  for (int e = 0; e < stencils.rows(); ++e) stencils.row(e) << e + 2, e, e + 1;
  const auto pattern = BlockPattern::of(fine, {stencils});
  BlockMatrix a(pattern);
  std::srand(5);
  for (int i = 0; i < fine; ++i)
    for (int k = pattern->row_start[i]; k < pattern->row_start[i + 1]; ++k) {
      Eigen::Matrix3d b = Eigen::Matrix3d::Random();
      if (pattern->columns[k] == i) b = (b + b.transpose()).eval();
      Eigen::Map<Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(a.block(k)) = b;
    }
  const ProlongationMatrix P = random_weights(fine, coarse);
  const GalerkinProduct product(*pattern, P);
  BlockMatrix c(product.coarse_pattern());
  product.form(a, c);

  Eigen::MatrixXd P3 = Eigen::MatrixXd::Zero(3 * fine, 3 * coarse);
  for (int i = 0; i < fine; ++i)
    for (ProlongationMatrix::InnerIterator it(P, i); it; ++it)
      for (int d = 0; d < 3; ++d) P3(3 * i + d, 3 * it.col() + d) = it.value();
  const Eigen::MatrixXd expected = P3.transpose() * dense(a) * P3;
  REQUIRE(expected.norm() > 1);
  REQUIRE((dense(c) - expected).norm() < 1e-12 * expected.norm());
}

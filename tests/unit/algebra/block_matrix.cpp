#include "core/numerics/linear_algebra/block_matrix.h"

#include <catch2/catch.hpp>
#include <random>
#include <set>

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
  std::set<std::pair<int, int>> found;
  for (int i = 0; i < n; ++i) {
    CHECK(pattern->columns[pattern->row_start[i]] == i);
    for (int b = pattern->row_start[i]; b < pattern->row_start[i + 1]; ++b) {
      if (b > pattern->row_start[i]) CHECK(pattern->columns[b - 1] < pattern->columns[b]);
      CHECK(pattern->find(i, pattern->columns[b]) == b);
      found.insert({i, pattern->columns[b]});
    }
  }
  CHECK(found == expected);
  for (int i = 0; i < n; ++i)
    for (int j = i; j < n; ++j)
      if (!expected.count({i, j})) CHECK(pattern->find(i, j) == -1);
  CHECK(BlockPattern::of(3, {})->columns == std::vector<int>({0, 1, 2}));
}

TEST_CASE("Elements' blocks are summed into the right blocks, transposed where their vertices descend") {
  const int n = 12;
  const Stencils s = tangle(n, 40, 4).leftCols(3);
  BlockMatrix matrix(BlockPattern::of(n, {s, tangle(n, 5, 5).leftCols(2)}));
  const BlockSlots slots(*matrix.pattern, s);
  BlockSink sink = slots.sink(matrix);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  std::mt19937 random(6);
  for (int e = 0; e < s.rows(); ++e)
    for (int b = 0; b < 3; ++b)
      for (int a = 0; a <= b; ++a) {
        Eigen::Matrix<double, 3, 3, Eigen::RowMajor> h;
        for (int i = 0; i < 9; ++i) h.data()[i] = random() / 4294967296.0;
        if (a == b) h = (h + h.transpose()).eval();
        sink.add(e, a, b, h.data());
        expected.block<3, 3>(3 * s(e, a), 3 * s(e, b)) += h;
        if (a != b) expected.block<3, 3>(3 * s(e, b), 3 * s(e, a)) += h.transpose();
      }
  CHECK((dense(matrix) - expected).norm() <= 1e-14 * expected.norm());

  Positions x(n, 3), y;
  for (int i = 0; i < 3 * n; ++i) x.data()[i] = random() / 4294967296.0 - 0.5;
  matrix.multiply(x, y);
  const Eigen::VectorXd product = expected * flat(x);
  REQUIRE(product.norm() > 1);
  CHECK((flat(y) - product).norm() <= 1e-14 * product.norm());
  matrix.multiply(x, x);
  CHECK(x == y);
  matrix.set_zero();
  CHECK(dense(matrix).norm() == 0);
}

TEST_CASE("Misuse of block matrices is named") {
  Stencils outside(2, 2), repeated(1, 3);
  outside << 0, 1, 2, 3;
  repeated << 0, 2, 0;
  CHECK_THROWS_WITH(BlockPattern::of(3, {outside}),
                    "block pattern: element 1 of 2 vertices has vertex 3, outside 0 … 2");
  CHECK_THROWS_WITH(BlockPattern::of(3, {repeated}),
                    "block pattern: element 0 of 3 vertices repeats vertex 0");
  const auto pattern = BlockPattern::of(4, {outside});
  Stencils missing(1, 2);
  missing << 3, 0;
  CHECK_THROWS_WITH(BlockSlots(*pattern, missing),
                    "block pattern has no block for vertices 3 and 0 of element 0");
  CHECK_THROWS_WITH(BlockPattern({0, 1, 3}, {0, 0, 1}),
                    Catch::Contains("row 1 must have its diagonal first"));
  CHECK_THROWS_WITH(BlockPattern({0, 2}, {0}), Catch::Contains("row starts"));
  Positions x(3, 3), y;
  CHECK_THROWS_WITH(BlockMatrix(pattern).multiply(x, y), "block matrix of 4 rows times 3 vectors");
}

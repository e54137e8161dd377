#include "core/numerics/linear_algebra/block_cholesky.h"

#include <Eigen/Cholesky>
#include <atomic>
#include <catch2/catch.hpp>
#include <limits>
#include <thread>

#include "core/kernel/threads/flush_denormals.h"
#include "core/kernel/threads/parallel.h"
#include "tests/support/decompositions.h"
#include "tests/support/evaluate.h"
#include "tests/support/random_block_matrix.h"

using namespace drape;

namespace {

LinearSolver any_solver() {
  return GENERATE(LinearSolver::mixed, LinearSolver::supernodal, LinearSolver::cholmod);
}

/// Whether two factors of one matrix solve alike: bit for bit, or to round-off where the BLAS sets the bits.
bool agree(LinearSolver solver, const Positions& x, const Positions& y) {
  return solver != LinearSolver::cholmod ? x == y : (x - y).norm() <= 1e-12 * y.norm();
}

/// One that has analysed the matrix's pattern; no vertex is fixed unless it is told so.
BlockCholesky analysed(LinearSolver solver, const BlockMatrix& a, std::vector<char> fixed = {}) {
  fixed.resize(a.pattern->rows());
  BlockCholesky cholesky(solver);
  cholesky.analyse(a.pattern, fixed);
  return cholesky;
}

/// The largest difference from a dense solution, relative to it.
double error(LinearSolver solver, const BlockMatrix& a, std::vector<char> fixed = {}) {
  const int n = a.pattern->rows();
  fixed.resize(n);
  const Eigen::VectorXd shift = Eigen::VectorXd::LinSpaced(n, 0.5, 6);
  BlockCholesky cholesky = analysed(solver, a, fixed);
  REQUIRE(cholesky.factorise(a, shift));
  std::srand(7);
  const Positions b = Positions::Random(n, 3);
  Positions x;
  REQUIRE(cholesky.solve(b, x));

  Eigen::MatrixXd d = dense(a);
  Eigen::VectorXd right = flat(b);
  for (int k = 0; k < 3 * n; ++k) {
    d(k, k) += shift[k / 3];
    if (fixed[k / 3]) {
      d.row(k).setZero();
      d.col(k).setZero();
      d(k, k) = 1;
      right[k] = 0;
    }
  }
  const Eigen::VectorXd expected = d.llt().solve(right);
  REQUIRE(expected.norm() > 0.01);
  return (flat(x) - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("Block Cholesky solves what a dense factorisation solves", "[cholesky]") {
  const LinearSolver solver = any_solver();
  const double bound = solver == LinearSolver::mixed ? 1e-3 : 1e-12;  // where conjugate gradients end
  SECTION("chain with fixed vertices") {
    std::vector<char> fixed(60, 0);
    for (int v : {0, 7, 59}) fixed[v] = 1;
    REQUIRE(error(solver, random_matrix(60, 3), fixed) < bound);
  }
  SECTION("of any length, so that every remainder of a vector and of a strip occurs") {
    for (int n = 4; n < 40; ++n) REQUIRE(error(solver, random_matrix(n, n)) < bound);
  }
  SECTION("shells") {
    for (int side : {4, 7, 12, 20})
      REQUIRE(error(solver, random_matrix(side * side, shell(side, side), 1)) < bound);
  }
  SECTION("shell with fixed vertices that cut it in two") {
    const std::vector<int> number = shuffled(225, 1);
    std::vector<char> fixed(225, 0);
    for (int k = 7 * 15; k < 9 * 15; ++k) fixed[number[k]] = 1;
    REQUIRE(error(solver, random_matrix(225, shell(15, number), 2), fixed) < bound);
  }
  SECTION("vertices without neighbours, in between and alone") {
    Stencils s = shell(6, 3);
    s.array() *= 2;
    REQUIRE(error(solver, random_matrix(80, s, 4)) < bound);
    REQUIRE(error(solver, random_matrix(9, Stencils(0, 4), 4)) < bound);
    REQUIRE(error(solver, random_matrix(1, Stencils(0, 4), 4)) < bound);
  }
  SECTION("a factor without zeros, of several tiles") {
    for (int n : {64, 65, 150, 267}) {
      const BlockMatrix a = random_matrix(n, tangle(n, 6 * n, n), 5);
      REQUIRE(analysed(solver, a).flops() > 0.4 * 9 * n * n * n);
      REQUIRE(error(solver, a) < 10 * bound);
    }
  }
}

TEST_CASE("Block Cholesky gives the same bits with any number of threads, as far as the BLAS does",
          "[cholesky]") {
  const LinearSolver solver = any_solver();
  const int n = 60 * 60 + 300;
  Stencils s(0, 4);
  const Stencils grid = shell(60, 5), dense = tangle(300, 2000, 6);
  s.resize(grid.rows() + dense.rows(), 4);
  s << grid, dense.array() + 3600;
  const BlockMatrix a = random_matrix(n, s, 8);
  const Positions b = Positions::Random(n, 3);
  Positions first;
  for (int threads : {1, 2, 3, 8}) {
    set_thread_count(threads);
    BlockCholesky cholesky = analysed(solver, a);
    for (int repeat = 0; repeat < 3; ++repeat) {
      REQUIRE(cholesky.factorise(a, Eigen::VectorXd::Constant(n, 0.1)));
      Positions x;
      cholesky.solve(b, x);
      if (first.size() == 0) first = x;
      REQUIRE(agree(solver, x, first));
    }
  }
  set_thread_count(0);
  Positions ax;
  a.multiply(first, ax);
  REQUIRE((ax + 0.1 * first - b).norm() < (solver == LinearSolver::mixed ? 1e-5 : 1e-10) * b.norm());
}

TEST_CASE("Block Cholesky refuses an indefinite matrix wherever it is so, and then factorises a definite one",
          "[cholesky]") {
  const int side = 14, n = side * side;
  const BlockMatrix good = random_matrix(n, shell(side, 2), 2);
  const Eigen::VectorXd shift = Eigen::VectorXd::Ones(n);
  const Positions b = Positions::Random(n, 3);
  const LinearSolver solver = any_solver();
  BlockCholesky cholesky = analysed(solver, good);
  REQUIRE(cholesky.factorise(good, shift));
  Positions expected, x;
  cholesky.solve(b, expected);
  for (int v = 0; v < n; ++v) {
    BlockMatrix bad = good;
    bad.block(bad.pattern->row_start[v])[v % 3 * 4] = -50;
    REQUIRE_FALSE(cholesky.factorise(bad, shift));
    REQUIRE_THROWS_AS(cholesky.solve(b, x), std::logic_error);
    bad.block(bad.pattern->row_start[v])[v % 3 * 4] = std::numeric_limits<double>::quiet_NaN();
    REQUIRE_FALSE(cholesky.factorise(bad, shift));
  }
  REQUIRE(cholesky.factorise(good, shift));
  cholesky.solve(b, x);
  REQUIRE(agree(solver, x, expected));
}

TEST_CASE("Block Cholesky detects indefinite matrices up to round-off", "[cholesky]") {
  const LinearSolver solver = GENERATE(LinearSolver::supernodal, LinearSolver::cholmod);
  for (const auto& [n, stencils] : {std::pair(144, shell(12, 4)), std::pair(120, tangle(120, 500, 4))}) {
    const BlockMatrix a = random_matrix(n, stencils, 6);
    const double smallest = eigenvalues_of(dense(a))[0];
    BlockCholesky cholesky = analysed(solver, a);
    REQUIRE(cholesky.factorise(a, Eigen::VectorXd::Constant(n, -smallest + 1e-9)));
    REQUIRE_FALSE(cholesky.factorise(a, Eigen::VectorXd::Constant(n, -smallest - 1e-9)));
  }
}

TEST_CASE("In single precision, conjugate gradients detect what the factor does not", "[cholesky]") {
  const int side = 12, n = side * side;
  const BlockMatrix a = random_matrix(n, shell(side, 4), 6);
  const auto eigen = eigenpairs_of(dense(a));
  const double smallest = eigen.values[0];
  const Positions b = Eigen::Map<const Positions>(eigen.vectors.col(0).data(), n, 3);
  Positions x;
  BlockCholesky cholesky = analysed(LinearSolver::mixed, a);
  for (const double curvature : {-1e-2, -1e-5, -1e-9}) {
    const bool accepted = cholesky.factorise(a, Eigen::VectorXd::Constant(n, curvature - smallest));
    REQUIRE_FALSE((accepted && cholesky.solve(b, x)));
  }
  REQUIRE(cholesky.factorise(a, Eigen::VectorXd::Constant(n, 1e-2 - smallest)));
  REQUIRE(cholesky.solve(b, x));
  REQUIRE((1e-2 * x - b).norm() < 1e-5 * b.norm());
}

TEST_CASE("A matrix and a right-hand side of any unit are solved in single precision", "[cholesky]") {
  const int side = 12, n = side * side;
  BlockMatrix a = random_matrix(n, shell(side, 4), 6);
  const Positions b = Positions::Random(n, 3);
  BlockCholesky cholesky = analysed(LinearSolver::mixed, a);
  Positions expected, x;
  REQUIRE(cholesky.factorise(a, Eigen::VectorXd::Ones(n)));
  REQUIRE(cholesky.solve(b, expected));
  for (const double unit : {1e-12, 1e12})
    for (const double force : {1e-60, 1e60}) {
      BlockMatrix scaled = a;
      for (double& value : scaled.values) value *= unit;
      REQUIRE(cholesky.factorise(scaled, Eigen::VectorXd::Constant(n, unit)));
      REQUIRE(cholesky.solve(force * b, x));
      REQUIRE((unit / force * x - expected).norm() < 1e-3 * expected.norm());
    }
  REQUIRE(cholesky.factorise(a, Eigen::VectorXd::Ones(n)));
  REQUIRE(cholesky.solve(Positions::Zero(n, 3), x));
  REQUIRE(x.isZero(0));
}

TEST_CASE("Denormal numbers are flushed within a factorisation only, in every thread", "[cholesky]") {
  set_thread_count(4);
  const int side = 60, n = side * side;
  const BlockMatrix a = random_matrix(n, shell(side, 4), 6);
  BlockCholesky cholesky = analysed(LinearSolver::mixed, a);
  const Positions b = Positions::Random(n, 3);
  Positions x;
  for (int repeat = 0; repeat < 5; ++repeat) {
    REQUIRE(cholesky.factorise(a, Eigen::VectorXd::Ones(n)));
    REQUIRE(cholesky.solve(b, x));
    std::atomic<int> lost = 0;
    parallel_for(1000, 1, [&](int, int) {
      volatile double small = std::numeric_limits<double>::min();
      small = small / 4;
      lost += small == 0;
    });
    REQUIRE(lost == 0);
  }
  {
    const FlushDenormals flush;
    volatile float small = std::numeric_limits<float>::min();
    small = small / 4;
#ifdef __SSE2__
    REQUIRE(small == 0);
#endif
  }
  set_thread_count(0);
}

TEST_CASE("Block Cholesky with every vertex fixed has nothing to solve", "[cholesky]") {
  const BlockMatrix a = random_matrix(10, 2);
  BlockCholesky cholesky = analysed(any_solver(), a, std::vector<char>(10, 1));
  REQUIRE(cholesky.factorise(a, Eigen::VectorXd::Zero(10)));
  Positions x;
  cholesky.solve(Positions::Random(10, 3), x);
  REQUIRE(x.isZero(0));
}

TEST_CASE("The work of a full matrix is a third of the cube of its size") {
  const int vertices = 100;
  Stencils all(vertices * (vertices - 1) / 2, 2);
  for (int i = 0, e = 0; i < vertices; ++i)
    for (int j = 0; j < i; ++j, ++e) all.row(e) << i, j;
  BlockCholesky cholesky;
  cholesky.analyse(BlockPattern::of(vertices, {all}), std::vector<char>(vertices, 0));
  const double n = 3.0 * vertices;
  CHECK(cholesky.unknowns() == 300);
  CHECK(cholesky.flops() == Approx(n * (n + 1) * (2 * n + 1) / 6));  // a column of k entries takes k²
  CHECK(cholesky.flops() == Approx(n * n * n / 3).epsilon(0.01));
}

TEST_CASE("Analyses side by side give the ordering that each gives alone") {
  const int side = 25, n = side * side;
  const auto pattern = BlockPattern::of(n, {shell(side, side)});
  const auto ordering = [&] {
    BlockCholesky cholesky;
    cholesky.analyse(pattern, std::vector<char>(n, 0));
    return cholesky.analysis().ordering;
  };
  const std::vector<int> alone = ordering();
  std::atomic<int> others = 0;
  const auto repeat = [&] {
    for (int k = 0; k < 100; ++k) others += ordering() != alone;
  };
  std::thread other(repeat);
  repeat();
  other.join();
  CHECK(others == 0);
}

TEST_CASE("A restored analysis continues bit for bit, as far as the BLAS does") {
  // A shell that gets more and more far neighbours, whose ordering is reused for a while and then computed
  // anew.
  const int side = 12, n = side * side;
  std::vector<char> fixed(n, 0);
  fixed[5] = fixed[77] = 1;
  std::vector<BlockMatrix> matrices;
  for (int k = 0; k < 8; ++k) {
    std::vector<Stencils> stencils = {shell(side, 2)};
    if (k > 0) stencils.push_back(tangle(n, 25 * k, 1));
    matrices.emplace_back(BlockPattern::of(n, stencils));
    matrices[k].pattern->for_each_block([&](int i, int j, int b) {
      for (int e = 0; e < 9; ++e)
        matrices[k].block(b)[e] = i == j ? (e % 4 == 0 ? 500 : 0.25) : 1.0 / (1 + b % 7 + e);
    });
  }
  const Positions right = Positions::Random(n, 3);
  const auto solution = [&](BlockCholesky& cholesky, const BlockMatrix& matrix) {
    cholesky.analyse(matrix.pattern, fixed);
    REQUIRE(cholesky.factorise(matrix, Eigen::VectorXd::Ones(n)));
    Positions x;
    Positions r = right;
    r.row(5).setZero(), r.row(77).setZero();
    cholesky.solve(r, x);
    return x;
  };
  const LinearSolver solver = any_solver();
  BlockCholesky whole(solver);
  std::vector<BlockCholesky::Analysis> analyses;
  std::vector<Positions> solutions;
  int reused = 0, computed = 0;
  for (const BlockMatrix& matrix : matrices) {
    solutions.push_back(solution(whole, matrix));
    analyses.push_back(whole.analysis());
    (analyses.back().reused_ordering.empty() ? computed : reused) += 1;
  }
  REQUIRE(reused > 1);
  REQUIRE(computed > 1);
  for (std::size_t k = 0; k < matrices.size(); ++k) {
    BlockCholesky again(solver);
    again.restore(matrices[k].pattern, analyses[k]);
    Positions x;
    REQUIRE_THROWS_AS(again.solve(right, x), std::logic_error);
    for (std::size_t i = k; i < matrices.size(); ++i)
      REQUIRE(agree(solver, solution(again, matrices[i]), solutions[i]));
    CHECK(again.analysis().count == whole.analysis().count);
    CHECK(again.flops() == whole.flops());

    // With an invalidated pattern only the ordering is restored.
    BlockCholesky ordering_only(solver);
    ordering_only.restore(nullptr, analyses[k]);
    for (std::size_t i = k + 1; i < matrices.size(); ++i)
      REQUIRE(agree(solver, solution(ordering_only, matrices[i]), solutions[i]));
    CHECK(ordering_only.analysis().count == whole.analysis().count);
  }
}

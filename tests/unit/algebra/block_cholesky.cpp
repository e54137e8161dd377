#include "core/numerics/linear_algebra/block_cholesky.h"

#include <unistd.h>

#include <Eigen/Cholesky>
#include <atomic>
#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
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

/// Flags of these fixed vertices among n.
std::vector<char> fixed_among(int n, const std::vector<int>& vertices = {}) {
  std::vector<char> fixed(n, 0);
  for (const int v : vertices) fixed[v] = 1;
  return fixed;
}

/// One that has analysed the matrix's pattern.
BlockCholesky analysed(LinearSolver solver, const BlockMatrix& a, const std::vector<int>& fixed = {}) {
  BlockCholesky cholesky(solver);
  cholesky.analyse(a.pattern, fixed_among(a.pattern->rows(), fixed));
  return cholesky;
}

std::shared_ptr<const BlockPattern> shell_pattern(int side) {
  return BlockPattern::of(side * side, {shell(side, side)});
}

std::vector<int> ordering_of(const std::shared_ptr<const BlockPattern>& pattern) {
  BlockCholesky cholesky;
  cholesky.analyse(pattern, fixed_among(pattern->rows()));
  return cholesky.analysis().ordering;
}

/// The solution of (A + shift) x = b, for which the factor must serve.
Positions solved(BlockCholesky& cholesky, const BlockMatrix& a, double shift, const Positions& b) {
  REQUIRE(cholesky.factorise(a, Eigen::VectorXd::Constant(b.rows(), shift)));
  Positions x;
  REQUIRE(cholesky.solve(b, x));
  return x;
}

/// The largest difference from a dense solution must be below this bound, relative to it.
void check_solution(double bound, LinearSolver solver, const BlockMatrix& a,
                    const std::vector<int>& fixed = {}) {
  const int n = a.pattern->rows();
  const Eigen::VectorXd shift = Eigen::VectorXd::LinSpaced(n, 0.5, 6);
  BlockCholesky cholesky = analysed(solver, a, fixed);
  REQUIRE(cholesky.factorise(a, shift));
  std::srand(7);
  const Positions b = Positions::Random(n, 3);
  Positions x;
  REQUIRE(cholesky.solve(b, x));

  Eigen::MatrixXd d = dense(a);
  d.diagonal() += shift.transpose().replicate<3, 1>().reshaped();
  Eigen::VectorXd right = flat(b);
  for (const int v : fixed) {
    d.middleRows<3>(3 * v).setZero();
    d.middleCols<3>(3 * v).setZero();
    d.block<3, 3>(3 * v, 3 * v).setIdentity();
    right.segment<3>(3 * v).setZero();
  }
  const Eigen::VectorXd expected = d.llt().solve(right);
  REQUIRE(expected.norm() > 0.01);
  REQUIRE((flat(x) - expected).cwiseAbs().maxCoeff() < bound * expected.cwiseAbs().maxCoeff());
}

}  // namespace

TEST_CASE("Block Cholesky solves what a dense factorisation solves") {
  const LinearSolver solver = any_solver();
  const double bound = solver == LinearSolver::mixed ? 1e-3 : 1e-12;  // where conjugate gradients end
  const auto check = [&](const BlockMatrix& a, const std::vector<int>& fixed = {}) {
    check_solution(bound, solver, a, fixed);
  };
  check(random_matrix(60, 3), {0, 7, 59});  // a chain
  // Of any length, so that every remainder of a vector and of a strip occurs.
  for (int n = 4; n < 40; ++n) check(random_matrix(n, n));
  for (int side : {4, 7, 12, 20}) check(random_matrix(side * side, shell(side, side), 1));
  // Fixed vertices that cut a shell in two.
  const std::vector<int> number = shuffled(225, 1);
  check(random_matrix(225, shell(15, number), 2), {number.begin() + 7 * 15, number.begin() + 9 * 15});
  // Vertices without neighbours, in between and alone.
  Stencils even = shell(6, 3);
  even.array() *= 2;
  check(random_matrix(80, even, 4));
  check(random_matrix(9, Stencils(0, 4), 4));
  check(random_matrix(1, Stencils(0, 4), 4));
  // A factor without zeros, of several tiles.
  for (int n : {64, 65, 150, 267}) {
    const BlockMatrix a = random_matrix(n, tangle(n, 6 * n, n), 5);
    REQUIRE(analysed(solver, a).flops() > 0.4 * 9 * n * n * n);
    check_solution(10 * bound, solver, a);
  }
}

TEST_CASE("Block Cholesky gives the same bits with any number of threads, as far as the BLAS does") {
  const LinearSolver solver = any_solver();
  const int n = 60 * 60 + 300;
  const Stencils grid = shell(60, 5), dense = tangle(300, 2000, 6);
  Stencils s(grid.rows() + dense.rows(), 4);
  s << grid, dense.array() + 3600;
  const BlockMatrix a = random_matrix(n, s, 8);
  const Positions b = Positions::Random(n, 3);
  Positions first;
  for (int threads : {1, 2, 3, 8}) {
    set_thread_count(threads);
    BlockCholesky cholesky = analysed(solver, a);
    for (int repeat = 0; repeat < 3; ++repeat) {
      const Positions x = solved(cholesky, a, 0.1, b);
      if (first.size() == 0) first = x;
      REQUIRE(agree(solver, x, first));
    }
  }
  set_thread_count(0);
  Positions ax;
  a.multiply(first, ax);
  REQUIRE((ax + 0.1 * first - b).norm() < (solver == LinearSolver::mixed ? 1e-5 : 1e-10) * b.norm());
}

TEST_CASE("Block Cholesky refuses an indefinite matrix wherever it is so, then factorises a definite one") {
  const int side = 14, n = side * side;
  const BlockMatrix good = random_matrix(n, shell(side, 2), 2);
  const Positions b = Positions::Random(n, 3);
  const LinearSolver solver = any_solver();
  BlockCholesky cholesky = analysed(solver, good);
  const Positions expected = solved(cholesky, good, 1, b);
  Positions x;
  for (int v = 0; v < n; ++v)
    for (const double bad : {-50.0, std::nan("")}) {
      BlockMatrix a = good;
      a.block(a.pattern->row_start[v])[v % 3 * 4] = bad;
      REQUIRE_FALSE(cholesky.factorise(a, Eigen::VectorXd::Ones(n)));
      REQUIRE_THROWS_AS(cholesky.solve(b, x), std::logic_error);
    }
  REQUIRE(agree(solver, solved(cholesky, good, 1, b), expected));
}

TEST_CASE("Block Cholesky detects indefinite matrices up to round-off") {
  const LinearSolver solver = GENERATE(LinearSolver::supernodal, LinearSolver::cholmod);
  for (const auto& [n, stencils] : {std::pair(144, shell(12, 4)), std::pair(120, tangle(120, 500, 4))}) {
    const BlockMatrix a = random_matrix(n, stencils, 6);
    const double smallest = eigenvalues_of(dense(a))[0];
    BlockCholesky cholesky = analysed(solver, a);
    REQUIRE(cholesky.factorise(a, Eigen::VectorXd::Constant(n, -smallest + 1e-9)));
    REQUIRE_FALSE(cholesky.factorise(a, Eigen::VectorXd::Constant(n, -smallest - 1e-9)));
  }
}

TEST_CASE("In single precision, conjugate gradients detect what the factor does not") {
  const int side = 12, n = side * side;
  const BlockMatrix a = random_matrix(n, shell(side, 4), 6);
  const auto eigen = eigenpairs_of(dense(a));
  const double smallest = eigen.values[0];
  const Positions b = Eigen::Map<const Positions>(eigen.vectors.col(0).data(), n, 3);
  BlockCholesky cholesky = analysed(LinearSolver::mixed, a);
  for (const double curvature : {-1e-2, -1e-5, -1e-9}) {
    Positions x;
    const bool accepted = cholesky.factorise(a, Eigen::VectorXd::Constant(n, curvature - smallest));
    REQUIRE_FALSE((accepted && cholesky.solve(b, x)));
  }
  REQUIRE((1e-2 * solved(cholesky, a, 1e-2 - smallest, b) - b).norm() < 1e-5 * b.norm());
}

TEST_CASE("A matrix and a right-hand side of any unit are solved in single precision") {
  const int side = 12, n = side * side;
  const BlockMatrix a = random_matrix(n, shell(side, 4), 6);
  const Positions b = Positions::Random(n, 3);
  BlockCholesky cholesky = analysed(LinearSolver::mixed, a);
  const Positions expected = solved(cholesky, a, 1, b);
  for (const double unit : {1e-12, 1e12})
    for (const double force : {1e-60, 1e60}) {
      BlockMatrix scaled = a;
      for (double& value : scaled.values) value *= unit;
      const Positions x = solved(cholesky, scaled, unit, force * b);
      REQUIRE((unit / force * x - expected).norm() < 1e-3 * expected.norm());
    }
  REQUIRE(solved(cholesky, a, 1, Positions::Zero(n, 3)).isZero(0));
}

TEST_CASE("Denormal numbers are flushed within a factorisation only, in every thread") {
  set_thread_count(4);
  const int side = 60, n = side * side;
  const BlockMatrix a = random_matrix(n, shell(side, 4), 6);
  BlockCholesky cholesky = analysed(LinearSolver::mixed, a);
  for (int repeat = 0; repeat < 5; ++repeat) {
    solved(cholesky, a, 1, Positions::Random(n, 3));
    std::atomic<int> lost = 0;
    parallel_for(1000, 1, [&](int, int) {
      volatile double small = std::numeric_limits<double>::min();
      small = small / 4;
      lost += small == 0;
    });
    REQUIRE(lost == 0);
  }
  set_thread_count(0);
#ifdef __SSE2__
  const FlushDenormals flush;
  volatile float small = std::numeric_limits<float>::min();
  small = small / 4;
  REQUIRE(small == 0);
#endif
}

TEST_CASE("Block Cholesky with every vertex fixed has nothing to solve") {
  const BlockMatrix a = random_matrix(10, 2);
  BlockCholesky cholesky = analysed(any_solver(), a, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  REQUIRE(solved(cholesky, a, 0, Positions::Random(10, 3)).isZero(0));
}

TEST_CASE("The work of a full matrix is a third of the cube of its size") {
  Stencils all(4950, 2);
  for (int i = 0, e = 0; i < 100; ++i)
    for (int j = 0; j < i; ++j, ++e) all.row(e) << i, j;
  BlockCholesky cholesky;
  cholesky.analyse(BlockPattern::of(100, {all}), fixed_among(100));
  CHECK(cholesky.unknowns() == 300);
  CHECK(cholesky.flops() == Approx(300. * 301 * 601 / 6));  // a column of k entries takes k²
}

TEST_CASE("Analyses side by side give the ordering that each gives alone") {
  const auto pattern = shell_pattern(25);
  const std::vector<int> alone = ordering_of(pattern);
  std::atomic<int> others = 0;
  const auto repeat = [&] {
    for (int k = 0; k < 100; ++k) others += ordering_of(pattern) != alone;
  };
  std::thread other(repeat);
  repeat();
  other.join();
  CHECK(others == 0);
}

TEST_CASE("A signal to stop that comes within an analysis is kept for its end, on any number of threads") {
  static std::atomic<int> received;
  received = 0;
  const auto before = std::signal(SIGTERM, [](int) { ++received; });
  parallel_for(100, 1, [](int, int) {});  // starts the threads, to which the system may give a signal
  const auto pattern = shell_pattern(50);
  const std::vector<int> alone = ordering_of(pattern);
  std::atomic<bool> done = false;
  std::thread sender([&] {
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_BLOCK, &all, nullptr);
    while (!done) {
      kill(getpid(), SIGTERM);
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  });
  int same = 0;
  for (int k = 0; k < 10; ++k) same += ordering_of(pattern) == alone;
  done = true;
  sender.join();
  std::signal(SIGTERM, before);
  CHECK(same == 10);
  CHECK(received > 10);
}

TEST_CASE("An analysis is that of every solver, and restored goes on bit for bit, as far as the BLAS does") {
  // Of a shell with ever more far neighbours, the ordering is reused for a while and then computed again.
  const int side = 12, n = side * side;
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
    cholesky.analyse(matrix.pattern, fixed_among(n, {5, 77}));
    return solved(cholesky, matrix, 1, right);
  };
  const LinearSolver solver = any_solver();
  BlockCholesky whole, supernodal;
  whole.use(solver);
  std::vector<BlockCholesky::Analysis> analyses;
  std::vector<Positions> solutions;
  int reused = 0;
  for (const BlockMatrix& matrix : matrices) {
    solutions.push_back(solution(whole, matrix));
    CHECK((solutions.back().row(5).isZero(0) && solutions.back().row(77).isZero(0)));
    const Positions other = solution(supernodal, matrix);  // adds in another order
    CHECK((other == solutions.back()) == (solver == LinearSolver::supernodal));
    analyses.push_back(supernodal.analysis());
    CHECK(analyses.back().ordering == whole.analysis().ordering);
    CHECK(supernodal.unknowns() == whole.unknowns());
    CHECK(supernodal.flops() == whole.flops());
    reused += !analyses.back().reused_ordering.empty();
  }
  REQUIRE((reused > 1 && reused < 7));
  for (std::size_t k = 0; k < matrices.size(); ++k) {
    BlockCholesky again(solver), ordering_only(solver);
    again.restore(matrices[k].pattern, analyses[k]);
    ordering_only.restore(nullptr, analyses[k]);  // of an invalidated pattern
    Positions x;
    REQUIRE_THROWS_AS(again.solve(right, x), std::logic_error);
    for (std::size_t i = k; i < matrices.size(); ++i) {
      REQUIRE(agree(solver, solution(again, matrices[i]), solutions[i]));
      if (i > k) REQUIRE(agree(solver, solution(ordering_only, matrices[i]), solutions[i]));
    }
    CHECK(again.flops() == whole.flops());
    CHECK(again.analysis().count == whole.analysis().count);
    CHECK(ordering_only.analysis().count == whole.analysis().count);
  }
}

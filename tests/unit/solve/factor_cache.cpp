#include "core/numerics/step/factor_cache.h"

#include <catch2/catch.hpp>

#include "tests/support/newton_problem.h"
#include "tests/support/test_energies.h"

using namespace drape;

namespace {

constexpr double mass_shift = 100;

/// Vertices 2i and 2i + 1 are joined by springs so stiff that in single precision their masses make no
/// difference: the matrix is positive definite, but not to a float. No test asks for forces.
std::shared_ptr<Energy> stiff_pairs() {
  std::vector<PairSprings::Pair> pairs;
  for (int i = 0; i < 8; ++i) pairs.push_back({2 * i, 2 * i + 1, 1e12 * (1 + 0.246 * i)});
  return energy_of(PairSprings(pairs));
}

/// One iteration's solve by a cache, with what it factorised.
struct CacheSolve {
  NewtonProblem problem;
  FactorCache cache;
  Positions right = Positions::Random(16, 3), solution;

  CacheSolve(std::shared_ptr<Energy> energy, const NewtonParameters& p)
      : problem({std::move(energy)}), cache(problem.iterate, p) {}
  int factorisations(double step_length = 0.5) {
    const int before = problem.result.factorisations;
    REQUIRE(cache.solve(mass_shift, step_length, right, solution));
    return problem.result.factorisations - before;
  }
  /// ‖(A + shift M) x − b‖ / ‖b‖.
  double residual() const {
    Positions r;
    cache.matrix().multiply(solution, r);
    for (int i = 0; i < 16; ++i) r.row(i) += mass_shift * problem.model.masses()[i] * solution.row(i);
    return (r - right).norm() / right.norm();
  }
};

}  // namespace

TEST_CASE("A factor in single precision solves as well as one in double precision") {
  const auto wells = energy_of(Wells(NewtonProblem::rest().array() + 0.3, 10, 0.1));
  CacheSolve c(wells, {});
  CHECK(c.factorisations() == 1);
  CHECK(c.residual() < 1e-5);
  CHECK(c.cache.state().fallback_solves == 0);
  CacheSolve in_double(wells, {.linear_solver = LinearSolver::supernodal});
  CHECK(in_double.factorisations() == 1);
  CHECK(in_double.residual() < 1e-14);
}

TEST_CASE("Where single precision does not suffice, factors are in double precision for a while") {
  CacheSolve c(stiff_pairs(), {});
  for (int round = 0; round < 2; ++round) {
    CHECK(c.factorisations() == 2);
    CHECK(c.cache.state().fallback_solves == 10);
    for (int k = 9; k >= 0; --k) {
      CHECK(c.factorisations() == 1);
      CHECK(c.cache.state().fallback_solves == k);
    }
    Positions sums(8, 3), expected(8, 3);  // of a pair, which moves as one
    for (int i = 0; i < 8; ++i) {
      const Eigen::VectorXd& m = c.problem.model.masses();
      sums.row(i) =
          mass_shift * (m[2 * i] * c.solution.row(2 * i) + m[2 * i + 1] * c.solution.row(2 * i + 1));
      expected.row(i) = c.right.row(2 * i) + c.right.row(2 * i + 1);
    }
    CHECK((sums - expected).norm() < 1e-3 * expected.norm());
  }
}

TEST_CASE("A lower blend whose factor does not serve in single precision is refused as indefinite") {
  CacheSolve c(stiff_pairs(), {});
  FactorCache::State state = c.cache.state();
  state.blend = 0;
  c.cache.restore(state);
  CHECK(c.factorisations() == HessianModification::blend_count + 1);
  CHECK(c.cache.state().blend == HessianModification::blend_count - 1);
}

TEST_CASE("The static form has factors in double precision, and so have matrices of moved pins") {
  const auto wells = energy_of(Wells(NewtonProblem::rest().array() + 0.3, 10, 0.1));
  CacheSolve c(wells, {.form = NewtonForm::statics});
  CHECK(c.factorisations() == 1);
  CHECK(c.residual() < 1e-14);
  CacheSolve moved(wells, {});
  CHECK(moved.cache.update(mass_shift, 1));
  moved.cache.solve(moved.right, moved.solution);
  CHECK(moved.residual() < 1e-14);
}

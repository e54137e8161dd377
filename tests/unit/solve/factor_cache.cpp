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
  int factorisations() {
    const int before = problem.result.factorisations;
    REQUIRE(cache.solve(mass_shift, 0.5, right, solution));
    return problem.result.factorisations - before;
  }
  Positions with_masses(const Positions& x) const { return problem.model.masses().asDiagonal() * x; }
  /// ‖(A + shift M) x − b‖ / ‖b‖.
  double residual() const {
    Positions r;
    cache.matrix().multiply(solution, r);
    return (r + mass_shift * with_masses(solution) - right).norm() / right.norm();
  }
};

}  // namespace

TEST_CASE("A factor in single precision solves as well as is asked, one in double precision to round-off") {
  const auto wells = energy_of(Wells(NewtonProblem::rest().array() + 0.3, 10, 0.1));
  for (const auto& [p, tolerance] : {std::pair(NewtonParameters(), 1e-5),
                                     {{.linear_solver = LinearSolver::supernodal}, 1e-14},
                                     {{.form = NewtonForm::statics}, 1e-14}}) {
    CacheSolve c(wells, p);
    CHECK(c.factorisations() == 1);
    CHECK(c.residual() < tolerance);
    CHECK(c.cache.state().fallback_solves == 0);
  }
  CacheSolve moved(wells, {});  // pins
  CHECK(moved.cache.update(mass_shift, 1));
  moved.cache.solve(moved.right, moved.solution);
  CHECK(moved.residual() < 1e-14);
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
    // A pair moves as one: only the sum of its two forces is known.
    const auto sums = [](const Positions& x) {
      const Eigen::Map<const Eigen::Matrix<double, 8, 6, Eigen::RowMajor>> pairs(x.data());
      return Positions(pairs.leftCols<3>() + pairs.rightCols<3>());
    };
    const Positions expected = sums(c.right);
    CHECK((mass_shift * sums(c.with_masses(c.solution)) - expected).norm() < 1e-3 * expected.norm());
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

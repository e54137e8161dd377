#include <catch2/catch.hpp>

#include "core/numerics/linear_algebra/block_cholesky.h"
#include "tests/support/random_block_matrix.h"
#include "tests/support/solve.h"

using namespace drape;

TEST_CASE("Linear solvers share ordering and counts, and go on from each other's analyses", "[cholesky]") {
  const int side = 20, n = side * side;
  const BlockMatrix a = random_matrix(n, shell(side, 9), 9);
  std::vector<char> fixed(n, 0);
  fixed[3] = 1;
  const Positions b = Positions::Random(n, 3);
  const auto solution = [&](BlockCholesky& cholesky) {
    REQUIRE(cholesky.factorise(a, Eigen::VectorXd::Ones(n)));
    Positions x;
    REQUIRE(cholesky.solve(b, x));
    CHECK(x.row(3).isZero(0));
    return x;
  };
  BlockCholesky supernodal(LinearSolver::supernodal);
  supernodal.analyse(a.pattern, fixed);
  const Positions expected = solution(supernodal);
  for (const LinearSolver solver : {LinearSolver::cholmod, LinearSolver::mixed}) {
    CAPTURE(int(solver));
    BlockCholesky other;
    other.use(solver);
    other.analyse(a.pattern, fixed);
    const Positions x = solution(other);
    CHECK(other.analysis().ordering == supernodal.analysis().ordering);
    CHECK(other.unknowns() == supernodal.unknowns());
    CHECK(other.flops() == supernodal.flops());
    CHECK(x != expected);  // two implementations, which add in different orders

    // A checkpoint of one solver's run can be continued by the other.
    BlockCholesky restored(solver);
    restored.restore(a.pattern, supernodal.analysis());
    CHECK((solution(restored) - x).norm() <= 1e-12 * x.norm());
  }
}

TEST_CASE("A drape has the same equilibrium with every linear solver") {
  // Two pins at the centre and no friction: the equilibrium does not depend on the path.
  Solved s = scene_from(R"(
name: drape
cloth: {shape: square, side: 0.4, triangulation: one_way, columns: 9, rows: 9}
levels: 2
material: {density: 500, thickness: 2e-3, membrane_modulus: 1e5, bending_modulus: 1e6, poisson_ratio: 0.3}
start: {translate: [-0.2, -0.2, 0.16], perturbation: 1e-3}
pins:
  - {region: nearest, point: [0.2, 0.2, 0]}
  - {region: nearest, point: [0.25, 0.2, 0]}
energies: [neo_hookean, hinge, gravity]
refiner: loop
contact: shapes
obstacles: [{name: ball, shape: sphere, radius: 0.15}]
newton: {force_tolerance: 1e-7}
methods:
  supernodal: {type: cascadic, newton: {linear_solver: supernodal}}
  mixed: {type: cascadic}
  multigrid: {type: cascadic, newton: {linear_solver: multigrid}}
  cholmod: {type: cascadic, newton: {linear_solver: cholmod}}
)");
  run_method(s, "supernodal");
  CAPTURE(s.levels.back().message);
  REQUIRE(has_converged(s.levels.back().outcome));
  REQUIRE(s.levels.size() == 2);
  REQUIRE((s.x() - s.scene->starts.back()).cwiseAbs().maxCoeff() > 0.01);
  const Positions x = s.x();
  const double expected = s.model().energy(x);

  for (const char* other : {"mixed", "multigrid", "cholmod"}) {
    run_method(s, other);
    CAPTURE(other, s.levels.back().message);
    REQUIRE(has_converged(s.levels.back().outcome));
    CHECK(s.model().energy(s.x()) == Approx(expected).epsilon(1e-9).margin(1e-10));
    CHECK(s.x() != x);  // the parameter has chosen the other implementation
  }
}

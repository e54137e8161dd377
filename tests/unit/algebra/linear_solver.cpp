#include <catch2/catch.hpp>

#include "core/numerics/linear_algebra/block_cholesky.h"
#include "tests/support/random_block_matrix.h"
#include "tests/support/solve.h"

using namespace drape;

TEST_CASE("Linear solvers share ordering and counts, and differ by round-off", "[cholesky]") {
  const int side = 20, n = side * side;
  const BlockMatrix a = random_matrix(n, shell(side, 9), 9);
  std::vector<char> fixed(n, 0);
  fixed[3] = 1;
  const Positions b = Positions::Random(n, 3);
  BlockCholesky supernodal(LinearSolver::supernodal), cholmod(LinearSolver::cholmod);
  Positions x, y, z;
  supernodal.analyse(a.pattern, fixed);
  REQUIRE(supernodal.factorise(a, Eigen::VectorXd::Ones(n)));
  supernodal.solve(b, x);
  cholmod.analyse(a.pattern, fixed);
  REQUIRE(cholmod.factorise(a, Eigen::VectorXd::Ones(n)));
  cholmod.solve(b, y);
  CHECK(cholmod.analysis().ordering == supernodal.analysis().ordering);
  CHECK(cholmod.unknowns() == supernodal.unknowns());
  CHECK(cholmod.flops() == supernodal.flops());
  CHECK(cholmod.factor_entries() == supernodal.factor_entries());
  CHECK((y - x).norm() < 1e-12 * x.norm());
  CHECK(y != x);  // two implementations, which add in different orders

  BlockCholesky mixed;
  mixed.use(LinearSolver::mixed);
  mixed.analyse(a.pattern, fixed);
  REQUIRE(mixed.factorise(a, Eigen::VectorXd::Ones(n)));
  REQUIRE(mixed.solve(b, z));
  CHECK(mixed.analysis().ordering == supernodal.analysis().ordering);
  CHECK(mixed.flops() == supernodal.flops());
  CHECK(z.row(3).isZero(0));
  CHECK((z - x).norm() < 1e-3 * x.norm());
  CHECK(z != x);

  // A checkpoint of one solver's run can be continued by the other.
  BlockCholesky restored(LinearSolver::cholmod);
  restored.restore(a.pattern, supernodal.analysis());
  REQUIRE(restored.factorise(a, Eigen::VectorXd::Ones(n)));
  restored.solve(b, z);
  CHECK((z - y).norm() <= 1e-12 * y.norm());
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
  const auto energy = [&] {
    double sum = 0;
    for (const auto& [name, part] : s.model().energy_parts(s.x())) sum += part;
    return sum;
  };
  run_method(s, "supernodal");
  CAPTURE(s.levels.back().message);
  REQUIRE(has_converged(s.levels.back().outcome));
  REQUIRE(s.levels.size() == 2);
  REQUIRE((s.x() - s.scene->starts.back()).cwiseAbs().maxCoeff() > 0.01);
  const Positions x = s.x();
  const double expected = energy();

  for (const char* other : {"mixed", "multigrid", "cholmod"}) {
    run_method(s, other);
    CAPTURE(other, s.levels.back().message);
    REQUIRE(has_converged(s.levels.back().outcome));
    CHECK(energy() == Approx(expected).epsilon(1e-9).margin(1e-10));
    CHECK(s.x() != x);  // the parameter has chosen the other implementation
  }
}

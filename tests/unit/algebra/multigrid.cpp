#include "core/numerics/multigrid/multigrid.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/numerics/model/hessian_assembler.h"
#include "core/numerics/step/factor_cache.h"
#include "tests/support/any_threads.h"
#include "tests/support/solve.h"
#include "tests/support/test_energies.h"

using namespace drape;

namespace {

/// A deformed hanging cloth of three levels, the finest of 6,889 vertices, and its matrix.
struct Hanging {
  Solved s = scene_from(R"(
name: hanging
cloth: {shape: square, side: 0.5, triangulation: one_way, columns: 21, rows: 22}
levels: 3
pins: [{region: nearest, point: [0, 0, 0]}]
energies: [neo_hookean, hinge, gravity]
refiner: loop
methods: {newton: {}}
)");
  BlockMatrix matrix;
  Eigen::VectorXd shift;
  Positions b;

  Hanging() {
    Positions x = s.rest();
    for (Eigen::Index i = 0; i < x.rows(); ++i) x(i, 2) += 0.03 * std::sin(20 * x(i, 0) + 5 * x(i, 1));
    matrix = s.model().energy_hessian(x, Projection::clamp);
    shift = 1e4 * s.model().masses();
    std::srand(3);
    b = Positions::Random(x.rows(), 3);
  }
  const std::vector<char>& fixed() const { return s.model().fixed(); }  // vertex 0
  Multigrid multigrid() const { return Multigrid(s.scene->hierarchy.prolongations); }
  /// Where nothing is fixed, relative to b.
  double residual(const Positions& x) const {
    Positions r;
    matrix.multiply(x, r);
    r += shift.asDiagonal() * x - b;
    return r.bottomRows(r.rows() - 1).norm() / b.bottomRows(r.rows() - 1).norm();
  }
};

/// A cache of the cloth at rest, and what it solved last.
struct Cache {
  PlainObjective objective;
  LevelResult result;
  Iterate iterate;
  FactorCache cache;
  Positions solution;
  Cache(const Hanging& h, LinearSolver solver, const Hierarchy* hierarchy)
      : objective(h.s.model()),
        iterate(objective, result),
        cache(iterate, NewtonParameters{.linear_solver = solver}, hierarchy) {
    iterate.move_to(h.s.rest());
    iterate.set_constraints(h.fixed(), nullptr);
    iterate.evaluate();
  }
  int factorisations(const Hanging& h) {
    const int before = result.factorisations;
    REQUIRE(cache.solve(1e6, 1, h.b, solution));
    return result.factorisations - before;
  }
};

}  // namespace

TEST_CASE("Cycles of multigrid solve a cloth's system, with the same bits for any number of threads") {
  const Hanging h;
  REQUIRE((h.fixed()[0] == 1 && std::ranges::count(h.fixed(), 1) == 1));
  const Positions x = same_with_any_threads([&] {
    Positions solution;
    Multigrid m = h.multigrid();
    REQUIRE(m.set(h.matrix, h.shift, h.fixed()));
    REQUIRE(m.solve(h.b, solution) == ConjugateGradients::End::converged);
    return solution;
  });
  CHECK(x.row(0).isZero(0));  // fixed
  CHECK(h.residual(x) <= 0.1 + 1e-9);
  CHECK(h.residual(x) > 1e-6);  // the measure can fail
}

TEST_CASE("Conjugate gradients that run out of iterations end with what suffices, or not converged") {
  Hanging h;
  ConjugateGradients gradients;
  Positions x;
  const auto end = [&](double sufficient) {
    return gradients.solve(
        h.matrix, h.shift, h.fixed(), h.b, [](const Positions& r, Positions& z) { z = r; },
        {1e-9, 20, sufficient}, x);
  };
  using End = ConjugateGradients::End;
  REQUIRE(end(1e9) == End::converged);
  const double reached = h.residual(x);
  REQUIRE(reached > 1e-6);
  CHECK(end(1.01 * reached) == End::converged);
  CHECK(end(0.99 * reached) == End::not_converged);
  h.b(5, 0) = std::nan("");
  CHECK(end(1e9) == End::not_converged);
}

TEST_CASE("Multigrid refuses a matrix that is not positive definite") {
  Hanging h;
  Multigrid m = h.multigrid();
  h.shift[100] = -1e9;  // in the block of a vertex
  CHECK_FALSE(m.set(h.matrix, h.shift, h.fixed()));
  h.shift.setConstant(-0.02);  // on the whole
  Positions x;
  CHECK((!m.set(h.matrix, h.shift, h.fixed()) || m.solve(h.b, x) == ConjugateGradients::End::not_definite));
}

TEST_CASE("What multigrid falls back on is forgotten, and a checkpoint keeps the count of it") {
  const Hanging h;
  const Hierarchy* hierarchy = &h.s.scene->hierarchy;
  Cache first(h, LinearSolver::multigrid, hierarchy), second(h, LinearSolver::multigrid, hierarchy);
  REQUIRE(first.cache.update(1e6, 1));
  CHECK_FALSE(first.cache.state().analysis.fixed.empty());
  REQUIRE(first.factorisations(h) == 1);
  CHECK(first.cache.analyses() == 1);  // none of multigrid's own
  CHECK(first.cache.state().analysis.fixed.empty());
  second.cache.restore(first.cache.state());
  for (Cache* c : {&first, &second}) {
    REQUIRE(c->cache.update(1e6, 1));
    CHECK(c->cache.analyses() == 2);
  }
  CHECK(second.cache.state().analysis.ordering == first.cache.state().analysis.ordering);
}

TEST_CASE("Multigrid has the same bits whatever it solved before") {
  // A resumed run knows nothing of the contacts of earlier iterations.
  Hanging h;
  h.shift *= 1e-4;  // soft modes show the last bits of the coarsest mesh's solution
  BlockMatrix elastic = h.matrix;
  HessianAssembler assembler;
  const PairSprings contacts({{1, 3000}, {2, 3300}, {3, 3600}, {4, 3900}, {5, 4200}});
  const BlockMatrix& touching = assembler.add(elastic, {}, {&contacts}, h.s.rest(), Projection::none);
  REQUIRE(touching.pattern != h.matrix.pattern);
  Multigrid used = h.multigrid(), fresh = h.multigrid();
  REQUIRE(used.set(h.matrix, h.shift, h.fixed()));
  used.take_flops();
  REQUIRE(used.set(touching, h.shift, h.fixed()));
  REQUIRE(fresh.set(touching, h.shift, h.fixed()));
  Positions x, expected;
  CHECK(used.solve(h.b, x) == fresh.solve(h.b, expected));
  const double flops = fresh.take_flops();
  CHECK(flops > 0);
  CHECK(used.take_flops() == flops);
  CHECK(used.take_flops() == 0);
  REQUIRE(expected.norm() > 0);
  CHECK(x == expected);
}

TEST_CASE("By itself multigrid is for large levels of a hierarchy") {
  const Hanging h;
  const auto solver = [&](LinearSolver chosen, const Hierarchy* hierarchy) {
    Cache c(h, chosen, hierarchy);
    c.factorisations(h);
    return c.cache.solver();
  };
  CHECK(solver(LinearSolver::automatic, &h.s.scene->hierarchy) == LinearSolver::mixed);
  CHECK(solver(LinearSolver::multigrid, &h.s.scene->hierarchy) == LinearSolver::multigrid);
  CHECK(solver(LinearSolver::multigrid, nullptr) == LinearSolver::mixed);
}

TEST_CASE("A drape has the same equilibrium with every linear solver") {
  // Two pins at the centre and no friction: the equilibrium does not depend on the path.
  Solved s = scene_from(R"(
name: drape
cloth: {shape: square, side: 0.4, triangulation: one_way, columns: 9, rows: 9}
levels: 2
material: {density: 500, thickness: 2e-3, membrane_modulus: 1e5, bending_modulus: 1e6, poisson_ratio: 0.3}
start: {translate: [-0.2, -0.2, 0.16], perturbation: 1e-3}
pins: [{region: nearest, point: [0.2, 0.2, 0]}, {region: nearest, point: [0.25, 0.2, 0]}]
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
  const auto solution = [&](const char* method) {
    run_method(s, method);
    CAPTURE(method, s.levels.back().message);
    REQUIRE(has_converged(s.levels.back().outcome));
    return s.x();
  };
  const Positions x = solution("supernodal");
  REQUIRE(s.levels.size() == 2);
  REQUIRE((x - s.scene->starts.back()).cwiseAbs().maxCoeff() > 0.01);
  for (const char* method : {"mixed", "multigrid", "cholmod"}) {
    const Positions other = solution(method);
    CHECK(s.model().energy(other) == Approx(s.model().energy(x)).epsilon(1e-9).margin(1e-10));
    CHECK(other != x);  // the parameter has chosen the other implementation
  }
}

#include "core/numerics/multigrid/multigrid.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/numerics/step/factor_cache.h"
#include "tests/support/any_threads.h"
#include "tests/support/solve.h"

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
  Multigrid multigrid() const { return Multigrid(s.scene->hierarchy.prolongations); }
  double residual(const Positions& x) const {
    Positions r;
    matrix.multiply(x, r);
    double sum = 0, of = 0;
    for (Eigen::Index i = 0; i < r.rows(); ++i) {
      if (s.model().fixed()[i]) continue;
      sum += (r.row(i) + shift[i] * x.row(i) - b.row(i)).squaredNorm();
      of += b.row(i).squaredNorm();
    }
    return std::sqrt(sum / of);
  }
};

/// A cache of the cloth at rest, and what it solved last.
struct Cache {
  PlainObjective objective;
  LevelResult result;
  Iterate iterate;
  FactorCache cache;
  Positions solution;
  Cache(const Hanging& h, const NewtonParameters& p) : Cache(h, p, &h.s.scene->hierarchy) {}
  Cache(const Hanging& h, const NewtonParameters& p, const Hierarchy* hierarchy)
      : objective(h.s.model()), iterate(objective, result), cache(iterate, p, hierarchy) {
    iterate.move_to(h.s.rest());
    iterate.set_constraints(h.s.model().fixed(), nullptr);
    iterate.evaluate();
  }
  int factorisations(const Hanging& h) {
    const int before = result.factorisations;
    REQUIRE(cache.solve(1e6, 1, h.b, solution));
    return result.factorisations - before;
  }
};

}  // namespace

TEST_CASE("Cycles of multigrid solve a cloth's system, and leave fixed vertices where they are") {
  const Hanging h;
  REQUIRE(h.s.model().fixed()[0] == 1);
  Multigrid m = h.multigrid();
  REQUIRE(m.set(h.matrix, h.shift, h.s.model().fixed()));
  Positions x;
  REQUIRE(m.solve(h.b, x) == ConjugateGradients::End::converged);
  CHECK(x.row(0).isZero(0));
  CHECK(h.residual(x) <= 0.1 + 1e-9);
  CHECK(h.residual(x) > 1e-6);  // the measure can fail
  CHECK(m.take_flops() > 0);
  CHECK(m.take_flops() == 0);
}

TEST_CASE("Conjugate gradients that run out of iterations end with what suffices, or not converged") {
  Hanging h;
  ConjugateGradients gradients;
  Positions x;
  const auto end = [&](double sufficient) {
    return gradients.solve(
        h.matrix, h.shift, h.s.model().fixed(), h.b, [](const Positions& r, Positions& z) { z = r; },
        {1e-9, 20, sufficient}, x);
  };
  using End = ConjugateGradients::End;
  REQUIRE(end(1e9) == End::converged);
  const double reached = h.residual(x);
  REQUIRE(reached > 1e-6);
  CHECK(end(1.01 * reached) == End::converged);
  CHECK(end(0.99 * reached) == End::not_converged);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    h.b(5, 0) = bad;
    CHECK(end(1e9) == End::not_converged);
  }
}

TEST_CASE("Multigrid has the same bits with any number of threads") {
  const Hanging h;
  same_with_any_threads([&] {
    Positions x;
    Multigrid m = h.multigrid();
    REQUIRE(m.set(h.matrix, h.shift, h.s.model().fixed()));
    REQUIRE(m.solve(h.b, x) == ConjugateGradients::End::converged);
    return x;
  });
}

TEST_CASE("Multigrid refuses a matrix that is not positive definite") {
  Hanging h;
  Multigrid m = h.multigrid();
  SECTION("in the block of a vertex") {
    h.shift[100] = -1e9;
    CHECK_FALSE(m.set(h.matrix, h.shift, h.s.model().fixed()));
  }
  SECTION("on the whole") {
    h.shift.setConstant(-0.02);
    Positions x;
    CHECK((!m.set(h.matrix, h.shift, h.s.model().fixed()) ||
           m.solve(h.b, x) == ConjugateGradients::End::not_definite));
  }
}

TEST_CASE("What multigrid falls back on is forgotten, and a checkpoint keeps the count of it") {
  const Hanging h;
  const NewtonParameters p{.linear_solver = LinearSolver::multigrid};
  Cache first(h, p), second(h, p);
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
  const std::vector<char>& fixed = h.s.model().fixed();
  const BlockPattern& elastic = *h.matrix.pattern;
  Stencils blocks(elastic.blocks(), 2), contacts(5, 2);
  elastic.for_each_block([&](int i, int j, int k) { blocks.row(k) << i, i == j ? -1 : j; });
  for (int i = 0; i < 5; ++i) contacts.row(i) << 1 + i, 3000 + 300 * i;
  const auto pattern = BlockPattern::of(elastic.rows(), {blocks, contacts});
  BlockMatrix touching(pattern);
  elastic.for_each_block(
      [&](int i, int j, int k) { std::copy_n(h.matrix.block(k), 9, touching.block(pattern->find(i, j))); });
  for (int c = 0; c < 5; ++c)
    for (int a = 0; a < 2; ++a)
      for (int b = a; b < 2; ++b)
        for (int e = 0; e < 9; e += 4)
          touching.block(pattern->find(contacts(c, a), contacts(c, b)))[e] += a == b ? 1 : -1;

  Multigrid used = h.multigrid(), fresh = h.multigrid();
  REQUIRE(used.set(h.matrix, h.shift, fixed));
  used.take_flops();
  REQUIRE(used.set(touching, h.shift, fixed));
  REQUIRE(fresh.set(touching, h.shift, fixed));
  Positions x, expected;
  CHECK(used.solve(h.b, x) == fresh.solve(h.b, expected));
  CHECK(used.take_flops() == fresh.take_flops());
  REQUIRE(expected.norm() > 0);
  CHECK(x == expected);
}

TEST_CASE("By itself multigrid is for large levels of a hierarchy") {
  const Hanging h;
  const auto solver = [&](LinearSolver chosen, const Hierarchy* hierarchy) {
    Cache c(h, {.linear_solver = chosen}, hierarchy);
    c.factorisations(h);
    return c.cache.solver();
  };
  CHECK(solver(LinearSolver::automatic, &h.s.scene->hierarchy) == LinearSolver::mixed);
  CHECK(solver(LinearSolver::multigrid, &h.s.scene->hierarchy) == LinearSolver::multigrid);
  CHECK(solver(LinearSolver::multigrid, nullptr) == LinearSolver::mixed);
}

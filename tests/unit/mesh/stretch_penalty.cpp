#include "core/numerics/elements/stretch_penalty.h"

#include "tests/support/membrane_check.h"

using namespace drape;

namespace {

using Kernel = StretchKernel<StretchPenaltyLaw>;
using Check = KernelCheck<Kernel>;

const Kernel::Rest rest = [] {
  const RestTriangle triangle = RestTriangle::of(rest1, rest2);
  return Kernel::Rest(triangle.a, triangle.b, triangle.c, 0.7);
}();

std::vector<Check::State> states() {
  std::vector<Check::State> all = deformed_triangles();
  all.push_back(edges(1.3 * rest1, 1.3 * rest2));  // equal stretches
  return all;
}

}  // namespace

TEST_CASE("stretch penalty: derivatives are those of the value") {
  for (const auto& x : states()) Check::derivatives(x, rest, 1e-4, 1e-6);
}

TEST_CASE("stretch penalty: projection is that of the full element matrix") {
  double smallest = 0;
  for (const auto& x : states()) {
    smallest = std::min(smallest, Check::projections<double>(x, rest));
    Check::projections<Pack<native_pack_width>>(x, rest);
  }
  REQUIRE(smallest < -1e-3);  // else nothing was projected
}

TEST_CASE("stretch penalty: collapsed triangles have finite derivatives") {
  for (const auto& x :
       {edges({1, 0, 0}, {2, 0, 0}), edges({1, 0, 0}, {0, 0, 0}), edges({0, 0, 0}, {0, 0, 0})}) {
    const auto r = Check::evaluate(x, rest);
    CHECK(r.value > 0);
    CHECK(r.gradient.allFinite());
    CHECK(r.hessian.allFinite());
  }
}

TEST_CASE("stretch penalty: a stretched sheet in closed form, over the flagged triangles alone") {
  const Level level = Level::of(0, grid({1, 1}, 5, 5, Diagonals::one_way));
  Positions x = level.rest.vertices;
  x.col(0) *= 1.2;
  x.col(1) *= 0.9;
  const double whole = 50 * 0.01 * (0.2 * 0.2 + 0.1 * 0.1);
  std::vector<char> flags(level.triangle_count(), 1);
  CHECK(make_stretch_penalty(level, 0.01, 50, flags)->value(x) == Approx(whole).epsilon(1e-12));
  std::fill(flags.begin() + 8, flags.end(), char{0});
  const auto part = make_stretch_penalty(level, 0.01, 50, flags);
  CHECK(part->value(x) == Approx(whole * 8 / level.triangle_count()).epsilon(1e-12));
  CHECK(part->stencils().rows() == 8);
  CHECK(part->value(level.rest.vertices) <= 1e-28);
  CHECK(gradient_of(*part, level.rest.vertices).norm() <= 1e-15);
}

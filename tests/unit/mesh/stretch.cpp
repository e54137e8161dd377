// Principal stretches of a triangle, and the penalty on them.

#include "core/numerics/elements/stretch.h"

#include "core/numerics/elements/stretch_penalty.h"
#include "tests/support/membrane_check.h"

using namespace drape;
using Eigen::Vector3d;

namespace {

using Kernel = StretchKernel<StretchPenaltyLaw>;
using Check = KernelCheck<Kernel>;

const Kernel::Rest rest = [] {
  const RestTriangle triangle = RestTriangle::of(rest1, rest2);
  return Kernel::Rest(triangle.a, triangle.b, triangle.c, 0.7);
}();

}  // namespace

TEST_CASE("stretch: of a triangle, the singular values of its deformation gradient") {
  const Eigen::VectorXd numbers = normal_numbers(2400, 7);
  for (int trial = 0; trial < 200; ++trial) {
    const Eigen::Matrix<double, 3, 4> e = numbers.segment<12>(12 * trial).reshaped(3, 4);
    // F = [e1, e2] [rest1, rest2]⁺ has the two stretches and a zero.
    const Eigen::Matrix<double, 3, 2> rest = e.leftCols<2>();
    const Eigen::VectorXd expected =
        singular_values_of(e.rightCols<2>() * (rest.transpose() * rest).inverse() * rest.transpose());
    const auto s = RestTriangle::of(e.col(0), e.col(1)).stretch(e.col(2), e.col(3));
    CHECK(s.largest == Approx(expected[0]).epsilon(1e-8));
    CHECK(s.smallest == Approx(expected[1]).epsilon(1e-8));
  }
}

TEST_CASE("stretch: no digits are lost where stretches agree or vanish") {
  const Vector3d e1(1, 0, 0), e2(0.3, 0.8, 0);
  const auto scaled = [&](const Vector3d& by) {
    return RestTriangle::of(e1, e2).stretch(e1.cwiseProduct(by), e2.cwiseProduct(by));
  };
  CHECK(std::abs(scaled({1, 1, 1}).largest - 1) < 1e-15);
  CHECK(std::abs(scaled({1, 1, 1}).smallest - 1) < 1e-15);
  CHECK(scaled({1 + 1e-10, 1, 1}).largest - 1 == Approx(1e-10).epsilon(1e-4));
  CHECK(std::abs(scaled({1 + 1e-10, 1, 1}).smallest - 1) < 1e-14);
  CHECK(scaled({2, 1e-9, 1}).largest == Approx(2));
  CHECK(scaled({2, 1e-9, 1}).smallest == Approx(1e-9).epsilon(1e-9));
  CHECK(scaled({0, 0, 0}).largest == 0);
  CHECK(scaled({0, 0, 0}).smallest == 0);
}

TEST_CASE("stretch penalty: derivatives are those of the value, projection that of the full matrix") {
  std::vector<Check::State> states = deformed_triangles();
  states.push_back(edges(1.3 * rest1, 1.3 * rest2));  // equal stretches
  double smallest = 0;
  for (const auto& x : states) {
    Check::derivatives(x, rest, 1e-4, 1e-6);
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
  const Positions x = level.rest.vertices * Vector3d(1.2, 0.9, 1).asDiagonal();
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

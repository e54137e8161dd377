#include <catch2/catch.hpp>

#include "core/numerics/patterns/generate.h"
#include "tests/support/kernel_check.h"
#include "tests/support/unregistered.h"
// After it:
#include "plugins/energy/quadratic_bending/quadratic_bending.cpp"

using namespace drape;

namespace {

using Check = KernelCheck<QuadraticBendingKernel>;
constexpr double k = 0.7, height_u = 0.8, height_v = 1.1;

/// Two triangles over an edge of length 1 along x, whose normals differ by `angle`.
Check::State folded(double angle) {
  Check::State x;
  x << 1, 0, 0, 0.4, height_u, 0, 0.7, -height_v * std::cos(angle), -height_v * std::sin(angle);
  return x;
}

const QuadraticBendingKernel::Rest rest = [] {
  const Check::State x = folded(0);
  const Eigen::Vector3d d[3] = {x.segment<3>(0), x.segment<3>(3), x.segment<3>(6)};
  return QuadraticBendingKernel::rest(d, k);
}();

}  // namespace

TEST_CASE("quadratic_bending: a flat hinge that is deformed in its plane is stress-free") {
  Check::State sheared = folded(0);
  for (int i = 0; i < 3; ++i) sheared[3 * i] = 1.3 * sheared[3 * i] + 0.4 * sheared[3 * i + 1];
  const auto r = Check::evaluate(sheared, rest);
  CHECK(std::abs(r.value) <= 1e-28 * k);
  CHECK(r.gradient.norm() <= 1e-13 * k);
}

TEST_CASE("quadratic_bending: an isometric fold has the hinge energy with θ replaced by 2 sin θ/2") {
  const double c = 3 * k / (0.5 * height_u + 0.5 * height_v);
  for (const double angle : {-2.0, 1e-3, 0.3, 3.0})
    CHECK(Check::evaluate(folded(angle), rest).value ==
          Approx(c * std::pow(2 * std::sin(angle / 2), 2)).epsilon(1e-12).margin(0));
}

TEST_CASE("quadratic_bending: a rest shape that is not flat is refused") {
  TriangleMesh mesh = grid({1, 1}, 4, 4, Diagonals::one_way);
  mesh.vertices(5, 2) = 0.01;
  CHECK_THROWS_WITH(
      QuadraticBending().bind(Level::of(3, mesh), Material()),
      Catch::Contains("the rest shape of level 3 is not flat (angle 0.0") && Catch::Contains("use hinge"));
}

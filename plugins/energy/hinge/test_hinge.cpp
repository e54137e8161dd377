#include <catch2/catch.hpp>

#include "tests/support/kernel_check.h"
#include "tests/support/meshes.h"
#include "tests/support/unregistered.h"
// After it:
#include "plugins/energy/hinge/hinge.cpp"

using namespace drape;

namespace {

using Kernel = FoldFormulaKernel<formulas::hinge, 5>;
using Check = KernelCheck<Kernel>;
constexpr double k = 0.7;

/// Its k is the one above.
Material stiff() {
  Material material;
  material.thickness = 1;
  material.poisson_ratio = 0;
  material.bending_modulus = 24 * k;
  return material;
}
const bool set = (Check::kernel() = {formulas::hinge({}, stiff())}, true);

/// Two triangles over an edge of length 1 along x, whose normals differ by `angle`.
Check::State folded(double angle, double foot_u = 0.4, double height_u = 0.8, double foot_v = 0.7,
                    double height_v = 1.1) {
  Check::State x;
  x << 1, 0, 0, foot_u, height_u, 0, foot_v, -height_v * std::cos(angle), -height_v * std::sin(angle);
  return x;
}

Kernel::Rest rest_of(const Check::State& x) {
  const TriangleMesh mesh =
      mesh_of({{0, 0, 0}, x.segment<3>(0), x.segment<3>(3), x.segment<3>(6)}, {{0, 1, 2}, {1, 0, 3}});
  return rest_hinges(Level::of(0, mesh))[0].head<5>();
}

const Kernel::Rest bent_rest = rest_of(folded(0.6));

}  // namespace

TEST_CASE("hinge: one that is shut at rest opens to either side alike") {
  for (const double rest_angle : {M_PI, -M_PI, 3.0, -3.0}) {
    Kernel::Rest rest;
    rest << rest_angle, 1, 1, 1, 3;
    for (const double bend : {0.0, 0.1, -0.1, 0.5, -0.5, 3.0, -3.0})
      CHECK(Check::evaluate(folded(rest_angle + bend), rest).value == Approx(k * bend * bend).margin(1e-14));
  }
}

TEST_CASE("hinge: the angle is signed, positive where the second triangle lies behind the first") {
  for (const double angle : {-3.1, -1.0, -1e-9, 0.0, 1e-9, 0.5, 2.0, 3.1}) {
    const Check::State x = folded(angle);
    const Eigen::Vector3d d[3] = {x.segment<3>(0), x.segment<3>(3), x.segment<3>(6)};
    CHECK(DihedralAngle<double>(d).angle() == Approx(angle).epsilon(1e-14).margin(0));
  }
}

TEST_CASE("hinge: projection is that of the matrix by the axis and the points' distances from it") {
  // Random, nearly flat, sharply folded to both sides, and with a nearly degenerate triangle.
  std::vector<Check::State> states = {folded(0.5, 0.4, 0.03), folded(0.5, 3.0, 0.2, -2.0, 0.1)};
  for (unsigned seed = 1; seed <= 5; ++seed) states.push_back(folded(0.3) + 0.3 * normal_numbers(9, seed));
  for (const double angle : {1e-3, 3.0, -3.0, 1.6, -0.9}) states.push_back(folded(angle));
  double smallest = 0;
  for (const auto& x : states) {
    const auto matrix_of = [&](const Check::Hessian& h) {
      Check::Hessian back = Check::Hessian::Identity();  // e, u, v from e, u - s_u e, v - s_v e
      const Eigen::Vector3d e = x.head<3>();
      for (const int i : {3, 6})
        back.block<3, 3>(i, 0) = x.segment<3>(i).dot(e) / e.squaredNorm() * Eigen::Matrix3d::Identity();
      return Eigen::MatrixXd(back.transpose() * h * back);
    };
    smallest = std::min(smallest, Check::projections<double>(x, bent_rest, matrix_of));
    Check::projections<Pack<native_pack_width>>(x, bent_rest, matrix_of);
  }
  REQUIRE(smallest < -1e-3);  // else nothing was projected
  // Flat, the rank is one: nothing to project.
  CHECK(Check::projections<Pack<native_pack_width>>(folded(0), rest_of(folded(0))) > -1e-12);
}

TEST_CASE("hinge: a fold in closed form") {
  // c = 3 k ‖ē‖² / (Ā₁ + Ā₂)
  const double c = 3 * k * 1 / (0.5 * 0.8 + 0.5 * 1.1);
  for (const double angle : {-2.0, 0.3, 3.0})
    CHECK(Check::evaluate(folded(angle), bent_rest).value ==
          Approx(c * std::pow(angle - 0.6, 2)).epsilon(1e-13));
}

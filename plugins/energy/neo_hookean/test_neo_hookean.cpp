#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <limits>

#include "core/mesh/generate.h"
#include "plugins/energy/neo_hookean/neo_hookean.h"
#include "plugins/energy/neo_hookean/neo_hookean_kernel.h"
#include "tests/support/kernel_check.h"

using namespace drape;

namespace {

using Check = KernelCheck<NeoHookeanKernel>;
constexpr double thickness = 3e-4, modulus = 8e4, poisson_ratio = 0.3;
const double mu = modulus / (2 * (1 + poisson_ratio));
const double lambda = modulus * poisson_ratio / (1 - poisson_ratio * poisson_ratio);
const Eigen::Vector3d rest1(0.9, 0.2, 0.1), rest2(0.1, 1.1, -0.3);
const NeoHookeanKernel::Rest rest = NeoHookeanKernel::rest(rest1, rest2, thickness, modulus, poisson_ratio);
const double volume = rest1.cross(rest2).norm() / 2 * thickness;

Check::State state(const Eigen::Vector3d& e1, const Eigen::Vector3d& e2) {
  Check::State x;
  x << e1, e2;
  return x;
}

/// Random, strongly stretched and sheared, strongly compressed, and nearly degenerate.
std::vector<Check::State> states() {
  std::vector<Check::State> all;
  for (unsigned seed = 1; seed <= 5; ++seed)
    all.push_back(state(rest1, rest2) + 0.2 * normal_numbers(6, seed));
  all.push_back(state({2.5, 0.1, 0.4}, {1.9, 2.2, 0.1}));
  all.push_back(state({0.3, 0.1, -0.1}, {-0.05, 0.25, 0.1}));
  all.push_back(state({1, 0, 0}, {0.4, 0.02, 0.01}));
  return all;
}

}  // namespace

TEST_CASE("neo_hookean: derivatives are those of the value") {
  for (const auto& x : states()) Check::derivatives(x, rest, 1e-4, 1e-7);
}

TEST_CASE("neo_hookean: lanes compute what double does") {
  for (const auto& x : states()) Check::all_lanes(x, rest, Check::evaluate(x, rest).value);
}

TEST_CASE("neo_hookean: projection is that of the full element matrix") {
  double smallest = 0;
  for (const auto& x : states()) {
    smallest = std::min(smallest, Check::projections<double>(x, rest));
    Check::projections<Pack<8>>(x, rest);
  }
  REQUIRE(smallest < -1e-3);  // else nothing was projected
}

TEST_CASE("neo_hookean: the rest shape is stress-free, wherever it lies") {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  const auto r = Check::evaluate(state(turn * rest1, turn * rest2), rest);
  CHECK(std::abs(r.value) <= 1e-30 * mu * volume);
  CHECK(r.gradient.norm() <= 1e-15 * mu * volume);
  CHECK(r.hessian.norm() > mu * volume);
}

TEST_CASE("neo_hookean: biaxial stretch in closed form, down to small strains") {
  const Eigen::Vector3d e1(0.02, 0, 0), e2(0, 0.03, 0);
  const double own_volume = 0.02 * 0.03 / 2 * thickness;
  const auto own = NeoHookeanKernel::rest(e1, e2, thickness, modulus, poisson_ratio);
  for (const double strain : {1e-6, 1e-3, 0.1, 1.0, -0.4}) {
    // Uniaxial stress for small strains: energy density E ε²/2.
    const double a = strain, b = -poisson_ratio * strain;
    const long double la = a, lb = b;
    const double expected =
        own_volume *
        double(mu / 2 * (2 * la + la * la - 2 * std::log1p(la) + 2 * lb + lb * lb - 2 * std::log1p(lb)) +
               lambda / 2 * std::pow(std::log1p(la) + std::log1p(lb), 2));
    const double found = Check::evaluate(state(e1 * (1 + a), e2 * (1 + b)), own).value;
    CHECK(found == Approx(expected).epsilon(1e-9).margin(0));
    if (strain == 1e-6) CHECK(found == Approx(own_volume * modulus * a * a / 2).epsilon(1e-5).margin(0));
  }
}

TEST_CASE("neo_hookean: a collapsed triangle's energy") {
  const Level level = Level::of(0, grid({1, 1}, 3, 3, Diagonals::one_way));
  const auto bound = NeoHookean({}).bind(level, Material());
  Positions x = level.rest.vertices;
  x.row(4) = x.row(0);
  Positions g = Positions::Zero(9, 3);
  const double value = bound->value(x);
  CHECK(bound->add_gradient(x, g) == value);
  CHECK(value == std::numeric_limits<double>::infinity());
}

TEST_CASE("neo_hookean: same bits with any number of threads") {
  const Level level = Level::of(0, grid({1, 1}, 60, 50, Diagonals::criss_cross));
  const Eigen::VectorXd noise = 0.003 * normal_numbers(9000, 1);
  check_threads(*NeoHookean({}).bind(level, Material()),
                level.rest.vertices + Eigen::Map<const Positions>(noise.data(), 3000, 3));
}

TEST_CASE("neo_hookean: a triangle without area is refused") {
  Level level = Level::of(0, grid({1, 1}, 3, 3, Diagonals::one_way));
  level.rest.vertices.row(4) = level.rest.vertices.row(0);
  CHECK_THROWS_WITH(NeoHookean({}).bind(level, Material()),
                    Catch::Contains("neo_hookean: triangle") && Catch::Contains("no area"));
}

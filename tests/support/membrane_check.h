#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <functional>
#include <vector>

#include "core/numerics/formulas/membrane_formula.h"
#include "tests/support/kernel_check.h"
#include "tests/support/meshes.h"

/// Edge vectors of a triangle at rest, and a state of it as KernelCheck takes it.
inline const Eigen::Vector3d rest1(0.9, 0.2, 0.1), rest2(0.1, 1.1, -0.3);
inline Eigen::Matrix<double, 6, 1> edges(const Eigen::Vector3d& e1, const Eigen::Vector3d& e2) {
  Eigen::Matrix<double, 6, 1> x;
  x << e1, e2;
  return x;
}

/// Random, strongly stretched and sheared, strongly compressed, and nearly degenerate.
inline std::vector<Eigen::Matrix<double, 6, 1>> deformed_triangles() {
  std::vector<Eigen::Matrix<double, 6, 1>> all;
  for (unsigned seed = 1; seed <= 5; ++seed)
    all.push_back(edges(rest1, rest2) + 0.2 * normal_numbers(6, seed));
  all.push_back(edges({2.5, 0.1, 0.4}, {1.9, 2.2, 0.1}));
  all.push_back(edges({0.3, 0.1, -0.1}, {-0.05, 0.25, 0.1}));
  all.push_back(edges({1, 0, 0}, {0.4, 0.02, 0.01}));
  return all;
}

/// What every isotropic membrane by a formula owes beyond tests/conformance. `density` is ψ(μ, λ, a, b) of a
/// triangle stretched to 1 + a and 1 + b along its axes.
template <class Law>
void check_membrane(const std::function<long double(double, double, long double, long double)>& density) {
  using namespace drape;
  using Kernel = MembraneFormulaKernel<Law, 5>;
  using Check = KernelCheck<Kernel>;
  Material material;
  material.thickness = 3e-4;
  material.membrane_modulus = 8e4;
  material.poisson_ratio = 0.3;
  const double modulus = material.membrane_modulus, nu = material.poisson_ratio;
  const double mu = modulus / (2 * (1 + nu)), lambda = modulus * nu / (1 - nu * nu);
  Check::kernel() = {Law({}, material)};
  const auto rest_of = [&](const Eigen::Vector3d& e1, const Eigen::Vector3d& e2) -> typename Kernel::Rest {
    return material_triangles(Level::of(0, mesh_of({{0, 0, 0}, e1, e2}, {{0, 1, 2}})))[0].template head<5>();
  };
  const typename Kernel::Rest rest = rest_of(rest1, rest2);

  SECTION("projection is that of the full element matrix") {
    double smallest = 0;
    for (const auto& x : deformed_triangles()) {
      smallest = std::min(smallest, Check::template projections<double>(x, rest));
      Check::template projections<Pack<native_pack_width>>(x, rest);
    }
    REQUIRE(smallest < -1e-3);  // else nothing was projected
  }
  SECTION("biaxial stretch in closed form, down to small strains") {
    const Eigen::Vector3d e1(0.02, 0, 0), e2(0, 0.03, 0);
    const double volume = 0.02 * 0.03 / 2 * material.thickness;
    for (const double strain : {1e-6, 1e-3, 0.1, 1.0, -0.4}) {
      // Uniaxial stress for small strains: energy density E ε²/2.
      const double a = strain, b = -nu * strain;
      const double expected = volume * double(density(mu, lambda, a, b));
      const double found = Check::evaluate(edges(e1 * (1 + a), e2 * (1 + b)), rest_of(e1, e2)).value;
      CHECK(found == Approx(expected).epsilon(1e-9).margin(0));
      if (strain == 1e-6) CHECK(found == Approx(volume * modulus * a * a / 2).epsilon(1e-5).margin(0));
    }
  }
}

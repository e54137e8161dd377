#include <catch2/catch.hpp>

#include "tests/support/elastica.h"
#include "tests/support/strip.h"

using namespace drape;

namespace {

const std::string bending_models[] = {"hinge", "quadratic_bending"};
/// Cells of the strips, each half as long as the last.
const std::vector<int> refinements = {5, 10, 20, 40};
/// The tolerance is an order above what rounding of the positions makes of forces this stiff (EA/q L is 1e5).
const std::string newton =
    "newton: {step_size: 0.1, step_growth: 2, force_tolerance: 1e-5, max_steps: 500}\n";

/// A strip whose weight gives Γ = ρ g d L³ / D_eff.
BeamStrip strip_for_gamma(int cells, double gamma) {
  BeamStrip strip{cells};
  strip.stiffness = strip.density * standard_gravity * strip.thickness * std::pow(strip.length, 3) / gamma;
  return strip;
}

Solved under_weight(const BeamStrip& strip, const std::string& bending) {
  INFO(strip.cells << " cells, " << bending);
  return converged(solve_yaml(strip.yaml("[neo_hookean, " + bending + ", gravity]", newton)));
}

}  // namespace

TEST_CASE("The reference solution of the elastica has the published figures", "[physics]") {
  const double degree = M_PI / 180;
  CHECK(cantilever_under_weight(1).tip / degree == Approx(9.46).margin(0.005));
  CHECK(cantilever_under_weight(5).tip / degree == Approx(39.94).margin(0.005));
  CHECK(cantilever_under_weight(20).tip / degree == Approx(76.75).margin(0.005));
  CHECK(cantilever_under_weight(100).tip / degree == Approx(89.62).margin(0.005));
  CHECK(cantilever_under_weight(200).tip / degree == Approx(89.97).margin(0.005));
  CHECK(cantilever_under_end_load(1).deflection == Approx(0.30172).margin(5e-6));
  CHECK(cantilever_under_end_load(4).deflection == Approx(0.66996).margin(5e-6));
  // A long beam hangs down after a bend at its clamp, ∫ (1 - sin θ) ds = (2 - √2)/√load.
  CHECK(cantilever_under_end_load(100).deflection == Approx(1 - (2 - std::sqrt(2)) / 10).margin(5e-6));
}

TEST_CASE("A cantilever bends under its own weight", "[physics]") {
  row("\nTip angle [degrees] of a cantilever under its own weight");
  row("%8s %8s %12s %12s %10s %10s", "gamma", "cells", "hinge", "exact", "error", "iterations");
  for (double gamma : {1., 5., 20., 100.}) {
    const double exact = cantilever_under_weight(gamma).tip * 180 / M_PI;
    std::vector<double> errors;
    for (int cells : refinements) {
      const Solved s = under_weight(strip_for_gamma(cells, gamma), "hinge");
      const double angle = tip_angle(s, cells);
      errors.push_back(std::abs(angle - exact));
      row("%8g %8d %12.5f %12.5f %10.2e %10d", gamma, cells, angle, exact, errors.back(),
          s.levels.back().iterations);
    }
    INFO("gamma " << gamma);
    check_order(errors, 2);
    CHECK(errors.back() < 0.02);
  }
}

TEST_CASE("A cantilever bends under a load at its end", "[physics]") {
  row("\nDeflection w/L of a cantilever under an end load");
  row("%8s %8s %12s %12s %10s %10s", "PL²/EI", "cells", "hinge", "exact", "error", "iterations");
  for (double alpha : {1., 4.}) {
    const double exact = cantilever_under_end_load(alpha).deflection;
    std::vector<double> errors;
    for (int cells : refinements) {
      BeamStrip strip{cells};
      strip.stiffness = 100;
      const double load = alpha * strip.stiffness * strip.width() / std::pow(strip.length, 2);
      const Solved s = converged(
          solve_yaml(strip.yaml("[neo_hookean, hinge, " + strip.end_load({0, 0, -load}) + "]", newton)));
      const double deflection = -place(s, cells, cells).z() / strip.length;
      errors.push_back(std::abs(deflection - exact));
      row("%8g %8d %12.6f %12.6f %10.2e %10d", alpha, cells, deflection, exact, errors.back(),
          s.levels.back().iterations);
    }
    INFO("PL²/EI " << alpha);
    check_order(errors, 2);
    CHECK(errors.back() < 2e-4);
  }
}

TEST_CASE("Both bending models give linear beam theory at small angles", "[physics]") {
  const double gamma = 0.1, exact = cantilever_under_weight(gamma).deflection;
  CHECK(exact == Approx(gamma / 8).epsilon(1e-3));
  row("\nDeflection of a stiff cantilever over qL⁴/8EI, gamma = %g; exactly %.7f", gamma,
      exact / (gamma / 8));
  row("%8s %12s %18s", "cells", "hinge", "quadratic_bending");
  std::vector<double> errors[2];
  for (int cells : {5, 10, 20}) {
    BeamStrip strip = strip_for_gamma(cells, gamma);
    strip.slenderness = 0.1;  // narrower cells make quadratic_bending's rounding errors too large here
    double deflection[2];
    for (int model : {0, 1}) {
      const Solved s = under_weight(strip, bending_models[model]);
      deflection[model] = -place(s, cells, cells).z();
      errors[model].push_back(std::abs(deflection[model] / exact - 1));
    }
    row("%8d %12.7f %18.7f", cells, deflection[0] / (gamma / 8), deflection[1] / (gamma / 8));
  }
  for (int model : {0, 1}) {
    INFO(bending_models[model]);
    check_order(errors[model], 2);
    CHECK(errors[model].back() < 2e-3);
  }
}

TEST_CASE("Quadratic bending departs from the hinge where hinges turn far", "[physics]") {
  row("\nTip angle [degrees] by both bending models");
  row("%8s %8s %12s %18s %12s %22s", "gamma", "cells", "hinge", "quadratic_bending", "exact",
      "largest hinge angle");
  for (double gamma : {1., 20., 100.}) {
    const double exact = cantilever_under_weight(gamma).tip * 180 / M_PI;
    double last_gap = 1e9;
    for (int cells : {5, 10, 20}) {
      double angle[2], sharpest = 0;
      for (int model : {0, 1}) {
        const Solved s = under_weight(strip_for_gamma(cells, gamma), bending_models[model]);
        angle[model] = tip_angle(s, cells);
        for (int c = 1; c < cells && model == 0; ++c) {
          const Eigen::Vector3d a = place(s, cells, c) - place(s, cells, c - 1),
                                b = place(s, cells, c + 1) - place(s, cells, c);
          sharpest =
              std::max(sharpest, std::acos(std::min(1.0, a.dot(b) / (a.norm() * b.norm()))) * 180 / M_PI);
        }
      }
      row("%8g %8d %12.4f %18.4f %12.4f %22.2f", gamma, cells, angle[0], angle[1], exact, sharpest);
      const double gap = std::abs(angle[0] - angle[1]);
      CHECK(gap < last_gap);
      last_gap = gap;
    }
    CHECK(last_gap < 0.1);
  }
}

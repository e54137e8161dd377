#include <catch2/catch.hpp>

#include "tests/support/strip.h"

using namespace drape;

namespace {

/// P/P_cr of a clamped–free column whose tip has turned by `angle` [radian]: (2 K(sin α/2)/π)² (Timoshenko
/// and Gere, Theory of Elastic Stability, section 2.7).
double load_ratio(double angle) { return std::pow(2 * std::comp_ellint_1(std::sin(angle / 2)) / M_PI, 2); }

/// The column under `ratio` times its critical load π² EI / 4 L², from a start with smooth noise of 1 % of L.
Solved column(int cells, double ratio) {
  BeamStrip strip{cells};
  strip.stiffness = 100;
  const double load =
      ratio * M_PI * M_PI * strip.stiffness * strip.width() / (4 * strip.length * strip.length);
  return solve_yaml(strip.yaml("[neo_hookean, hinge, " + strip.end_load({-load, 0, 0}) + "]",
                               "start: {perturbation: 0.01, perturbation_wavelength: 3}\n"
                               "newton: {step_size: 0.1, step_growth: 2, force_tolerance: 1e-5,"
                               " max_steps: 1000}\n"));
}

}  // namespace

TEST_CASE("The reference solution of the column has the published figures", "[physics]") {
  CHECK(load_ratio(40 * M_PI / 180) == Approx(1.063).margin(1e-3));
  CHECK(load_ratio(60 * M_PI / 180) == Approx(1.152).margin(1e-3));
}

TEST_CASE("A column stays straight below Euler's load", "[physics]") {
  row("\nLargest deflection |w|/L of a column under 0.95 P_cr");
  for (int cells : {10, 20, 40}) {
    const Solved s = converged(column(cells, 0.95));
    const double start = s.scene->starts.back().col(2).cwiseAbs().maxCoeff(),
                 end = s.x().col(2).cwiseAbs().maxCoeff();
    row("%8d cells: from %.1e to %.1e, %d iterations", cells, start, end, s.levels.back().iterations);
    REQUIRE(start > 1e-3);
    CHECK(end < 1e-4);
  }
}

TEST_CASE("A column bends as far as the elastica beyond Euler's load", "[physics]") {
  row("\nTip angle [degrees] of a clamped-free column");
  row("%10s %8s %12s %12s %10s %10s", "P/P_cr", "cells", "hinge", "exact", "error", "iterations");
  for (double exact : {40., 60.}) {
    const double ratio = load_ratio(exact * M_PI / 180);
    std::vector<double> errors;
    for (int cells : {5, 10, 20, 40}) {
      const Solved s = converged(column(cells, ratio));
      const double angle = std::abs(tip_angle(s, cells));
      errors.push_back(std::abs(angle - exact));
      row("%10.5f %8d %12.4f %12.4f %10.2e %10d", ratio, cells, angle, exact, errors.back(),
          s.levels.back().iterations);
    }
    INFO("tip angle " << exact);
    check_order(errors, 2);
    CHECK(errors.back() < 0.2);
  }
}

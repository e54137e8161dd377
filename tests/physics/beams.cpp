// Beams that bend under their weight and a load, and columns that buckle; at last on every triangulation.

#include <map>

#include "tests/support/strip.h"

using namespace drape;

namespace {

/// The force tolerance is an order above what rounding of the positions makes of forces this stiff (EA/q L is
/// 1e5).
Solved bent(const BeamStrip& strip, const std::string& energies) {
  INFO(strip.cells << " cells, " << energies);
  return converged(solve_yaml(strip.yaml(energies, newton_to(1e-5))));
}

/// A strip whose weight gives Γ = ρ g d L³ / D_eff.
BeamStrip strip_for_gamma(int cells, double gamma) {
  BeamStrip strip(cells);
  strip.stiffness = strip.weight() / gamma;
  return strip;
}

/// P/P_cr of a clamped–free column whose tip has turned by an angle: (2 K(sin α/2)/π)² (Timoshenko and Gere,
/// Theory of Elastic Stability, section 2.7).
double load_ratio(double degrees) {
  return std::pow(2 * std::comp_ellint_1(std::sin(degrees * M_PI / 360)) / M_PI, 2);
}

/// The column under `ratio` times its critical load π² EI / 4 L², from a start with smooth noise of 1 % of L.
Solved column(int cells, double ratio) {
  BeamStrip strip(cells);
  strip.stiffness = 100;
  const double load = ratio * M_PI * M_PI * strip.stiffness * strip.width() / 4;
  return converged(solve_yaml(
      strip.yaml("hinge, " + strip.end_load({-load, 0, 0}),
                 "start: {perturbation: 0.01, perturbation_wavelength: 3}\n" + newton_to(1e-5, 1000))));
}

}  // namespace

TEST_CASE("The reference solution of the elastica has the published figures") {
  const std::map<double, double> degrees = {{1, 9.46}, {5, 39.94}, {20, 76.75}, {100, 89.62}, {200, 89.97}};
  for (const auto& [gamma, tip] : degrees) CHECK(tip_under_weight(gamma) == Approx(tip).margin(0.005));
  // A long beam hangs down after a bend at its clamp, ∫ (1 - sin θ) ds = (2 - √2)/√load.
  const std::map<double, double> deflections = {
      {1, 0.30172}, {4, 0.66996}, {100, 1 - (2 - std::sqrt(2)) / 10}};
  for (const auto& [load, deflection] : deflections)
    CHECK(cantilever_under_end_load(load).deflection == Approx(deflection).margin(5e-6));
}

TEST_CASE("A cantilever bends under its own weight, and quadratic bending departs where hinges turn far") {
  table("Tip angle [degrees] of a cantilever under its own weight", "gamma", "cells", "hinge", "exact",
        "error");
  for (const double gamma : {1., 5., 20., 100.}) {
    double last_gap = 1e9;
    check_convergence(gamma, {5, 10, 20, 40}, tip_under_weight(gamma), 0.02, [&](int cells) {
      const BeamStrip strip = strip_for_gamma(cells, gamma);
      const Solved s = bent(strip, "hinge, gravity");
      if (gamma == 5 || cells == 40) return tip_angle(s);
      double sharpest = 0;  // angle of a hinge
      for (int c = 1; c < cells; ++c) {
        const Eigen::Vector3d a = place(s, c) - place(s, c - 1), b = place(s, c + 1) - place(s, c);
        sharpest = std::max(sharpest, std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI);
      }
      const double quadratic = tip_angle(bent(strip, "quadratic_bending, gravity")),
                   gap = std::abs(tip_angle(s) - quadratic);
      row("", "by quadratic", quadratic, "sharpest", sharpest);
      CHECK(gap < last_gap);
      if (cells == 20) CHECK(gap < 0.1);
      last_gap = gap;
      return tip_angle(s);
    });
  }
}

TEST_CASE("A cantilever bends under a load at its end") {
  table("Deflection w/L of a cantilever under an end load", "PL²/EI", "cells", "hinge", "exact", "error");
  for (const double alpha : {1., 4.})
    check_convergence(alpha, {5, 10, 20, 40}, cantilever_under_end_load(alpha).deflection, 2e-4,
                      [&](int cells) {
                        BeamStrip strip(cells);
                        strip.stiffness = 100;
                        const double load = alpha * strip.stiffness * strip.width();
                        return -end_of(bent(strip, "hinge, " + strip.end_load({0, 0, -load}))).z();
                      });
}

TEST_CASE("Both bending models give linear beam theory at small angles") {
  const double gamma = 0.1, exact = cantilever_under_weight(gamma).deflection / (gamma / 8);
  CHECK(exact == Approx(1).epsilon(1e-3));
  table("Deflection of a stiff cantilever over qL⁴/8EI, gamma = 0.1", "model", "cells", "found", "exact",
        "error");
  for (const std::string model : {"hinge", "quadratic_bending"})
    check_convergence(model, {5, 10, 20}, exact, 2e-3 * exact, [&](int cells) {
      BeamStrip strip = strip_for_gamma(cells, gamma);
      strip.slenderness = 0.1;  // narrower cells make quadratic_bending's rounding errors too large here
      return -end_of(bent(strip, model + ", gravity")).z() / (gamma / 8);
    });
}

TEST_CASE("A column stays straight below Euler's load") {
  table("Largest deflection |w|/L of a column under 0.95 P_cr", "cells", "at start", "at rest");
  for (const int cells : {10, 20, 40}) {
    const Solved s = column(cells, 0.95);
    const double start = s.scene->starts.back().col(2).cwiseAbs().maxCoeff(),
                 end = s.x().col(2).cwiseAbs().maxCoeff();
    row(cells, start, end);
    REQUIRE(start > 1e-3);
    CHECK(end < 1e-4);
  }
}

TEST_CASE("A column bends as far as the elastica beyond Euler's load") {
  CHECK(load_ratio(40) == Approx(1.063).margin(1e-3));  // the published figures
  CHECK(load_ratio(60) == Approx(1.152).margin(1e-3));
  table("Tip angle [degrees] of a clamped-free column", "P/P_cr", "cells", "hinge", "exact", "error");
  for (const double exact : {40., 60.}) {
    const double ratio = load_ratio(exact);
    check_convergence(ratio, {5, 10, 20, 40}, exact, 0.2,
                      [&](int cells) { return std::abs(tip_angle(column(cells, ratio))); });
  }
}

// Strips that bend far, by hinge and by midedge_bending, on every triangulation.

namespace {

/// `stiffness` is EI per width [N m]: D for midedge_bending, 3 D for hinge along a grid's edges (ν = 0).
Solved bent(const CutStrip& strip, const std::string& bending, double stiffness, const std::string& load) {
  const double modulus = (bending == "hinge" ? 4 : 12) * stiffness / std::pow(CutStrip::thickness, 3);
  return strip.solved(filled("bending_modulus: $, poisson_ratio: 0", modulus),
                      filled("neo_hookean, $, $", bending, load));
}

/// How much higher the end's corner at y = width is than the one at y = 0 [mm].
double twist(const Solved& s) {
  Eigen::Index far = 0, near = 0;
  (s.rest().col(0) + s.rest().col(1)).maxCoeff(&far);
  (s.rest().col(0) - s.rest().col(1)).maxCoeff(&near);
  return 1e3 * (s.x()(far, 2) - s.x()(near, 2));
}

}  // namespace

TEST_CASE("A strip under its weight bends alike on every triangulation with midedge_bending, untwisted") {
  const double gamma = 5, exact = tip_under_weight(gamma);
  table("Tip angle [degrees], exactly " + text(exact) + ", and twist [mm] of a strip of 1 × 0.2 m",
        "triangles", "cells", "hinge", "twist", "midedge", "twist");
  for (const std::string& triangulation : all_triangulations) {
    std::vector<double> errors;
    for (const int cells : {10, 20, 40}) {
      const CutStrip strip{{cells, cells / 5}, triangulation};
      const auto by = [&](const char* bending) {
        return bent(strip, bending, CutStrip::weight() / gamma, "gravity");
      };
      const Solved by_hinge = by("hinge"), by_midedge = by("midedge_bending");
      const double hinge_twist = twist(by_hinge), midedge_twist = twist(by_midedge);
      errors.push_back(std::abs(strip.tip_angle(by_midedge) - exact));
      row(triangulation, cells, strip.tip_angle(by_hinge), hinge_twist, strip.tip_angle(by_midedge),
          midedge_twist);
      if (triangulation == "one_way") {
        CHECK(hinge_twist > 20);  // at every resolution
        CHECK(std::abs(midedge_twist) < 50. / (cells * cells));
      }
      if (cells == 40) CHECK(std::abs(midedge_twist) < 0.5);
    }
    INFO(triangulation);
    if (is_grid(triangulation)) check_order(errors);
    // Within the clamp's uncertainty of half a cell, which is 3 Γ ∂θ/∂Γ a/2.
    CHECK(errors[2] < (is_grid(triangulation) ? 0.01 : 0.9));
  }
}

TEST_CASE("A strip with a load at its end bends alike on every triangulation with midedge_bending") {
  const double stiffness = 20;
  table("Deflection over the length of strips with a load at the end", "triangles", "P L²/EI", "cells",
        "found");
  for (const std::string& triangulation : all_triangulations)
    for (const double alpha : {1., 4.}) {
      std::vector<double> errors;
      for (const int cells : {10, 20, 40}) {
        const CutStrip strip{{cells, 2}, triangulation};
        const std::string load =
            end_load(strip.length(), strip.width(), {0, 0, -alpha * stiffness * strip.width()});
        const double deflection =
            -strip.mean(bent(strip, "midedge_bending", stiffness, load), -0.01, 0.01).z();
        errors.push_back(std::abs(deflection - cantilever_under_end_load(alpha).deflection));
        row(triangulation, alpha, cells, deflection);
      }
      INFO(triangulation << ", " << alpha);
      if (is_grid(triangulation)) check_order(errors);
      CHECK(errors[2] < (is_grid(triangulation) ? 1e-3 : 0.03));
    }
}

// Strips that bend far, by hinge and by midedge_bending, on every triangulation.

#include <catch2/catch.hpp>

#include "tests/support/cut_strip.h"
#include "tests/support/elastica.h"

using namespace drape;

namespace {

struct Strip : CutStrip {
  /// `stiffness` is EI per width [N m]: D for midedge_bending, 3 D for hinge along a grid's edges (ν = 0).
  Solved bent(const std::string& bending, double stiffness, const std::string& load) const {
    const double modulus = (bending == "hinge" ? 4 : 12) * stiffness / std::pow(thickness, 3);
    return solved("bending_modulus: " + text(modulus) + ", poisson_ratio: 0",
                  "neo_hookean, " + bending + ", " + load);
  }

  /// How much higher the end's corner at y = width is than the one at y = 0 [m].
  double twist(const Solved& s) const {
    double z[2] = {0, 0};
    for (Eigen::Index v = 0; v < s.rest().rows(); ++v)
      if (s.rest()(v, 0) > length() - 0.01 * cell()) {
        if (s.rest()(v, 1) == 0) z[0] = s.x()(v, 2);
        if (s.rest()(v, 1) > width() - 0.01 * cell()) z[1] = s.x()(v, 2);
      }
    return z[1] - z[0];
  }
};

}  // namespace

TEST_CASE(
    "A strip under its weight bends alike on every triangulation with midedge_bending, and does not twist",
    "[physics]") {
  const double gamma = 5, exact = cantilever_under_weight(gamma).tip * 180 / M_PI;
  row("\nTip angle [degrees], exactly %.4f, and twist [mm] of a strip of 1 × 0.2 m under its weight", exact);
  row("%14s %8s %12s %10s %12s %10s", "triangles", "cells", "hinge", "twist", "midedge", "twist");
  for (const std::string& triangulation : all_triangulations) {
    std::vector<double> errors;
    for (const int cells : {10, 20, 40}) {
      const Strip strip{{triangulation, cells, cells / 5}};
      const double stiffness = Strip::density * standard_gravity * Strip::thickness / gamma;
      const Solved by_hinge = strip.bent("hinge", stiffness, "gravity"),
                   by_midedge = strip.bent("midedge_bending", stiffness, "gravity");
      const double twist = strip.twist(by_midedge);
      errors.push_back(std::abs(strip.tip_angle(by_midedge) - exact));
      row("%14s %8d %12.4f %10.3f %12.4f %10.3f", triangulation.c_str(), cells, strip.tip_angle(by_hinge),
          1e3 * strip.twist(by_hinge), strip.tip_angle(by_midedge), 1e3 * twist);
      INFO(triangulation << ", " << cells << " cells");
      if (triangulation == "one_way") {
        CHECK(strip.twist(by_hinge) > 0.02);  // at every resolution
        CHECK(std::abs(twist) < 0.05 / (cells * cells));
      }
      if (cells == 40) CHECK(std::abs(twist) < 5e-4);
    }
    INFO(triangulation);
    if (is_grid(triangulation)) check_order(errors, 2);
    // Within the clamp's uncertainty of half a cell, which is 3 Γ ∂θ/∂Γ a/2.
    CHECK(errors[2] < (is_grid(triangulation) ? 0.01 : 0.9));
  }
}

TEST_CASE("A strip with a load at its end bends alike on every triangulation with midedge_bending",
          "[physics]") {
  row("\nDeflection over the length of strips with a load at the end, P L²/EI = 1 and 4");
  row("%14s %8s %12s %12s", "triangles", "cells", "1", "4");
  for (const std::string& triangulation : all_triangulations) {
    std::vector<double> errors[2];
    for (const int cells : {10, 20, 40}) {
      const Strip strip{{triangulation, cells, 2}};
      double deflection[2];
      for (int i = 0; i < 2; ++i) {
        const double alpha = i == 0 ? 1 : 4, stiffness = 20;
        const Eigen::Vector3d force(0, 0, -alpha * stiffness * strip.width());
        const Solved s =
            strip.bent("midedge_bending", stiffness, end_load(strip.length(), strip.width(), force));
        deflection[i] = -strip.mean(s, -0.01, 0.01).z();
        errors[i].push_back(std::abs(deflection[i] - cantilever_under_end_load(alpha).deflection));
      }
      row("%14s %8d %12.6f %12.6f", triangulation.c_str(), cells, deflection[0], deflection[1]);
    }
    INFO(triangulation);
    for (int i = 0; i < 2; ++i) {
      if (is_grid(triangulation)) check_order(errors[i], 2);
      CHECK(errors[i][2] < (is_grid(triangulation) ? 1e-3 : 0.03));
    }
  }
}

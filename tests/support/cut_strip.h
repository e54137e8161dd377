#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <string>

#include "tests/support/strip.h"

inline bool is_grid(const std::string& triangulation) {
  return triangulation == "one_way" || triangulation == "criss_cross";
}

/// A strip of cells × across square cells' size along x, in any triangles, clamped where x is up to one cell.
/// On grids the clamp is in the middle of that cell (see BeamStrip), on others somewhere in it: L = (cells -
/// 1/2) cells is taken to be 1 m.
struct CutStrip {
  std::string triangulation;
  int cells, across;
  double grain = 0;  ///< of warp to the strip [degree]

  static constexpr double density = 1000, thickness = 0.01;
  double cell() const { return 1 / (cells - 0.5); }
  double length() const { return cells * cell(); }
  double width() const { return across * cell(); }

  /// `material` and `energies` are YAML: keys, and items of a list.
  Solved solved(const std::string& material, const std::string& energies) const {
    const std::string counts =
        is_grid(triangulation)
            ? ", columns: " + std::to_string(cells + 1) + ", rows: " + std::to_string(across + 1)
            : ", vertices: " + std::to_string((cells + 1) * (across + 1));
    INFO(triangulation << ", " << cells << " cells, " << energies);
    return converged(solve_yaml(
        "name: strip\ncloth: {shape: rectangle, triangulation: " + triangulation + ", size: [" +
        text(length()) + ", " + text(width()) + "]" + counts + ", grain: " + text(grain) +
        "}\nlevels: 1\nmaterial: {density: " + text(density) + ", thickness: " + text(thickness) +
        ", membrane_modulus: 1e8, " + material + "}\npins: [{region: box, lower: [-1, -1, -1], upper: [" +
        text(1.01 * cell()) + ", 1, 1]}]\nenergies: [" + energies +
        "]\nmethods: {newton: {}}\n"
        "newton: {step_size: 0.1, step_growth: 2, force_tolerance: 1e-5, max_steps: 500}\n"));
  }

  /// Mean place of the vertices between two distances [cells] from the free end.
  Eigen::Vector3d mean(const Solved& s, double from, double to) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    int count = 0;
    for (Eigen::Index v = 0; v < s.rest().rows(); ++v) {
      const double distance = (length() - s.rest()(v, 0)) / cell();
      if (distance < from || distance > to) continue;
      sum += s.x().row(v).transpose();
      ++count;
    }
    REQUIRE(count > 0);
    return sum / count;
  }

  /// Below the horizontal [degree].
  double tip_angle(const Solved& s) const {
    const Eigen::Vector3d d = mean(s, -0.01, 0.01) - mean(s, 0.3, 1.7);
    return std::atan2(-d.z(), d.x()) * 180 / M_PI;
  }
};

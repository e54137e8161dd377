#pragma once

#include "core/numerics/patterns/generate.h"
#include "tests/support/known_answers.h"
#include "tests/support/registry.h"
#include "tests/support/solve.h"

/// The ways in which a rectangle is cut into triangles.
inline const std::string all_triangulations[] = {"one_way", "criss_cross", "equilateral", "random"};
inline bool is_grid(const std::string& triangulation) {
  return triangulation == "one_way" || triangulation == "criss_cross";
}

/// A rectangle cut in such a way into about 2 · cells.x · cells.y triangles, or with edges of about a.
inline drape::TriangleMesh triangulated(const std::string& triangulation, const Eigen::Vector2d& size,
                                        const Eigen::Vector2i& cells) {
  const int vertices = (cells.x() + 1) * (cells.y() + 1);
  if (triangulation == "random") return drape::random_triangulation(size, vertices, 5);
  if (triangulation == "equilateral") {
    const Eigen::Vector2i counts = drape::equilateral_counts(size, vertices);
    return drape::equilateral(size, counts.x(), counts.y());
  }
  return drape::grid(size, cells.x() + 1, cells.y() + 1,
                     triangulation == "one_way" ? drape::Diagonals::one_way : drape::Diagonals::criss_cross);
}
inline drape::TriangleMesh triangulated(const std::string& triangulation, const Eigen::Vector2d& size,
                                        double a) {
  return triangulated(triangulation, size, Eigen::Vector2i((size / a).array().round().cast<int>()));
}

/// An energy on a plate with D = E d³ / 12 (1 − ν²) = 1 N m.
inline std::unique_ptr<drape::BoundEnergy> on_unit_plate(const std::string& energy, const drape::Level& level,
                                                         double nu) {
  drape::Material m;
  m.thickness = 0.01;
  m.poisson_ratio = nu;
  m.bending_modulus = 12 * (1 - nu * nu) / 1e-6;
  return make_plugin_from<drape::Energy>(energy)->bind(level, m);
}

/// A load [N] spread evenly over the end at x of a strip of three rows of vertices, as an item of `energies`.
inline std::string end_load(double x, double width, const Eigen::Vector3d& force) {
  const Eigen::Vector3d side = force * 0.25, middle = force * 0.5;
  return filled(
      "{type: constant_load, points: [{point: [$, 0, 0], force: $}, {point: [$, $, 0], force: $}, "
      "{point: [$, $, 0], force: $}]}",
      x, side, x, width / 2, middle, x, width, side);
}

/// A strip of cloth along x, clamped at the left, of cells × across cells. The hinges of a grid's column j
/// carry the curvature from half a cell before it to half a cell behind. With columns 0 and 1 pinned, the
/// first hinges that can bend are those of column 1, and the clamp is at half a cell: (cells - 1/2) cells
/// make the free length, 1 m. In other triangles the clamp is somewhere in the first cell.
struct ClampedStrip {
  int cells, across;
  static constexpr double density = 1000, thickness = 0.01;  // [kg/m³], [m]

  double cell() const { return 1 / (cells - 0.5); }
  double length() const { return cells * cell(); }
  /// Of the strip, per area [N/m²].
  static double weight() { return density * drape::standard_gravity * thickness; }

  /// `cloth`, `material` and `energies` are YAML: keys, and items of a list; `more` are keys of the
  /// experiment.
  std::string yaml(double width, const std::string& cloth, const std::string& material,
                   const std::string& energies, const std::string& more) const {
    return experiment(R"(cloth: {shape: rectangle, size: [$, $], $}
material: {density: $, thickness: $, $}
pins: [{region: box, lower: [-1, -1, -1], upper: [$, 1, 1]}]
energies: [$]
$)",
                      length(), width, cloth, density, thickness, material, 1.01 * cell(), energies, more);
  }
};

/// A beam: two rows of criss-cross cells, mirrored at the middle line, so that bending does not twist it. Its
/// cells are far longer than wide: with wide ones the diagonals would bend along (see
/// plugins/energy/hinge/README.md, "Stiffness on a mesh").
struct BeamStrip : ClampedStrip {
  double stiffness = 1;       ///< EI per width that the strip shall have, D_eff = 6 k = E_bend d³ / 4 [N m]
  double slenderness = 0.06;  ///< width of a cell over its length

  explicit BeamStrip(int of_cells) : ClampedStrip{of_cells, 2} {}
  double width() const { return 2 * slenderness * cell(); }
  std::string yaml(const std::string& energies, const std::string& more) const {
    return ClampedStrip::yaml(width(), filled("triangulation: criss_cross, columns: $, rows: 3", cells + 1),
                              filled("membrane_modulus: 1e9, bending_modulus: $, poisson_ratio: 0",
                                     4 * stiffness / std::pow(thickness, 3)),
                              "neo_hookean, " + energies, more);
  }
  /// A load [N] on the free end, as an item of `energies`.
  std::string end_load(const Eigen::Vector3d& force) const { return ::end_load(length(), width(), force); }
};

/// Vertex of the middle line of a solved beam at a column.
inline Eigen::Vector3d place(const Solved& s, Eigen::Index column) {
  return s.x().row(s.x().rows() / 3 + column).transpose();
}
/// Its free end.
inline Eigen::Vector3d end_of(const Solved& s) { return place(s, s.x().rows() / 3 - 1); }

/// The angle below the horizontal [degree].
inline double degrees_down(const Eigen::Vector3d& d) { return std::atan2(-d.z(), d.x()) * 180 / M_PI; }

/// That of the beam's last segment.
inline double tip_angle(const Solved& s) { return degrees_down(end_of(s) - place(s, s.x().rows() / 3 - 2)); }

/// A strip of square cells' size in any triangles.
struct CutStrip : ClampedStrip {
  std::string triangulation;
  double grain = 0;  ///< of warp to the strip [degree]

  double width() const { return across * cell(); }
  Solved solved(const std::string& material, const std::string& energies) const {
    const std::string counts = is_grid(triangulation) ? filled("columns: $, rows: $", cells + 1, across + 1)
                                                      : filled("vertices: $", (cells + 1) * (across + 1));
    INFO(triangulation << ", " << cells << " cells, " << energies);
    return converged(
        solve_yaml(yaml(width(), filled("triangulation: $, $, grain: $", triangulation, counts, grain),
                        "membrane_modulus: 1e8, " + material, energies, newton_to(1e-5))));
  }

  /// Mean place of the vertices between two distances [cells] from the free end.
  Eigen::Vector3d mean(const Solved& s, double from, double to) const {
    const Eigen::ArrayXd distance = (length() - s.rest().col(0).array()) / cell();
    const Eigen::VectorXd chosen = (distance >= from && distance <= to).cast<double>();
    REQUIRE(chosen.sum() > 0);
    return s.x().transpose() * chosen / chosen.sum();
  }
  double tip_angle(const Solved& s) const { return degrees_down(mean(s, -0.01, 0.01) - mean(s, 0.3, 1.7)); }
};

/// The inextensible beam (Euler's elastica) in the plane, L = EI = 1: θ'' = -load(s, θ), θ(0) = 0, θ'(1) = 0,
/// θ being the angle below the clamped tangent.
struct Elastica {
  double tip;         ///< θ(1)
  double deflection;  ///< ∫ sin θ ds
};

/// Integrates backwards from the free end with angle `tip` there; returns θ(0), or the first θ below 0. A
/// beam that bends one way only has θ ≥ 0 all along; beyond its clamp's angle a long one swings on like a
/// pendulum, through 0 again and again.
template <class Load>
double angle_at_clamp(const Load& load, double tip, double& deflection) {
  constexpr int steps = 4000;
  constexpr double h = -1.0 / steps;
  using State = Eigen::Vector2d;  // θ and θ'
  const auto rate = [&](double s, const State& at) { return State(at[1], -load(s, at[0])); };
  State state(tip, 0);
  deflection = 0;
  for (int i = 0; i < steps && state[0] >= 0; ++i) {
    const double s = 1 + i * h;
    const State a = rate(s, state), b = rate(s + h / 2, state + h / 2 * a),
                c = rate(s + h / 2, state + h / 2 * b), d = rate(s + h, state + h * c),
                next = state + h / 6 * (a + 2 * b + 2 * c + d);
    deflection -= h / 6 * (std::sin(state[0]) + 4 * std::sin(state[0] + h / 2 * b[0]) + std::sin(next[0]));
    state = next;
  }
  return state[0];
}

/// A cantilever, by bisection for the tip's angle between 0 and π/2: it bends one way only. The angle is
/// within e^(-⅔ √load) of π/2, so that doubles are too coarse for loads of a thousand and more.
template <class Load>
Elastica cantilever_under(const Load& load) {
  double low = 0, high = M_PI / 2, deflection = 0;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (angle_at_clamp(load, middle, deflection) > 0 ? high : low) = middle;
  }
  return {(low + high) / 2, deflection};
}

/// Under its own weight, Γ = q L³ / EI.
inline Elastica cantilever_under_weight(double gamma) {
  return cantilever_under([=](double s, double theta) { return gamma * (1 - s) * std::cos(theta); });
}

/// The angle of its tip [degree].
inline double tip_under_weight(double gamma) { return cantilever_under_weight(gamma).tip * 180 / M_PI; }

/// Under a dead load at its end, α = P L² / EI.
inline Elastica cantilever_under_end_load(double alpha) {
  return cantilever_under([=](double, double theta) { return alpha * std::cos(theta); });
}

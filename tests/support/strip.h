#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <string>
#include <vector>

#include "core/numerics/patterns/generate.h"
#include "tests/support/solve.h"

/// The shortest text that reads back as the same number.
inline std::string text(double number) { return drape::ConfigNode::of(number).scalar; }

inline std::string text(const Eigen::Vector3d& v) {
  return "[" + text(v.x()) + ", " + text(v.y()) + ", " + text(v.z()) + "]";
}

/// The ways in which a rectangle is cut into triangles.
inline const std::string all_triangulations[] = {"one_way", "criss_cross", "equilateral", "random"};

/// A rectangle cut in such a way into about 2 · cells.x · cells.y triangles.
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
/// The same with edges of about a.
inline drape::TriangleMesh triangulated(const std::string& triangulation, const Eigen::Vector2d& size,
                                        double a) {
  const Eigen::Vector2i cells = (size / a).array().round().cast<int>();
  return triangulated(triangulation, size, cells);
}

/// A load [N] spread evenly over the end at x of a strip of three rows of vertices, as an item of `energies`.
inline std::string end_load(double x, double width, const Eigen::Vector3d& force) {
  std::string points;
  for (int j = 0; j < 3; ++j)
    points += (j ? ", " : "") + std::string("{point: ") + text({x, j * width / 2, 0}) +
              ", force: " + text(force * (j == 1 ? 0.5 : 0.25)) + "}";
  return "{type: constant_load, points: [" + points + "]}";
}

/// D = E d³ / 12 (1 − ν²) = 1 N m.
inline drape::Material unit_plate(double nu) {
  drape::Material m;
  m.thickness = 0.01;
  m.poisson_ratio = nu;
  m.bending_modulus = 12 * (1 - nu * nu) / 1e-6;
  return m;
}

/// A beam made of cloth along x, clamped at the left, of `cells` cells by two, cut like a union jack:
/// mirrored at its middle line, so that bending does not twist it. Its cells are far longer than wide: with
/// wide ones the diagonals would bend along (see docs/results/validation.md, "What the hinge model's
/// stiffness is").
///
/// The hinges of column j carry the curvature from half a cell before it to half a cell behind. With columns
/// 0 and 1 pinned, the first hinges that can bend are those of column 1, and the clamp is at half a cell. The
/// free end is column `cells`, so (cells - 1/2) cells make the free length.
struct BeamStrip {
  int cells;
  double length = 1;              ///< L, free [m]
  double density = 1000;          ///< ρ [kg/m³]
  double thickness = 0.01;        ///< d [m]
  double membrane_modulus = 1e9;  ///< [Pa]
  double slenderness = 0.06;      ///< width of a cell over its length
  double stiffness = 1;  ///< EI per width that the strip shall have, D_eff = 6 k = E_bend d³ / 4 [N m]

  double cell() const { return length / (cells - 0.5); }
  double total() const { return cells * cell(); }
  double width() const { return 2 * slenderness * cell(); }
  double bending_modulus() const { return 4 * stiffness / std::pow(thickness, 3); }

  /// `energies` and `more` are YAML: a list, and further keys of the experiment.
  std::string yaml(const std::string& energies, const std::string& more) const {
    return "name: strip\ncloth: {shape: rectangle, triangulation: criss_cross, size: [" + text(total()) +
           ", " + text(width()) + "], columns: " + std::to_string(cells + 1) + ", rows: 3}\nlevels: 1\n" +
           "material: {density: " + text(density) + ", thickness: " + text(thickness) +
           ", membrane_modulus: " + text(membrane_modulus) + ", bending_modulus: " + text(bending_modulus()) +
           ", poisson_ratio: 0}\n" + "pins: [{region: box, lower: [-1, -1, -1], upper: [" +
           text(1.01 * cell()) + ", 1, 1]}]\n" + "energies: " + energies + "\nmethods: {newton: {}}\n" + more;
  }

  /// A load [N] on the free end, as an item of `energies`.
  std::string end_load(const Eigen::Vector3d& force) const { return ::end_load(total(), width(), force); }
};

/// Vertex of the middle line at a column of a solved strip.
inline Eigen::Vector3d place(const Solved& s, int cells, int column) {
  return s.x().row(column + cells + 1).transpose();
}

/// Angle of the last segment below the horizontal [degrees].
inline double tip_angle(const Solved& s, int cells) {
  const Eigen::Vector3d d = place(s, cells, cells) - place(s, cells, cells - 1);
  return std::atan2(-d.z(), d.x()) * 180 / M_PI;
}

/// Prints a row of a table, as printf does.
[[gnu::format(printf, 1, 2)]] inline void row(const char* format, ...) {
  std::va_list values;
  va_start(values, format);
  std::vprintf(format, values);
  va_end(values);
  std::printf("\n");
}

/// Errors of successive refinements by two must fall, about as fast as the order says.
inline void check_order(const std::vector<double>& errors, double order) {
  REQUIRE(errors.size() >= 3);
  for (std::size_t i = 1; i < errors.size(); ++i) {
    INFO("error " << errors[i - 1] << " → " << errors[i]);
    CHECK(errors[i] < errors[i - 1]);
  }
  const double last = std::log2(errors[errors.size() - 2] / errors.back());
  CHECK(last > order - 0.4);
  CHECK(last < order + 0.6);
}

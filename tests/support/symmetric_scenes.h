#pragma once

#include <array>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/strip.h"

// Scenes whose exactly symmetric starts hide an instability, and what tests of stability share.

inline const std::string off = "newton: {stability: off}\n";

inline double largest_entry(const Eigen::VectorXd& values) { return values.cwiseAbs().maxCoeff(); }

/// Of the last level.
inline const drape::Stability& stability_of(const Solved& s) {
  REQUIRE(s.levels.back().stability);
  return *s.levels.back().stability;
}

/// A triangle mesh of rings of n vertices, each turned by half an edge from the one before; ring j at
/// place(j, angle).
template <class Place>
std::string rings(int n, int count, bool outward, const Place& place) {
  std::ostringstream obj;
  obj.precision(17);
  for (int j = 0; j < count; ++j)
    for (int i = 0; i < n; ++i) {
      const Eigen::Vector3d p = place(j, 2 * M_PI * (i + 0.5 * (j % 2)) / n);
      obj << "v " << p.x() << ' ' << p.y() << ' ' << p.z() << '\n';
    }
  for (int j = 0; j + 1 < count; ++j)
    for (int i = 0; i < n; ++i) {
      const int a = j * n + i + 1, b = j * n + (i + 1) % n + 1, c = a + n, d = b + n;
      std::vector<std::array<int, 3>> faces = {{a, b, c}, {b, d, c}};
      if (j % 2) faces = {{a, d, c}, {a, b, d}};
      for (auto [p, q, r] : faces) {
        if (!outward) std::swap(q, r);
        obj << "f " << p << ' ' << q << ' ' << r << '\n';
      }
    }
  return obj.str();
}

inline std::string indices(int first, int count) {
  std::string text = "[";
  for (int i = 0; i < count; ++i) text += (i ? ", " : "") + std::to_string(first + i);
  return text + "]";
}

inline constexpr const char* two_levels = "name: scene\nlevels: 2\nmethods: {pcs: {}, newton: {}}\n";
inline constexpr const char* thin =
    "material: {density: 1000, thickness: 5e-4, membrane_modulus: 1e6, bending_modulus: 1e6, poisson_ratio: "
    "0.3}\n";
inline constexpr const char* film =
    "material: {density: 1000, thickness: 1e-4, membrane_modulus: 1e6, bending_modulus: 1e6, poisson_ratio: "
    "0.3}\n";

inline std::string ends_of(double length) {
  return filled(
      "{region: box, lower: [-1, -1, -1], upper: [1e-4, 1, 1]}, {region: box, lower: [$, -1, -1], upper: [1, "
      "1, 1]",
      length - 1e-4);
}
inline std::string one_key(const std::string& parameter, const std::string& values, int steps = 5) {
  return filled("schedule: {steps: $, equilibrate: true, keys: [{parameter: $, times: [0, 1], values: $}]}\n",
                steps, parameter, values);
}

/// A symmetric scene, and a mesh that it may name as mesh.obj.
struct Symmetric {
  std::string name, keys, mesh = {};

  Solved solved(const std::string& method, bool leaves) const {
    const Scratch folder(two_levels + keys + (leaves ? "" : off));
    if (!mesh.empty()) folder.write("mesh.obj", mesh);
    Solved s{experiment_in(folder / "e.yaml"), nullptr, {}};
    s.scene = scene_of(s.experiment);
    run_method(s, method);
    return s;
  }
};

inline std::vector<Symmetric> symmetric_scenes() {
  const std::string
      elastic = "energies: [neo_hookean, hinge]\n",
      heavy = "energies: [neo_hookean, hinge, gravity]\n",
      small_square = "cloth: {shape: square, side: 0.1, columns: 15, rows: 15, triangulation: criss_cross}\n";
  const std::string ring = rings(40, 9, false, [](int j, double a) -> Eigen::Vector3d {
    return (0.03 + 0.07 * j / 8) * Eigen::Vector3d(std::cos(a), std::sin(a), 0);
  });
  return {
      {"a strip whose ends are pushed together",
       "cloth: {shape: rectangle, size: [0.2, 0.1], columns: 11, rows: 6, triangulation: criss_cross}\n" +
           std::string(thin) + "pins: [" + ends_of(0.2) + ", translate: [0, 0, 0]}]\n" + elastic +
           one_key("pins.1.translate", "[[0, 0, 0], [-0.01, 0, 0]]")},
      {"an annulus whose inner border turns",
       "cloth: {shape: file, file: mesh.obj}\n" + std::string(thin) + "pins: [{region: vertices, vertices: " +
           indices(320, 40) + "}, {region: vertices, vertices: " + indices(0, 40) +
           ", rotate: [0, 0, 0]}]\n" + elastic + one_key("pins.1.rotate", "[[0, 0, 0], [0, 0, 20]]"),
       ring},
      {"a square that is stretched by two corners",
       small_square + thin +
           "pins: [{region: ball, point: [0, 0, 0], radius: 0.008}, {region: ball, point: [0.1, 0.1, 0], "
           "radius: 0.008, "
           "translate: [0, 0, 0]}]\n" +
           elastic + one_key("pins.1.translate", "[[0, 0, 0], [0.015, 0.015, 0]]")},
      {"a flag pole, too high for its weight",
       "cloth: {shape: rectangle, size: [0.1025, 0.01], columns: 42, rows: 5, triangulation: criss_cross}\n" +
           std::string(thin) +
           "start: {rotate: [0, -90, 0]}\npins: [{region: box, lower: [-1, -1, -1], upper: [0.0026, 1, "
           "1]}]\n" +
           heavy},
      {"a film that is sheared",
       "cloth: {shape: rectangle, size: [0.2, 0.05], columns: 41, rows: 11, triangulation: criss_cross}\n" +
           std::string(film) +
           "pins: [{region: box, lower: [-1, -1, -1], upper: [1, 1e-4, 1]}, {region: box, lower: [-1, "
           "0.0499, -1], upper: [1, 1, "
           "1], translate: [0, 0, 0]}]\n" +
           elastic + one_key("pins.1.translate", "[[0, 0, 0], [0.005, 0, 0]]")},
      {"a square in a frame that is too small",
       small_square + thin + "start: {scale: [0.97, 0.97, 1]}\npins: [{region: border}]\n" + elastic},
      {"a disc in a ring that is too small",
       "cloth: {shape: disc, radius: 0.05, vertices: 200}\n" + std::string(thin) +
           "start: {scale: [0.97, 0.97, 1]}\npins: [{region: border}]\n" + elastic},
      {"a strip on its edge, under its weight",
       "cloth: {shape: rectangle, size: [0.205, 0.01], columns: 42, rows: 3}\n"
       "material: {density: 1000, thickness: 2e-4, membrane_modulus: 1.112e9, bending_modulus: 1.112e9, "
       "poisson_ratio: 0.3}\n"
       "pins: [{region: box, lower: [-1, -1, -1], upper: [0.0051, 1, 1]}]\n"
       "energies: [neo_hookean, midedge_bending, {type: gravity, acceleration: [0, -9.81, 0]}]\n"},
      {"a square whose opposite sides slide apart",
       small_square + thin + "pins: [" + ends_of(0.1) + ", translate: [0, 0, 0]}]\n" + elastic +
           one_key("pins.1.translate", "[[0, 0, 0], [0, 0.03, 0]]")},
      {"a sheet that is pulled between clamps",
       "cloth: {shape: rectangle, size: [0.25, 0.1], triangulation: criss_cross, columns: 51, rows: 21}\n"
       "material: {density: 1000, thickness: 1e-4, membrane_modulus: 1e6, bending_modulus: 1e6, "
       "poisson_ratio: 0.49}\n"
       "pins: [" +
           ends_of(0.25) + ", translate: [0, 0, 0]}]\nenergies: [neo_hookean, midedge_bending]\n" +
           one_key("pins.1.translate", "[[0, 0, 0], [0.025, 0, 0]]")},
      {"an upright square that its weight presses",
       small_square + thin +
           "start: {rotate: [90, 0, 0]}\npins: [{region: box, lower: [-1, -1, -1], upper: [1, 1e-4, 1]}]\n" +
           heavy},
      {"a strip on its edge, pulled down at its end",
       "cloth: {shape: rectangle, size: [0.205, 0.01], columns: 42, rows: 3}\n"
       "material: {density: 1000, thickness: 2e-4, membrane_modulus: 1e8, bending_modulus: 1e9, "
       "poisson_ratio: 0.3}\n"
       "pins: [{region: box, lower: [-1, -1, -1], upper: [0.0051, 1, 1]}]\n"
       "energies: [neo_hookean, midedge_bending, {type: constant_load, points: [{point: [0.205, 0.005, 0], "
       "force: [0, -0.01, 0]}]}]\n"},
  };
}

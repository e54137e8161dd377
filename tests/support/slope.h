#pragma once

#include <cmath>
#include <cstdio>
#include <string>

#include "core/numerics/contact_forces/contact_stiffness.h"

inline constexpr double gravity = 9.81, dhat = 1e-3;

/// -b'(s) of the barrier b(s) = -(s - 1)² ln s.
inline double barrier_slope(double s) { return 2 * (s - 1) * std::log(s) + (s - 1) * (s - 1) / s; }

/// The gap at which the barrier carries a pressure [m].
inline double resting_gap(double pressure, double stiffness, double dhat) {
  double low = 1e-12, high = 1;
  for (int k = 0; k < 200; ++k) {
    const double middle = 0.5 * (low + high);
    (stiffness * barrier_slope(middle) > pressure ? low : high) = middle;
  }
  return dhat * low;
}

/// A patch of cotton at rest on the floor z = 0, under gravity that is turned by `angle` from the vertical.
/// `contact` is a contact model, and the key `obstacles` on a line of its own.
inline std::string on_a_slope(double angle, double friction, const std::string& contact,
                              const std::string& newton) {
  const drape::Material cotton;
  const double start =
      resting_gap(cotton.area_density() * gravity * std::cos(angle), drape::contact_stiffness(cotton), dhat);
  char text[2000];
  std::snprintf(text, sizeof text, R"(
name: slope
cloth: {shape: square, side: 0.1, columns: 6, rows: 6}
levels: 1
material: {}
start: {translate: [-0.05, -0.05, %.17g]}
energies: [neo_hookean, hinge, {type: gravity, acceleration: [%.17g, 0, %.17g]}]
contact: %s
friction: %g
newton: {%s}
methods: {newton: {}}
)",
                start, gravity * std::sin(angle), -gravity * std::cos(angle), contact.c_str(), friction,
                newton.c_str());
  return text;
}

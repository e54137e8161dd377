#include "core/numerics/formulas/formula_properties.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/patterns/generate.h"

namespace drape {

Eigen::Vector3d green_strains(double s1, double s2, double angle) {
  const double c = std::cos(angle), s = std::sin(angle), e1 = 0.5 * (s1 * s1 - 1), e2 = 0.5 * (s2 * s2 - 1);
  return {c * c * e1 + s * s * e2, s * s * e1 + c * c * e2, c * s * (e1 - e2)};
}

bool is_isotropic(const std::function<double(const Eigen::Vector3d&)>& density) {
  constexpr double stretches[][2] = {{1.02, 1.01}, {1.07, 0.94}, {1.21, 0.63}, {0.97, 0.91}, {1.5, 1.3}};
  constexpr double angles[] = {0.35, 0.8, 1.3, 2.1, 2.9};
  for (const auto& s : stretches) {
    const double along = density(green_strains(s[0], s[1], 0));
    for (const double angle : angles) {
      const double turned = density(green_strains(s[0], s[1], angle));
      const bool equal =
          std::isfinite(along) ? std::abs(turned - along) <= 1e-10 * std::abs(along) : !std::isfinite(turned);
      if (!equal) return false;
    }
  }
  return true;
}

// Of a hinge that is split at midpoints, both halves keep its angles, with half its lengths. The new hinges
// inside a triangle are flat.
std::optional<double> fold_midpoint_factor(
    const std::function<double(double bend, double length, double h1, double h2)>& energy) {
  constexpr double lengths[][3] = {{0.01, 0.013, 0.007}, {0.2, 0.11, 0.14}};
  std::optional<double> factor;
  for (const auto& l : lengths) {
    const double most = std::abs(energy(1, l[0], l[1], l[2]));
    if (!(std::abs(energy(0, l[0] / 2, l[1] / 2, l[2] / 2)) <= 1e-14 * most)) return std::nullopt;
    for (const double bend : {-2.0, -0.3, 0.1, 0.7, 1.9}) {
      const double own = 2 * energy(bend, l[0] / 2, l[1] / 2, l[2] / 2) / energy(bend, l[0], l[1], l[2]);
      if (!factor) factor = std::round(own * 1e9) / 1e9;
      if (!(std::abs(own - *factor) <= 1e-9 * std::abs(own))) return std::nullopt;
    }
  }
  return factor;
}

// What the borders have cancels between four sheets. Bent to both sides, so that forces at rest cancel too.
double fold_plate_stiffness(const std::function<std::unique_ptr<BoundEnergy>(const Level&)>& bind) {
  constexpr double cell = 0.01, radius = 100 * cell;
  constexpr int n = 3;
  const auto excess = [&](int columns, int rows) {
    const Level level =
        Level::of(0, grid({columns * cell, rows * cell}, columns + 1, rows + 1, Diagonals::one_way));
    const auto energy = bind(level);
    const auto rolled = [&](double side) {
      Positions x = level.rest.vertices;
      for (Eigen::Index i = 0; i < x.rows(); ++i) {
        const double angle = x(i, 0) / radius;
        x(i, 0) = radius * std::sin(angle);
        x(i, 2) = side * radius * (1 - std::cos(angle));
      }
      return energy->value(x);
    };
    return rolled(1) + rolled(-1) - 2 * energy->value(level.rest.vertices);
  };
  const double inner = excess(2 * n, 2 * n) - excess(n, 2 * n) - excess(2 * n, n) + excess(n, n);
  const double stiffness = inner / std::pow(n * cell, 2) * (radius * radius);
  return std::isfinite(stiffness) ? std::max(stiffness, 0.0) : 0;
}

std::optional<double> load_midpoint_factor(
    const std::function<Eigen::Vector4d(double area, double mass)>& energy_and_gradient) {
  const Eigen::Vector4d one = energy_and_gradient(1e-4, 0.7e-4), three = energy_and_gradient(3e-4, 2.1e-4);
  if (!((three - 3 * one).norm() <= 1e-12 * three.norm())) return std::nullopt;
  return 1;
}

}  // namespace drape

#include "core/numerics/formulas/formula_properties.h"

#include <algorithm>
#include <cmath>

#include "core/numerics/hierarchy/midpoint.h"
#include "core/numerics/patterns/generate.h"

namespace drape {
namespace {

/// Green strains of a triangle with these principal stretches, at an angle in the material's frame.
Eigen::Vector3d green_strains(double s1, double s2, double angle) {
  const double c = std::cos(angle), s = std::sin(angle), e1 = 0.5 * (s1 * s1 - 1), e2 = 0.5 * (s2 * s2 - 1);
  return {c * c * e1 + s * s * e2, s * s * e1 + c * c * e2, c * s * (e1 - e2)};
}

}  // namespace

bool is_isotropic(const std::vector<MaterialTriangle>& triangles, bool size_or_place,
                  const std::function<double(const Eigen::Vector3d&, const double*)>& energy) {
  constexpr double stretches[][2] = {{1.02, 1.01}, {1.07, 0.94}, {1.21, 0.63}, {0.97, 0.91}, {1.5, 1.3}};
  constexpr double angles[] = {0.35, 0.8, 1.3, 2.1, 2.9};
  const auto isotropic = [&](const MaterialTriangle& triangle) {
    for (const auto& s : stretches) {
      const auto turned_by = [&](double angle) {
        return energy(green_strains(s[0], s[1], angle), triangle.data() + 4);
      };
      const double along = turned_by(0);
      for (const double angle : angles) {
        const double turned = turned_by(angle);
        const bool equal = std::isfinite(along) ? std::abs(turned - along) <= 1e-10 * std::abs(along)
                                                : !std::isfinite(turned);
        if (!equal) return false;
      }
    }
    return true;
  };
  const auto end = size_or_place || triangles.empty() ? triangles.end() : triangles.begin() + 1;
  return std::all_of(triangles.begin(), end, isotropic);
}

std::optional<double> sampled_midpoint_factor(const BindEnergy& bind) {
  std::optional<double> factor;
  for (const double cell : {0.01, 0.3}) {
    TriangleMesh mesh = grid({3 * cell, 2 * cell}, 4, 3, Diagonals::criss_cross);
    const auto noise = [&](double size) {
      Positions x = mesh.vertices;
      for (Eigen::Index i = 0; i < x.size(); ++i)
        x.data()[i] = size * cell * std::sin(static_cast<double>(37 * i + 1));
      return x;
    };
    mesh.vertices.leftCols(2) += noise(0.1).leftCols(2);
    const Level level = Level::of(0, mesh);
    const ProlongationMatrix midpoints = midpoint_weights(level);
    const auto coarse = bind(level), fine = bind(Level::of(1, refined_rest(level, midpoints)));
    for (const double size : {0.001, 0.03, 0.3}) {
      const Positions x = mesh.vertices + noise(size);
      const double own = coarse->value(x), halved = fine->value(midpoints * x);
      if (!std::isfinite(own) && !std::isfinite(halved)) continue;  // outside the energy's domain
      if (own == 0 && halved == 0) continue;
      if (!factor) factor = std::round(halved / own * 1e9) / 1e9;
      if (!(std::abs(halved - *factor * own) <= 1e-9 * std::abs(halved))) return std::nullopt;
    }
  }
  return factor;  // none where no sampled state has energy
}

// What the borders have cancels between four sheets. Bent to both sides, so that forces at rest cancel too.
double fold_plate_stiffness(const BindEnergy& bind) {
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

}  // namespace drape

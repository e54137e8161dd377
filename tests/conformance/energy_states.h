#pragma once

#include <catch2/catch.hpp>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "core/kernel/interfaces/energy.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/conformance.h"
#include "tests/support/evaluate.h"

// Energies, and states to evaluate them in.

namespace energy_states {

using namespace drape;

struct Candidate {
  std::string name;
  std::shared_ptr<Energy> energy;
  /// Whether the rest shape is not one of equilibrium, as its conformance_prestressed….yaml says.
  bool prestressed = false;
  /// Whether it depends on the cloth's shape alone, not on where the cloth is.
  bool internal() const {
    return energy->role() != EnergyRole::external && energy->role() != EnergyRole::position;
  }
  /// Scale on the rest shape for a state with stiffness: strain limits have none at rest.
  double enlarged() const { return energy->role() == EnergyRole::limit ? 1.2 : 1; }
};

/// Every registered energy, with each of the settings that it asks to be tested with.
inline std::vector<Candidate> all_energies() {
  std::vector<Candidate> all;
  for (const RegistryEntry* entry : test_registry().of_kind("energy"))
    for (const auto& [name, parameters] : conformance_parameters(*entry))
      all.push_back({entry->name + " with " + name,
                     make_plugin_from<Energy>(conformance_config(*entry, parameters)),
                     name.find("prestressed") != std::string::npos});
  REQUIRE(all.size() >= 3);
  return all;
}

/// Equally stiff in bending and stretching on meshes with edges of about 0.1 m: tests see both.
inline const Material material = [] {
  Material m;
  m.thickness = 0.01;
  m.membrane_modulus = 1e4;
  m.bending_modulus = 1e7;
  m.poisson_ratio = 0.3;
  return m;
}();

inline Level flat_level() { return Level::of(0, random_triangulation({0.6, 0.5}, 40, 7)); }

inline TriangleMesh curved_mesh() {
  TriangleMesh mesh = random_triangulation({0.6, 0.5}, 40, 8);
  const auto x = mesh.vertices.col(0).array(), y = mesh.vertices.col(1).array();
  mesh.vertices.col(2) = 0.2 * (5 * x).sin() * (4 * y).cos();
  return mesh;
}

/// Null if the energy refuses the level because it is not flat.
inline std::unique_ptr<BoundEnergy> bind(const Candidate& candidate, const Level& level) {
  try {
    return candidate.energy->bind(level, material);
  } catch (const std::runtime_error& error) {
    INFO(candidate.name);
    REQUIRE_FALSE(level.rest.vertices.col(2).isZero(0));
    REQUIRE_THAT(error.what(),
                 Catch::Contains("the rest shape of level " + std::to_string(level.index) + " is not flat"));
    return nullptr;
  }
}

struct State {
  std::string name;
  Positions x;
  double step;  // of finite differences [m], far below the state's smallest length
};

/// Moves the first vertex of the triangle towards the opposite edge's midpoint until `fraction` of the height
/// is left.
inline Positions flattened(const Level& level, Positions x, int triangle, double fraction) {
  const auto v = level.rest.triangles.row(triangle);
  const Eigen::RowVector3d middle = (x.row(v[1]) + x.row(v[2])) / 2;
  x.row(v[0]) = middle + fraction * (x.row(v[0]) - middle);
  return x;
}

inline std::vector<State> states(const Candidate& candidate, const Level& level) {
  const Positions& rest = level.rest.vertices;
  const int n = level.vertex_count();
  Eigen::Matrix3d deform;
  deform << 1.7, 0.4, 0, -0.3, 0.6, 0, 0.2, 0.5, 1;
  Positions strong = rest * deform.transpose() + noise(n, 0.05, 3);
  strong.col(2).array() += 0.15 * (12 * rest.col(0).array()).sin();
  Positions folded = rest + noise(n, 0.01, 4);  // about a crease across the middle, nearly shut
  for (auto vertex : folded.rowwise())
    if (const double beyond = vertex[0] - 0.3; beyond > 0) {
      vertex[0] = 0.3 - 0.99 * beyond;
      vertex[2] += 0.05 + 0.1 * beyond;
    }
  return {{"near rest", candidate.enlarged() * rest + noise(n, 0.002, 1), 1e-5},
          {"random", rest + noise(n, 0.02, 2), 1e-5},
          {"strongly deformed", strong, 1e-5},
          {"folded", folded, 1e-6},
          {"near-degenerate", flattened(level, rest + noise(n, 0.01, 5), 11, 0.02), 1e-6}};
}

/// Runs the body on every energy, on a flat and, unless the energy is for flat ones alone, a curved level.
template <class Body>
void for_each_binding(const Body& body) {
  for (const Candidate& candidate : all_energies())
    for (const Level& level : {flat_level(), Level::of(0, curved_mesh())}) {
      const auto bound = bind(candidate, level);
      if (!bound) continue;
      INFO(candidate.name << " on the " << (level.rest.vertices.col(2).isZero(0) ? "flat" : "curved")
                          << " mesh");
      body(candidate, level, *bound);
    }
}

/// Gradient and Hessian agree with differences with this step, to parts of their norms and what these round.
inline void check_derivatives(const BoundEnergy& energy, const Positions& x, double step,
                              double of_gradient = 1e-7, double of_hessian = 1e-7) {
  const double rounding = 1e-15 / step * std::sqrt(x.size());
  const Eigen::VectorXd g = flat(gradient_of(energy, x));
  REQUIRE(g.norm() > 0);
  CHECK((g - gradient_by_differences(energy, x, step)).norm() <=
        of_gradient * g.norm() + rounding * std::abs(energy.value(x)));
  const Eigen::MatrixXd h = dense(hessian_of(energy, x, Projection::none)),
                        expected = hessian_by_differences(energy, x, step);
  const double tolerance = of_hessian * h.norm() + rounding * g.norm();
  CHECK((h - expected).norm() <= tolerance);
  CHECK((expected - expected.transpose()).norm() <= tolerance);
}

}  // namespace energy_states

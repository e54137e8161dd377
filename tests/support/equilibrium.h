#pragma once

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "core/numerics/solve/newton.h"
#include "tests/support/registry.h"

/// Energies of a model, each by its YAML, which is its name too.
inline std::vector<drape::NamedEnergy> named_energies(const std::vector<std::string>& all) {
  std::vector<drape::NamedEnergy> energies;
  for (const std::string& yaml : all) energies.push_back({yaml, make_plugin_from<drape::Energy>(yaml)});
  return energies;
}

/// The model's equilibrium from a start (n×3) [m], by plain Newton steps of this size [s] down to this force
/// residual; the test ends if there is none.
inline drape::Positions equilibrium_of(const drape::LevelModel& model, drape::Positions start,
                                       double force_tolerance,
                                       double step_size = drape::NewtonParameters().step_size) {
  drape::PlainObjective objective(model);
  drape::NewtonParameters newton;
  newton.step_size = step_size;
  newton.force_tolerance = force_tolerance;
  drape::Observer silent;
  model.set_dirichlet(start);
  const drape::LevelResult result = drape::minimise(objective, start, newton, {drape::Stopwatch(), silent});
  INFO(result.message);
  REQUIRE(has_converged(result.outcome));
  return result.x;
}

#pragma once

#include <catch2/catch.hpp>

#include "core/numerics/solve/newton.h"

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

#include "core/app/run/reference.h"

#include "core/numerics/solve/newton.h"

namespace drape {

LevelResult solve_to_tolerance(const Experiment& experiment, const Scene& scene, const Positions& x,
                               Observer& observer) {
  NewtonParameters newton = experiment.parameters.newton;
  newton.force_tolerance = experiment.parameters.reference.force_tolerance;
  const Stopwatch clock;
  PlainObjective objective(scene.finest_model());
  observer.level_started(scene.hierarchy.level_count() - 1);
  LevelResult result = minimise(objective, x, newton, {clock, observer});
  observer.level_finished(result);
  return result;
}

}  // namespace drape

#pragma once

#include <memory>
#include <vector>

#include "core/app/experiment/load.h"
#include "core/app/scene/scene.h"
#include "core/kernel/threads/deferred.h"

namespace drape {

/// A load of a scene. Immutable.
struct LoadState : Load {
  std::vector<Deferred<Level>> rests;  ///< by level, of membranes that do not rest as the level does; or none
  bool pins_hold = true;
  /// Where pins without a transform hold: positions of the finest level, n×3 [m]; null: where the scene
  /// placed the cloth.
  std::shared_ptr<const Positions> held_at;
};

/// The plain model of a level of the scene under a load, which shares with `before`, a model of the same
/// level under another load, what is equal.
std::shared_ptr<const LevelModel> model_under(const LoadState& load, const Scene& scene, int level,
                                              const LevelModel& before);

/// The positions of a coarser level's vertices, which are among those of a finer level (x, n×3).
Positions own_of(const Hierarchy& hierarchy, const Positions& x, int fine, int coarse);

}  // namespace drape

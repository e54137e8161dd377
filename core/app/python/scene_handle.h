#pragma once

#include <memory>

#include "core/app/experiment/experiment.h"
#include "core/app/python/level_handle.h"

namespace drape::python {

/// A scene with the experiment that it refers to.
struct SceneHandle {
  std::shared_ptr<const Experiment> experiment;
  std::shared_ptr<const Scene> scene;

  /// Throws IndexError for a level that does not exist.
  int checked(int level) const {
    if (level < 0) level += static_cast<int>(scene->models.size());
    if (level < 0 || level >= static_cast<int>(scene->models.size()))
      throw py::index_error("the scene has the levels 0 … " + std::to_string(scene->models.size() - 1));
    return level;
  }
  LevelHandle level(int l) const { return {{scene, &scene->hierarchy.levels[checked(l)]}}; }
  ModelHandle model(int l) const { return {scene->models[checked(l)], scene}; }
};

}  // namespace drape::python

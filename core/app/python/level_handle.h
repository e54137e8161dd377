#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "core/kernel/interfaces/level.h"
#include "core/numerics/model/level_model.h"

namespace drape::python {

namespace py = pybind11;

/// A level that Python may keep for as long as it likes.
struct LevelHandle {
  std::shared_ptr<const Level> level;

  /// A copy, for levels whose owner is not known.
  static LevelHandle copy_of(const Level& level) { return {std::make_shared<const Level>(level)}; }
};

/// A model with what must outlive it: the scene, or for a prototype's solver the solve under way.
struct ModelHandle {
  std::shared_ptr<const LevelModel> shared;
  std::shared_ptr<const void> owner;       ///< of the level; null if it is not known
  std::shared_ptr<const bool> alive = {};  ///< whether the level still exists; null if `owner` sees to that

  /// Throws RuntimeError once the solve that gave the model has ended.
  const LevelModel& model() const {
    if (alive && !*alive)
      throw std::runtime_error("this model belongs to a solve that has ended; copy what you need before");
    return *shared;
  }
  LevelHandle level() const {
    const Level& of_model = model().level();
    return owner ? LevelHandle{{owner, &of_model}} : LevelHandle::copy_of(of_model);
  }
  int vertex_count() const { return model().level().vertex_count(); }
};

}  // namespace drape::python

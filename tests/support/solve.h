#pragma once

#include <catch2/catch.hpp>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/app/setup/build_scene.h"
#include "tests/support/command.h"
#include "tests/support/registry.h"

/// An experiment, its scene, and what one method made of it.
struct Solved {
  drape::Experiment experiment;
  std::unique_ptr<drape::Scene> scene;
  std::vector<drape::LevelResult> levels;

  const drape::Level& level() const { return scene->hierarchy.levels.back(); }
  const drape::LevelModel& model() const { return scene->finest_model(); }
  const drape::Positions& rest() const { return level().rest.vertices; }
  const drape::Positions& x() const { return levels.back().x; }
};

inline drape::Experiment experiment_in(const std::filesystem::path& file,
                                       const drape::Overrides& overrides = {}) {
  drape::ConfigErrors errors;
  auto experiment = drape::read_experiment(file, overrides, test_registry(), errors);
  throw_errors(errors);
  return std::move(*experiment);
}

inline drape::Experiment experiment_from(const std::string& text, const drape::Overrides& overrides = {}) {
  const Scratch folder(text);
  return experiment_in(folder / "e.yaml", overrides);
}

inline std::unique_ptr<drape::Scene> scene_of(const drape::Experiment& experiment) {
  drape::ConfigErrors errors;
  auto scene = drape::build_scene(experiment, errors, drape::LargeMemory::allowed);
  throw_errors(errors);
  return scene;
}

inline Solved scene_from(const std::string& text, const drape::Overrides& overrides = {}) {
  Solved s{experiment_from(text, overrides), nullptr, {}};
  s.scene = scene_of(s.experiment);
  return s;
}

/// Runs one of the experiment's methods, silently; the first one if no name is given.
inline void run_method(Solved& s, const std::string& name = "") {
  for (const auto& [own_name, solver] : s.experiment.methods) {
    if (!name.empty() && own_name != name) continue;
    drape::Observer silent;
    s.levels = solver->solve(*s.scene, silent);
    return;
  }
  throw std::runtime_error("the experiment has no method " + name);
}

/// An experiment, solved by one of its methods as run_method does.
inline Solved solved(drape::Experiment experiment, const std::string& method = "") {
  Solved s{std::move(experiment), nullptr, {}};
  s.scene = scene_of(s.experiment);
  run_method(s, method);
  return s;
}

inline Solved solve_yaml(const std::string& text, const std::string& method = "") {
  Solved s = scene_from(text);
  run_method(s, method);
  return s;
}

/// What has been solved, whose last level must have converged.
inline Solved converged(Solved s) {
  INFO(s.levels.back().message);
  REQUIRE(s.levels.back().outcome == drape::Outcome::converged);
  return s;
}

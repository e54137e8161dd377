#pragma once

#include <algorithm>
#include <iostream>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/app/scene/scene.h"

// What several benchmarks need.

inline double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

/// An experiment and its scene, from a file relative to benchmarks/; prints errors, then throws.
struct Loaded {
  std::optional<drape::Experiment> experiment;
  std::unique_ptr<drape::Scene> scene;
  Loaded(const drape::Registry& registry, const std::string& file, const drape::Overrides& overrides = {}) {
    drape::ConfigErrors errors;
    experiment = read_experiment(DRAPE_BENCHMARKS_DIR "/" + file, overrides, registry, errors);
    scene = experiment ? build_scene(*experiment, errors) : nullptr;
    for (const drape::ConfigError& error : errors) std::cerr << "error: " << error.text() << "\n";
    if (!scene) throw std::runtime_error(file + " cannot be measured");
  }
};

inline const drape::Solver& method(const drape::Experiment& e, const std::string& name) {
  for (const auto& [own, solver] : e.methods)
    if (own == name) return *solver;
  throw std::runtime_error("the benchmark's experiment has no method " + name);
}

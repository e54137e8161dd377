#pragma once

#include <algorithm>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/app/files/machine.h"
#include "core/app/setup/build_scene.h"
#include "core/kernel/plugin/loader.h"
#include "core/kernel/threads/parallel.h"
#include "core/kernel/version.h"

// What several benchmarks need.

inline double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

/// Everything that the plugins of this build offer.
inline const drape::Registry& all_plugins() {
  static const drape::Registry* const registry = [] {
    auto* loaded = new drape::Registry;  // like the libraries, it stays for good
    drape::load_plugins(*loaded, drape::plugin_directories());
    return loaded;
  }();
  return *registry;
}

/// An experiment and its scene, from a file relative to benchmarks/; prints errors, then throws.
struct Loaded {
  std::optional<drape::Experiment> experiment;
  std::unique_ptr<drape::Scene> scene;
  explicit Loaded(const std::string& file, const drape::Overrides& overrides = {}) {
    drape::ConfigErrors errors;
    experiment = read_experiment(DRAPE_BENCHMARKS_DIR "/" + file, overrides, all_plugins(), errors);
    scene = experiment ? build_scene(*experiment, errors, drape::LargeMemory::allowed) : nullptr;
    for (const drape::ConfigError& error : errors) std::cerr << "error: " << error.text() << "\n";
    if (!scene) throw std::runtime_error(file + " cannot be measured");
  }
};

inline const drape::Solver& method(const drape::Experiment& e, const std::string& name) {
  for (const auto& [own, solver] : e.methods)
    if (own == name) return *solver;
  throw std::runtime_error("the benchmark's experiment has no method " + name);
}

/// Stops a method after some iterations of one level and keeps the time of each.
class FirstIterations : public drape::Observer {
 public:
  explicit FirstIterations(int count, int level = 0) : count_(count), level_(level) {}
  void iteration(const drape::IterationRow& row, const drape::Positions&) override {
    if (row.level == level_) times_.push_back(row.seconds);
    contacts = row.contacts.value_or(0);
  }
  bool stop_requested() override { return static_cast<int>(times_.size()) >= count_; }
  int contacts = 0;  ///< at the last iteration
  /// Median time between iterations, the first ones left out.
  double seconds_per_iteration(std::size_t left_out = 4) const {
    std::vector<double> between;
    for (std::size_t i = left_out; i < times_.size(); ++i) between.push_back(times_[i] - times_[i - 1]);
    return median(between);
  }

 private:
  int count_, level_;
  std::vector<double> times_;
};

/// Writes a record: rows, with the build and the machine that they are of.
inline void write_record(const char* file, const char* name, int repeats, const nlohmann::ordered_json& rows,
                         const nlohmann::ordered_json& more = nlohmann::ordered_json::object()) {
  nlohmann::ordered_json record = {
      {"benchmark", name},        {"version", drape::version()},  {"commit", drape::commit()},
      {"cpu", drape::cpu_name()}, {"cores", drape::core_count()}, {"threads", drape::thread_count()},
      {"repeats", repeats}};
  record.update(more);
  record["rows"] = rows;
  std::ofstream(file) << record.dump(1) << "\n";
}

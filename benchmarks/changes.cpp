// What a change of a parameter costs on the level that a designer looks at: the sphere scene's level 0 of 4,
// at equilibrium, and how it gets to the next one. PCS against the direct coarse model, in one run:
//
//     drape_bench_changes [RESULT.json [SIDE]]
//
// SIDE is the number of level 0's vertices along a side (40).

#include <algorithm>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>

#include "benchmarks/measure.h"
#include "core/kernel/threads/stopwatch.h"

using namespace drape;

namespace {

constexpr int repeats = 3;

/// What changes, one after another, and stays so.
struct Change {
  const char* what;
  const char* set;
  double from, to;
};
constexpr Change changes[] = {
    {"bending modulus / 10", "material.bending_modulus", 8e5, 8e4},
    {"bending modulus back", "material.bending_modulus", 8e4, 8e5},
    {"thickness x 1.5", "material.thickness", 3.18e-4, 4.77e-4},
    {"density x 2", "material.density", 472.6, 945.2},
    {"membrane modulus x 4", "material.membrane_modulus", 8e4, 3.2e5},
    {"Poisson ratio 0.243 to 0.4", "material.poisson_ratio", 0.243, 0.4},
};

/// Each parameter jumps when its changes come.
std::string schedule() {
  std::string keys;
  for (const Change& first : changes) {
    if (keys.find(first.set) != std::string::npos) continue;
    std::string at = "0", to = ConfigNode::of(first.from).scalar;
    for (std::size_t k = 0; k < std::size(changes); ++k)
      if (std::string(changes[k].set) == first.set) {
        at += ", " + std::to_string(k + 1);
        to += ", " + ConfigNode::of(changes[k].to).scalar;
      }
    keys += (keys.empty() ? "" : ", ") + ("{parameter: " + std::string(first.set)) +
            ", interpolation: step, times: [" + at + "], values: [" + to + "]}";
  }
  return "{steps: " + std::to_string(std::size(changes)) + ", equilibrate: true, keys: [" + keys + "]}";
}

struct TimedRow : IncrementRow {
  double seconds = 0;
};

/// Keeps what level 0 came to, and ends the method with it.
class LevelZero : public Observer {
 public:
  std::vector<TimedRow> rows;
  void level_started(int) override { watch_ = Stopwatch(); }
  void increment_finished(const IncrementRow& row, const Positions&) override {
    if (row.level == 0) rows.push_back({row, watch_.seconds()});
    watch_ = Stopwatch();
  }
  void level_finished(const LevelResult& result) override {
    ended_ = true;
    if (!has_converged(result.outcome)) std::cerr << "level 0: " << result.message << "\n";
  }
  bool stop_requested() override { return ended_; }

 private:
  bool ended_ = false;
  Stopwatch watch_;  // since the increment before
};

/// Milliseconds of each increment before any step, on level 0 at the scene's start: the new load and its
/// model.
std::vector<double> load_milliseconds(const Scene& scene) {
  LoadStepping& stepping = *scene.load_stepping;
  stepping.begin(0, true);
  std::vector<double> milliseconds;
  for (std::size_t k = 0; k <= std::size(changes); ++k) {
    const Stopwatch watch;
    if (k > 0) stepping.advance(0, scene.starts[0]);
    stepping.model(0);
    milliseconds.push_back(1e3 * watch.seconds());
  }
  return milliseconds;
}

int run(const char* result_file, const std::string& side) {
  const Loaded loaded("../configs/sphere.yaml",
                      {{"schedule", schedule()}, {"cloth.columns", side}, {"cloth.rows", side}});
  const Experiment& e = *loaded.experiment;
  const Scene& scene = *loaded.scene;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  std::printf("%-28s %-9s %8s %12s %10s %14s\n", "change", "method", "steps", "ms a step", "seconds",
              "energy [J]");
  for (std::size_t k = 0; k <= std::size(changes); ++k) rows.push_back({});
  const char* methods[] = {"pcs", "newton"};
  // In turn, several times: the machine's speed drifts. Everything but the seconds is the same each time.
  std::vector<std::vector<TimedRow>> all[repeats];
  for (auto& once : all)
    for (const char* name : methods) {
      LevelZero level;
      method(e, name).solve(scene, level);
      once.push_back(level.rows);
    }
  const std::vector<double> load = load_milliseconds(scene);
  for (std::size_t k = 0; k <= std::size(changes); ++k) {
    const char* what = k == 0 ? "from the start" : changes[k - 1].what;
    rows[k]["change"] = what;
    rows[k]["load_milliseconds"] = load[k];
    std::printf("%-28s %-9s %21.2f ms\n", what, "load", load[k]);
    for (std::size_t m = 0; m < std::size(methods); ++m) {
      if (k >= all[0][m].size()) continue;
      const IncrementRow& r = all[0][m][k];
      std::vector<double> seconds;
      for (const auto& once : all)
        if (k < once[m].size()) seconds.push_back(once[m][k].seconds);
      const auto [lowest, highest] = std::minmax_element(seconds.begin(), seconds.end());
      const double middle = median(seconds), ms = 1e3 * middle / std::max(r.steps, 1);
      std::printf("%-28s %-9s %8d %12.2f %10.3f %14.8f\n", what, methods[m], r.steps, ms, middle, r.energy);
      rows[k][methods[m]] = {
          {"steps", r.steps},          {"iterations", r.iterations},        {"seconds", middle},
          {"seconds_lowest", *lowest}, {"seconds_highest", *highest},       {"milliseconds_a_step", ms},
          {"energy", r.energy},        {"force_residual", r.force_residual}};
    }
  }
  if (result_file)
    write_record(result_file, "changes", repeats, rows,
                 {{"vertices", scene.hierarchy.levels[0].vertex_count()}, {"levels", e.parameters.levels}});
  return 0;
}

}  // namespace

int main(int argc, char** argv) try {
  return run(argc > 1 ? argv[1] : nullptr, argc > 2 ? argv[2] : "40");
} catch (const std::exception& error) {
  std::cerr << "error: " << error.what() << "\n";
  return 2;
}

// Speed of the solver as ratios of times taken in one run, medians of several:
//
//     drape_bench_ratios [RESULT.json]
//
// Without contact and with it: the finest level's whole Newton iterations against its factorisation and
// solve, and the steps of PCS's coarsest level against those of the plain coarse model. Whole progressions
// are other studies, configs/sweeps/sphere.yaml and previews.yaml.

#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>

#include "benchmarks/measure.h"
#include "core/numerics/linear_algebra/block_cholesky.h"
#include "core/numerics/solve/newton.h"

using namespace drape;

namespace {

constexpr int repeats = 7;

template <class Body>
double median_seconds(const Body& body) {
  std::vector<double> seconds;
  body();  // warm-up
  for (int i = 0; i < repeats; ++i) {
    const Stopwatch watch;
    body();
    seconds.push_back(watch.seconds());
  }
  return median(seconds);
}

/// Rows of what is printed and stored: a ratio and its two times.
struct Table {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();

  void add(const std::string& what, double seconds, const std::string& against, double base) {
    const double ratio = seconds / base;
    std::printf("%-46s %9.2f ms   %-28s %9.2f ms   ratio %6.3f\n", what.c_str(), 1e3 * seconds,
                against.c_str(), 1e3 * base, ratio);
    rows.push_back({{"what", what},
                    {"seconds", seconds},
                    {"against", against},
                    {"base_seconds", base},
                    {"ratio", ratio}});
  }
};

/// A wrinkled state of the finest level: what a few iterations of coarse PCS lead to.
Positions wrinkled_state(const Experiment& e, const Scene& scene) {
  FirstIterations some(30);
  const auto results = method(e, "pcs_galerkin_1").solve(scene, some);
  return scene.hierarchy.prolong(results.front().x, 0, static_cast<int>(scene.models.size()) - 1,
                                 scene.hierarchy.prolongations);
}

void finest_level(const Experiment& e, const Scene& scene, Table& table) {
  const LevelModel& model = *scene.models.back();
  const Positions x = wrinkled_state(e, scene);
  std::printf("finest level: %d vertices, %d unknowns, %d threads\n", model.level().vertex_count(),
              3 * model.level().vertex_count(), thread_count());
  Positions g, p;
  BlockMatrix matrix(model.pattern());
  BlockCholesky cholesky;
  const Eigen::VectorXd shift = model.masses() / 0.01;  // h = 0.1 s
  model.hessian(x, Projection::clamp, matrix);
  model.gradient(x, g);
  cholesky.analyse(model.pattern(), model.fixed());
  const double factorise = median_seconds([&] { cholesky.factorise(matrix, shift); });
  const double solve = median_seconds([&] { cholesky.solve(g, p); });
  const double gradient = median_seconds([&] { model.gradient(x, g); });
  const double hessian = median_seconds([&] { model.hessian(x, Projection::clamp, matrix); });
  std::printf("factorisation: %.1f GFlop/s\n", cholesky.flops() / factorise * 1e-9);
  table.add("energy + gradient", gradient, "factorisation", factorise);
  table.add("Hessian, projected and assembled", hessian, "factorisation", factorise);

  NewtonParameters parameters = e.parameters.newton;
  parameters.max_steps = 8;
  Observer silent;
  PlainObjective objective(model);
  const LevelResult r = minimise(objective, x, parameters, {Stopwatch(), silent});
  const auto& phase = r.seconds_by_phase;
  const double n = r.iterations;
  table.add("whole Newton iteration (without the analysis)", (r.seconds - phase.at("analyse")) / n,
            "its factorisation + solve", (phase.at("factorise") + phase.at("solve")) / n);
  std::printf("  by phase, ms an iteration:");
  for (const auto& [name, seconds] : phase) std::printf("  %s %.2f", name.c_str(), 1e3 * seconds / n);
  std::printf("  (separate: solve %.2f)\n", 1e3 * solve);
}

/// `left_out` iterations until the cloth has come to where it is measured.
void coarsest_level(const Experiment& e, const Scene& scene, int left_out, Table& table) {
  const int iterations = left_out + 50;
  // In turn, several times: the machine's speed drifts.
  std::map<std::string, std::vector<double>> seconds;
  for (int i = 0; i < 3; ++i)
    for (const char* name : {"newton", "pcs", "pcs_coarse", "pcs_galerkin_1", "pcs_galerkin_2"}) {
      FirstIterations some(iterations);
      method(e, name).solve(scene, some);
      seconds[name].push_back(some.seconds_per_iteration(left_out));
    }
  for (const char* name : {"pcs", "pcs_coarse", "pcs_galerkin_1", "pcs_galerkin_2"})
    table.add(e.parameters.name + ": level-0 step of " + name, median(seconds[name]), "direct coarse step",
              median(seconds["newton"]));
}

/// Iterations of a level that a cascadic solve has brought the draped cloth to.
void draped_level(const Experiment& e, const Scene& scene, Table& table) {
  const int finest = static_cast<int>(scene.models.size()) - 1;
  FirstIterations some(20, finest);
  const LevelResult r = method(e, "cascadic").solve(scene, some).back();
  auto phase = r.seconds_by_phase;
  const double n = r.iterations, whole = r.seconds - phase["refinement"];
  const std::string size = std::to_string(scene.hierarchy.levels.back().vertex_count()) + " vertices: ";
  std::printf("%s%d contacts\n", size.c_str(), static_cast<int>(some.contacts));
  table.add(size + "Newton iteration with contact", (whole - phase["analyse"]) / n,
            "its factorisation + solve", (phase["factorise"] + phase["solve"]) / n);
  table.add(size + "broad + narrow phase + CCD", (phase["step filter"] + phase["collisions"]) / n,
            "whole iteration", (whole - phase["analyse"]) / n);
  std::printf("  by phase, ms an iteration:");
  for (const auto& [name, seconds] : phase) std::printf("  %s %.2f", name.c_str(), 1e3 * seconds / n);
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) try {
  Table table;
  {
    const Loaded free("contact_free.yaml");
    finest_level(*free.experiment, *free.scene, table);
    coarsest_level(*free.experiment, *free.scene, 10, table);
  }
  for (const char* levels : {"3", "4"}) {
    const Loaded contact("contact.yaml", {{"levels", levels}, {"newton.max_steps", "150"}});
    draped_level(*contact.experiment, *contact.scene, table);
    if (levels == std::string("4")) coarsest_level(*contact.experiment, *contact.scene, 50, table);
  }
  if (argc > 1) write_record(argv[1], "ratios", repeats, table.rows);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "error: " << error.what() << "\n";
  return 2;
}

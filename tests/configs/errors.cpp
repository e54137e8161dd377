// Errors of states: known answers, and what a run writes.

#include "core/app/run/errors.h"

#include "core/app/files/csv.h"
#include "core/app/files/snapshot_file.h"
#include "core/numerics/mesh_files/io.h"
#include "tests/configs/runs.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

struct Loaded : Solved {
  explicit Loaded(const Overrides& overrides = {}) : Solved(scene_from(small_experiment(), overrides)) {}
  static constexpr double released = 2;  ///< from the start to the target [J]
  /// By measure.
  std::map<std::string, std::optional<double>> error(const Positions& x, const Positions& target) const {
    const std::vector<ErrorMeasure> measures = error_measures(declared_metrics(experiment.metrics));
    const StateError values =
        state_error(measures, experiment, *scene, x, energy(x), {target, energy(target), released},
                    [](const std::string& f) { FAIL(f); });
    REQUIRE(values.size() == measures.size());
    std::map<std::string, std::optional<double>> error;
    for (std::size_t k = 0; k < values.size(); ++k) error[measures[k].name] = values[k];
    return error;
  }
  double energy(const Positions& x) const { return scene->finest_model().value(x); }
};

}  // namespace

TEST_CASE("a state has no error against itself; a moved one has the shift over the diagonal") {
  const Loaded small;
  Positions x = small.scene->starts.back();
  x.col(2) = 0.1 * (3 * x.col(0).array()).sin();
  CHECK(small.error(x, x).size() == 5);
  for (const auto& [name, value] : small.error(x, x)) CHECK(value.value() == 0);
  Positions moved = x;
  moved.col(2).array() += 0.01;
  auto error = small.error(moved, x);
  CHECK(error["rms"].value() == Approx(0.01 / std::sqrt(2.0)).epsilon(1e-9));
  CHECK(error["hausdorff"].value() <= 0.01 / std::sqrt(2.0) * (1 + 1e-9));
  CHECK(error["hausdorff"].value() > 0.5 * 0.01 / std::sqrt(2.0));
  CHECK(error["d_H_fit"].value() < 1e-12);
  const double lifted = 472.6 * 3.18e-4 * 9.81 * 0.01;  // weight of a square metre, 1 cm up [J]
  CHECK(error["silhouette_mismatch"].value() > 0.001);
  CHECK(error["silhouette_mismatch"].value() < 0.5);
  CHECK(error["energy_gap"].value() == Approx(lifted / Loaded::released).epsilon(1e-6));
}

TEST_CASE("a run writes snapshots and errors, against its own end and a tighter reference") {
  const Scratch folder(small_experiment());
  run_into("out", folder, "--method all --threads 1 --set reference.force_tolerance=1e-7");
  const nlohmann::json all = results_in(folder / "out");
  CHECK(all["reference"]["status"] == "converged");
  CHECK(all["reference"]["force_residual"].get<double>() <= 1e-7);
  const Csv rows(folder / "out/errors.csv");
  std::size_t row = 0;
  for (const std::string method : {"pcs", "cascadic", "newton"}) {
    double flops = 0, cost = 0, iterations = 0;
    for (const nlohmann::json& level : all["methods"][method]["levels"]) {
      INFO(method << " level " << level["level"]);
      const bool finest = level["level"] == 1;
      const nlohmann::json& snapshots = level["snapshots"];
      const std::size_t count = snapshots["iterations"].size();
      const SnapshotFile states(folder / ("out/" + snapshots["file"].get<std::string>()), count,
                                level["vertices"], snapshots["checksum"].get<std::uint32_t>());
      CHECK(count <= 8);
      const Positions last = read_mesh(folder / ("out/" + level["mesh"].get<std::string>())).vertices;
      CHECK((states.positions(count - 1) - last).norm() < 1e-5);
      CHECK(snapshots["iterations"].back() == level["iterations"]);
      if (method == "newton") flops = cost = iterations = 0;  // every level begins afresh
      cost += level["seconds"].get<double>();
      flops += level["flops"].get<double>();
      iterations += level["iterations"].get<double>();
      double seconds = 0;
      for (std::size_t k = 0; k < count; ++k, ++row) {
        REQUIRE(row < rows.size());
        const auto number = [&](const char* column) { return rows.number(row, column).value(); };
        CHECK(rows.text(row, "method") == method);
        for (const char* key : {"level", "vertices"}) CHECK(number(key) == level[key]);
        CHECK(number("level_iterations") == snapshots["iterations"][k]);
        CHECK(number("seconds") >= seconds);
        seconds = number("seconds");
        CHECK(seconds == Approx(snapshots["seconds"].at(k).get<double>()).epsilon(1e-7));
        for (const char* column :
             {"own_rms", "own_hausdorff", "own_d_H_fit", "own_silhouette_mismatch", "own_energy_gap",
              "reference_rms", "reference_hausdorff", "reference_d_H_fit"})
          CHECK(number(column) >= 0);
        if (k + 1 < count) continue;
        CHECK(number("flops") == Approx(flops));
        CHECK(seconds == Approx(cost));
        CHECK(number("iterations") == iterations);
        for (const char* own : {"own_rms", "own_energy_gap"}) CHECK((number(own) == 0) == finest);
        CHECK(number("reference_rms") > 0);
      }
    }
  }
  CHECK(row == rows.size());
  // The last state of the reference's method is on the way to the reference.
  CHECK(rows.number(row - 1, "reference_rms").value() < 1e-2);

  // Another run takes the reference from this one's folder, and its saved config names a copy in its own.
  run_into("next", folder, "--method all --threads 1 --set 'reference={file: out}'");
  check_same_files(folder / "out", folder / "next", {"reference.ply"});
  const Csv again(folder / "next/errors.csv");
  REQUIRE(again.size() == rows.size());
  for (std::size_t k = 0; k < rows.size(); ++k)
    CHECK(again.text(k, "reference_rms") == rows.text(k, "reference_rms"));
  drape_ends("check next/config.yaml", folder);
}

TEST_CASE("every method's own interpolation prolongs its states") {
  const Overrides changed = {{"levels", "3"},
                             {"methods.smooth", "{type: cascadic, prolongation: refiner}"},
                             {"methods.smooth_pcs", "{type: pcs, interpolation: {state: refiner}}"},
                             {"snapshots", "1"}};
  const Loaded small(changed);
  const Hierarchy& hierarchy = small.scene->hierarchy;
  const Scratch folder(small_experiment());
  std::string options = "--method all --threads 1";
  for (const Override& o : changed) options += " --set '" + o.key + "=" + o.value + "'";
  run_into("out", folder, options);
  const nlohmann::json all = results_in(folder / "out")["methods"];
  const Csv rows(folder / "out/errors.csv");
  const auto value_of = [&](const Positions& x, const Positions& target, const std::string& name) {
    for (const auto& [metric_name, metric] : small.experiment.metrics)
      if (metric->scope() == MetricScope::pair)
        for (const MetricValue& v :
             metric->evaluate({hierarchy.levels[2], *small.scene->models[2], target, &x}).values)
          if (v.name == name) return v.value;
    FAIL(name);
    return 0.0;
  };
  for (const std::string method : {"pcs", "smooth_pcs", "cascadic", "newton", "smooth"}) {
    INFO(method);
    const auto state = [&](int l) {
      return read_mesh(folder / "out/levels" / (method + "_l" + std::to_string(l) + ".ply")).vertices;
    };
    const Positions end = state(2), linear = hierarchy.prolong(state(0), 0, 2, hierarchy.midpoints),
                    refined = hierarchy.prolong(state(0), 0, 2, hierarchy.prolongations),
                    prolonged = method.starts_with("smooth") ? refined : linear;
    REQUIRE((linear - refined).norm() > 1e-3);
    CHECK(all[method]["levels"][0]["energy_on_finest"].get<double>() ==
          Approx(small.scene->models[2]->value(prolonged)).epsilon(1e-9));
    const nlohmann::json& pair = all[method]["consistency"][1];
    REQUIRE((pair["coarse"] == 0 && pair["fine"] == 2));
    for (const char* name :
         {"d_H_fit", "d_K_ddg", "distance_rms", "silhouette_overlap", "energy_above_end"}) {
      INFO(name);
      CHECK(pair[name].get<double>() == Approx(value_of(prolonged, end, name)).epsilon(1e-6));
      CHECK(pair["of_start"][name].get<double>() ==
            Approx(value_of(small.scene->starts[2], end, name)).epsilon(1e-6));
    }
    for (std::size_t k = 0; k < rows.size(); ++k)
      if (rows.text(k, "method") == method && rows.text(k, "level") == "0")
        CHECK(rows.number(k, "own_rms").value() ==
              Approx(value_of(prolonged, end, "distance_rms")).epsilon(1e-5));
  }
}

TEST_CASE("the lowest of the states that have converged may be the reference, whichever method's it is") {
  const Scratch folder(small_experiment());
  const auto run = [&](const std::string& options) {
    const Ended ended = drape_with(
        "run e.yaml -o out --overwrite --method all -q --no-report --measure --set reference=lowest " +
            options,
        folder.path);
    REQUIRE(ended.exit_code <= 1);
    return results_in(folder / "out");
  };
  const nlohmann::json all = run("--set reference.force_tolerance=1e-6");
  std::string lowest;
  double energy = 1e300;
  for (const auto& [name, method] : all["methods"].items())
    if (method["levels"][1]["energy"] < energy) energy = method["levels"][1]["energy"], lowest = name;
  CHECK(all["reference"]["method"] == lowest);
  CHECK(all["reference"]["chosen"] == "lowest");
  CHECK(all["reference"]["force_residual"].get<double>() <= 1e-6);
  for (const auto& [name, method] : all["methods"].items()) {
    CHECK(method["reference"]["against"] == lowest);
    CHECK(method["reference"]["energy_above_end"] > 0);  // of the method's state, above the reference
  }
  // One that has not converged is none, however low it lies, and has errors against the reference alone.
  const nlohmann::json broken = run("--set methods." + lowest + ".newton.max_steps=2");
  REQUIRE(broken["methods"][lowest]["status"] != "converged");
  CHECK(broken["reference"]["method"] != lowest);
  const Csv rows(folder / "out/errors.csv");
  REQUIRE(rows.size() > 0);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    CHECK(rows.number(k, "own_rms").has_value() == (rows.text(k, "method") != lowest));
    CHECK(rows.number(k, "reference_rms").has_value());
  }
  CHECK_FALSE(run("--set newton.max_steps=1").contains("reference"));
}

TEST_CASE("without snapshots there are no errors and no files of them") {
  const Scratch folder(small_experiment());
  run_into("out", folder, "--set snapshots=0");
  CHECK(!fs::exists(folder / "out/snapshots"));
  CHECK(!fs::exists(folder / "out/errors.csv"));
  CHECK(!results_in(folder / "out")["methods"]["pcs"]["levels"][0].contains("snapshots"));
}

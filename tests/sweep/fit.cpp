// `drape fit`: a small Cusick specimen whose fabric is made stiffer by a known factor.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/support/command.h"
#include "tests/support/sweep_runs.h"

using nlohmann::json;

namespace {

const std::string specimen = R"(name: disc
cloth: {shape: disc, radius: 0.15, vertices: 60, grain: 0}
levels: 1
material: {fabric: gray-interlock}
start: {perturbation: 1e-3, perturbation_wavelength: 0.1}
pins: [{region: ball, point: [0, 0, 0], radius: 0.09}]
energies: [woven, midedge_bending, gravity]
newton: {force_tolerance: 1e-3}
methods: {pcs: {}, newton: {}}
metrics: [{type: drape_coefficient, support_radius: 0.09}, stretch]
)";

}  // namespace

TEST_CASE("a fit finds the factor that gave a drape coefficient, and resumes") {
  const Scratch folder(specimen);
  const std::string stiffer =
      "--set material.warp_bending=6.957e-5 --set material.weft_bending=4.281e-5 "
      "--set material.bias_bending=7.425e-5";  // three times
  drape_ends("run e.yaml --no-report --measure -o stiffer " + stiffer, folder);
  const double target =
      json_in(folder / "stiffer/results.json")["methods"]["pcs"]["levels"][0]["drape_coefficient"];

  const std::string fit =
      "fit e.yaml --by material.bending --starts 1 --tolerance 0.1 -o fit --to " + json(target).dump();
  const Ended first = drape_ends(fit, folder);
  CHECK_THAT(first.out, Catch::Contains("--set material.warp_bending="));
  CHECK_THAT(first.err, Catch::StartsWith("factor 1  material.warp_bending 2.319e-05  drape_coefficient "));
  const json result = json_in(folder / "fit/fit.json");
  CHECK(result["reached"] == true);
  CHECK(result["factor"] == Approx(3).epsilon(0.01));
  CHECK(result["median"] == Approx(target).epsilon(1e-3));
  CHECK(result["method"] == "pcs");
  CHECK(result["fitted"].size() == 3);
  CHECK(result["fitted"]["material.weft_bending"] == Approx(4.281e-5).epsilon(0.01));
  CHECK(result["samples"][0]["factor"] == 1);

  // The fitted experiment is the best sample's.
  drape_ends("run fit/fitted.yaml --no-report --measure -o again", folder);
  const json again = json_in(folder / "again/results.json")["methods"]["pcs"]["levels"][0];
  CHECK(again["drape_coefficient"] == result["median"]);

  // The same command runs nothing again.
  const auto count = runs_of(folder / "fit").size();
  CHECK(drape_ends(fit, folder).out == first.out);
  for (const json& run : runs_of(folder / "fit")) CHECK(run["starts"] == 1);
  CHECK(runs_of(folder / "fit").size() == count);
}

TEST_CASE("a fit whose program was replaced while it ran has not refused its input") {
  const Scratch folder(specimen);
  copy_program(folder);
  Command command("exec bin/drape fit e.yaml --by material.bending --to 45 --starts 40 --threads 1 -o fit",
                  folder.path);
  wait_for(command, folder / "fit", "converged", 1);
  replace_program(folder);
  CHECK(command.wait().exit_code == 3);
}

TEST_CASE("a fit reports the median and the range over its starts") {
  const Scratch folder(specimen);
  const std::string shown = drape_ends("fit e.yaml --by material.bending --to 45 -o fit", folder).out;
  const json result = json_in(folder / "fit/fit.json");
  CHECK(result["values"].size() == 3);
  CHECK(result["low"].get<double>() < result["high"].get<double>());
  CHECK(result["median"] == result["values"][1]);
  CHECK(result["median"] == Approx(45).epsilon(0.01));
  CHECK_THAT(shown, Catch::Contains(" in 3 of 3 starts)"));
}

TEST_CASE("a fit that misses its target says what it saw, and keeps the nearest") {
  const Scratch folder(specimen);
  const std::string bending = "fit e.yaml --starts 1 --by material.bending ";
  CHECK_THAT(
      drape_ends(bending + "--to 145 -o high", folder, 1).err,
      Catch::Contains("error: drape_coefficient 145 is out of reach: factors from 1 to 1024 gave 29.2"));
  CHECK(json_in(folder / "high/fit.json")["reached"] == false);
  const std::string bounded =
      "fit e.yaml --starts 1 --by material.poisson_ratio --set material.poisson_ratio=0.3 --to 90 ";
  CHECK_THAT(refused_by(bounded + "-o high", folder.path),
             Catch::Contains("high: has runs of another fit ("));
  CHECK_THAT(drape_ends(bounded + "-o bound", folder, 1).err,
             Catch::Contains("\"poisson_ratio\" must be below 0.5, not 1.2"));
  CHECK_THAT(drape_ends(bending + "--set newton.max_steps=2 --to 45 -o cut", folder, 1).err,
             Catch::Contains("start 1 did not converge; see cut/runs/factor=1/seed_1") &&
                 Catch::Contains("error: no start gave a value"));
}

TEST_CASE("a fit refuses what it cannot do, before it runs anything") {
  const Scratch folder(specimen);
  const auto refuses = [&](const std::string& arguments, const std::string& errors) {
    CHECK_THAT(refused_by("fit e.yaml -o out " + arguments, folder.path), Catch::StartsWith(errors));
    CHECK_FALSE(std::filesystem::exists(folder / "out"));
  };
  refuses("--to 45 --by material.thikness --metric drape_coeficient",
          R"(error: --by: the experiment has no number "material.thikness"; did you mean "material.thickness"?
error: --metric: the experiment's metrics have no "drape_coeficient"; did you mean "drape_coefficient"?)");
  const std::string to_45 = "--to 45 --by material.bending ";
  refuses(
      to_45 + "--metric energy",
      "error: --metric: the experiment's metrics have no \"energy\"; they are drape_coefficient, folds, ");
  refuses(to_45 + "--set start.perturbation=0", "error: --starts: every seed gives the same run where ");
  refuses(to_45 + "--set start.seed=3",
          R"(error: --set start.seed: "start.seed" is what the sweep's seeds set; take one of them out)");
  refuses(to_45 + "--method nweton", "error: --method nweton: the experiment's methods are pcs, newton");
  refuses(to_45 + "--method all", "error: --method: a fit takes one method");
  refuses("--to 0 --by material.bending", "error: --to: must be a number other than 0, not 0");
}

TEST_CASE("a fit that is interrupted keeps its runs and says how to go on") {
  const Scratch folder(specimen);
  DrapeAtWork fit("fit e.yaml --to 45 --by material.bending --set cloth.vertices=20000 --threads 1 -o fit",
                  folder);
  wait_for(fit, folder / "fit", "running", 1);
  fit.send_alone(SIGINT);
  const Ended ended = fit.wait();
  CHECK(ended.exit_code == 130);
  CHECK_THAT(ended.err, Catch::Contains("stopped on request; the same command goes on\n"));
  CHECK(count_of(runs_of(folder / "fit"), "cancelled") >= 1);
}

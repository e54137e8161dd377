// `drape compare`, and what of two runs it compares.

#include "core/app/experiment/experiment.h"
#include "core/app/files/yaml_file.h"
#include "core/app/report/compare.h"
#include "tests/configs/runs.h"

using namespace drape;

namespace {

/// Two copies of a run, `a` and `b`.
struct TwoRuns : Scratch {
  TwoRuns() {
    static const Scratch made(small_experiment());
    if (!fs::exists(made / "out")) run_into("out", made, "--method all --threads 1");
    for (const char* copy : {"a", "b"}) fs::copy(made / "out", path / copy, fs::copy_options::recursive);
  }
  explicit TwoRuns(const std::function<void(Json&)>& edit) : TwoRuns() { change("b", edit); }
  void change(const std::string& copy, const std::function<void(Json&)>& edit) const {
    edit_json(path / copy / "results.json", edit);
  }
  /// Compares them; the output must match.
  void check_compare(const std::string& options, int exit_code, const std::string& output) const {
    CHECK_THAT(drape_ends("compare a b " + options, *this, exit_code).out,
               Catch::Matches("[\\s\\S]*" + output + "[\\s\\S]*"));
  }
};

/// PCS's finest level.
Json& finest(Json& results) { return results["methods"]["pcs"]["levels"][1]; }

/// Adds to a number of PCS's finest level.
std::function<void(Json&)> adding(const std::string& key, double more) {
  return [=](Json& all) { finest(all)[key] = finest(all)[key].get<double>() + more; };
}

}  // namespace

TEST_CASE("compare finds nothing between a run and itself") {
  for (const std::string bounds : {"", " --bound seconds=1 --bound d_H_fit=1 --bound energy_released=1"}) {
    const std::string said = shown_by("compare a a" + bounds, TwoRuns().path);
    CHECK_THAT(said, Contains(" the same. Times within 10 % or 0.05 s of each other"));
    CHECK((said.find("All bounds hold.\n") == std::string::npos) == bounds.empty());
  }
}

TEST_CASE("what a run of one level has is compared, and its newton is the experiment's or its method's own") {
  const Scratch folder(small_experiment());
  const std::string options = "--levels 1 --method newton --set newton.step_size=0.2 ";
  run_into("a", folder, options);
  run_into("b", folder, options + "--set 'methods.newton.newton={step_size: 0.3, force_tolerance: 5e-2}'");
  const auto own = [&](const char* name, const char* key) {
    return newton_number(read_run(folder / name).config, "newton", key);
  };
  CHECK(own("a", "step_size") == 0.2);
  CHECK(own("b", "step_size") == 0.3);
  CHECK(own("a", "force_tolerance") == 1e-2);
  CHECK(own("b", "force_tolerance") == 5e-2);
  drape_ends("compare a b --bound largest_stretch=2", folder);
}

TEST_CASE("compare lists changes; a larger one breaks a bound, as does a method that no longer converges") {
  struct Case {
    std::function<void(Json&)> edit;
    std::string options;
    int exit_code;
    std::string output;
  };
  const auto slower = adding("seconds", 10), less = adding("energy_released", -0.1);
  const auto better = [](Json& all) {
    for (Json& pair : all["methods"]["pcs"]["consistency"])
      pair["d_H_fit"] = pair["d_H_fit"].get<double>() / 2;
  };
  const auto stalled = [](Json& all) { all["methods"]["pcs"]["status"] = "stalled"; };
  const auto longer = [](Json& all) { finest(all)["iterations"] = 1000; };
  const auto gone = [](Json& all) { all["methods"].erase("pcs"); };
  const Case cases[] = {
      {slower, "", 0, "pcs, level 1 +seconds .* slower\n"},
      {slower, "--bound seconds=1.5", 1,
       "pcs, level 1 +seconds .* slower .bound broken.\n[^?]*broken: pcs, level 1: seconds went from "},
      {better, "", 0, "pcs, levels 0 → 1 +d_H_fit .* ×0.500 +better\n"},
      {better, "--bound d_H_fit=1 --bound energy_released=1", 0, ""},
      {longer, "", 0, "pcs, level 1 +iterations .* more work\n"},
      {less, "--bound energy_released=1.05", 1, ""},
      {less, "--bound energy_released=2", 0, ""},
      {stalled, "", 0, "\npcs: converged before and does not now\n"},
      {stalled, "--bound seconds=2", 1, "broken: pcs: converged before and does not now; no bound holds\n"},
      {gone, "", 0, "only in the first: pcs\n"},
      {gone, "--bound seconds=2", 1, ""}};
  for (const Case& c : cases) {
    INFO(c.options << ": " << c.output);
    TwoRuns(c.edit).check_compare(c.options, c.exit_code, c.output);
  }
}

TEST_CASE("bounds on negative energies and on counts that were zero") {
  const TwoRuns run;
  for (const bool b : {false, true})
    run.change(b ? "b" : "a", [=](Json& all) {
      finest(all)["energy_released"] = b ? -1.03 : -1;
      finest(all)["intersections"] = int(b);
    });
  run.check_compare("--bound energy_released=1.02", 1, "");
  run.check_compare("--bound energy_released=1.05", 0, "");
  run.check_compare("--bound intersections=100", 1, "");
}

TEST_CASE("compare gives energies no verdict where the models differ, and names the keys") {
  const TwoRuns run(adding("energy_released", 0.1));
  const auto check_with_other = [&](const std::string& key, const std::string& output) {
    const std::string config = text_of(run / "b/config.yaml");
    std::string changed = config;
    changed.insert(changed.find(key + ": ") + key.size() + 2, "1");
    run.write("b/config.yaml", changed);
    run.check_compare("", 0, output);
    run.write("b/config.yaml", config);
  };
  check_with_other("max_steps", "pcs, level 1 +energy_released .* better\n");
  check_with_other(
      "bending_modulus",
      "pcs, level 1 +energy_released .* other\n[\\s\\S]*Energies have no verdict, as their models "
      "differ: in material.bending_modulus.\n");
  // They compare among starts at one place, whatever their noise.
  const auto model = [](const std::string& start) {
    ConfigErrors errors;
    return parse_yaml("start: {translate: " + start + "}", "e.yaml", errors);
  };
  const ConfigNode low = model("[0, 0, 1]"), noisy = model("[0, 0, 1], perturbation: 1e-3, seed: 2");
  CHECK(model_of(low) == model_of(noisy));
  CHECK(differing_model_keys(low, model("[0, 0, 2]")) == std::vector<std::string>{"start.translate"});
}

TEST_CASE("compare refuses meaningless bounds") {
  const std::string above = ": the ratio must be a number above 0, as in --bound seconds=1.1\n";
  check_refusals(
      TwoRuns(), "compare a ",
      {{"a --bound seconds", "--bound seconds: write it as KEY=RATIO, as in --bound seconds=1.1\n"},
       {"a --bound second=1", "--bound second=1: there is no quantity \"second\"; did you mean "},
       {"a --bound seconds=fast", "--bound seconds=fast" + above},
       {"a --bound seconds=-1", "--bound seconds=-1" + above},
       {"a --bound smallest_gap=2", "--bound smallest_gap: no match has this quantity on both sides\n"},
       {"nowhere", "nowhere: neither results.json nor sweep.json here; "}});
}

// Several runs together: the page about a sweep, and compare.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/app/experiment/experiment.h"
#include "core/app/files/yaml_file.h"
#include "core/app/report/compare.h"
#include "core/app/report/run_table.h"
#include "core/kernel/files/string_utils.h"
#include "tests/support/command.h"
#include "tests/support/page_data.h"

using namespace drape;
namespace fs = std::filesystem;
using Catch::Contains;

namespace {

/// A sweep's folder as one would be: two variations with three seeds each, and a run that failed. Made once;
/// cases that change something work on copies.
const fs::path& sweep() {
  static const Scratch folder;
  static const fs::path path = [] {
    folder.write("e.yaml", small_experiment());
    Json runs = Json::array();
    for (const std::string matrix : {"galerkin", "coarse"})
      for (int seed = 1; seed <= 3; ++seed) {
        const std::string run = "runs/matrix=" + matrix + "/seed_" + std::to_string(seed);
        drape_ends("run e.yaml --out sweep/" + run + " --method all --threads 1 --quiet --no-report" +
                       " --set methods.pcs.hessian=" + matrix + " --set start.seed=" + std::to_string(seed),
                   folder);
        runs.push_back(
            {{"name", "matrix=" + matrix}, {"seed", seed}, {"folder", run}, {"status", "converged"}});
      }
    runs.push_back({{"name", "matrix=wrong"},
                    {"seed", 1},
                    {"folder", "runs/wrong"},
                    {"status", "failed"},
                    {"error", "error: a < b\nand more"}});
    folder.write("sweep/sweep.json", Json{{"sweep", "matrices"}, {"complete", true}, {"runs", runs}}.dump());
    return folder / "sweep";
  }();
  return path;
}

/// The variations of runs, in order of appearance.
std::vector<std::string> variations_of(const std::vector<fs::path>& folders) {
  std::vector<std::string> names;
  for (const RunRecord& run : read_runs(folders).runs)
    if (std::find(names.begin(), names.end(), run.variation) == names.end()) names.push_back(run.variation);
  return names;
}

std::string sweep_refusal(const std::string& arguments) { return refused_by(arguments, sweep()); }

/// A copy of a run whose results are edited.
struct Edited {
  Scratch folder;
  template <class Edit>
  explicit Edited(Edit edit) {
    fs::copy(sweep() / "runs/matrix=galerkin/seed_1", folder / "a", fs::copy_options::recursive);
    fs::copy(folder / "a", folder / "b", fs::copy_options::recursive);
    Json results = Json::parse(text_of(folder / "b/results.json"));
    edit(results);
    folder.write("b/results.json", results.dump());
  }
  Ended compare(const std::string& options = "") const {
    return drape_with("compare a b" + options, folder.path);
  }
};

}  // namespace

TEST_CASE("a sweep is read run by run") {
  const RunCollection collection = read_runs({sweep()});
  CHECK(collection.name == "matrices");
  CHECK(collection.runs.size() == 7);
  CHECK((variations_of({sweep()}) ==
         std::vector<std::string>{"matrix=galerkin", "matrix=coarse", "matrix=wrong"}));
}

TEST_CASE("a final state is not compared with itself where it was the reference") {
  int rows = 0;
  for (const TableRow& row : table_of(read_runs({sweep()})).rows) {
    if (row["method"] == "") continue;
    ++rows;
    for (const char* name : {"error_rms", "energy_gap"}) {
      INFO(row.dump() << " " << name);
      CHECK(row[name].is_null() == (row["method"] == "newton"));
    }
  }
  CHECK(rows == 18);
}

TEST_CASE("a direct method's cost is that of the level it ends with") {
  const RunCollection collection = read_runs({sweep() / "runs/matrix=galerkin/seed_1"});
  for (const MethodRecord& m : collection.runs[0].data->methods) {
    const double coarse = m.levels[0].values.of("flops").value(),
                 fine = m.levels[1].values.of("flops").value();
    CHECK(m.cost("flops").value() == (m.name == "newton" ? fine : coarse + fine));
  }
}

TEST_CASE("the table counts steps of the levels that the last state builds on") {
  const Scratch folder;
  fs::copy(sweep() / "runs/matrix=galerkin/seed_1", folder / "a", fs::copy_options::recursive);
  std::istringstream lines(text_of(folder / "a/iterations.csv"));
  std::string text, line;
  for (bool first = true; std::getline(lines, line); first = false) {
    std::vector<std::string> cells = split(line, ',');
    if (!first) cells.at(8) = "0.5";
    REQUIRE((!first || cells.at(8) == "step_length"));
    for (const std::string& cell : cells) text += cell + (&cell == &cells.back() ? "\n" : ",");
  }
  folder.write("a/iterations.csv", text);
  const RunCollection collection = read_runs({folder / "a"});
  const RunData& run = *collection.runs[0].data;
  const RunTable table = table_of(collection);
  for (std::size_t k = 0; k < run.methods.size(); ++k) {
    const MethodRecord& method = run.methods[k];
    const bool direct = method.name == "newton";
    INFO(method.name);
    const double coarse = method.levels[0].values.of("steps").value(),
                 fine = method.levels[1].values.of("steps").value();
    CHECK(table.rows[k]["steps"] == (direct ? fine : coarse + fine));
    CHECK(table.rows[k]["shortened_steps"] == table.rows[k]["iterations"]);
  }
}

TEST_CASE("report of a sweep is one page with every row, state and failure") {
  CHECK(shown_by("report sweep", sweep().parent_path()) == "report: sweep/report.html\n");
  const Json data = page_data(text_of(sweep() / "report.html"));
  CHECK(data["kind"] == "runs");
  CHECK(data["table"]["rows"].size() == 19);
  REQUIRE(data["runs"].size() == 7);
  int rows = 0;
  for (const Json& run : data["runs"]) rows += run["count"].get<int>();
  CHECK(rows == 19);
  CHECK(data["runs"][0]["pictures"].size() == 3);
  CHECK(data["runs"][0]["physics"] == data["runs"][3]["physics"]);  // they differ in a solver's setting
  CHECK(data["runs"][0]["physics"] == data["runs"][1]["physics"]);  // they differ in the noise at the start
  CHECK(data["model_keys"] == Json(model_keys()));
  CHECK(data["runs"][0]["reference"] == "newton");
  CHECK(data["runs"][0]["errors"]["rows"].size() > 6);
  CHECK(data["runs"][0]["first_levels"]["newton"] == 1);
  CHECK(data["runs"][6]["error"] == "error: a < b\nand more");
  CHECK(data["runs"][6]["pictures"].empty());
  CHECK(data["runs"][4]["report"] == nullptr);
  // A run's own page is linked to where it is.
  shown_by("report 'runs/matrix=coarse/seed_2' --width 90", sweep());
  shown_by("report .", sweep());
  CHECK(page_data(text_of(sweep() / "report.html"))["runs"][4]["report"] ==
        "runs/matrix=coarse/seed_2/report.html");
  const Scratch above;
  fs::create_symlink(sweep(), above / "sweep");
  fs::create_directory(above / "below");
  shown_by("report ../sweep --out ../page.html", above / "below");
  CHECK(page_data(text_of(above / "page.html"))["runs"][4]["report"] ==
        "sweep/runs/matrix=coarse/seed_2/report.html");
}

TEST_CASE("report of several folders takes a page's name, and groups runs by all but their seed") {
  CHECK(sweep_refusal("report runs/matrix=galerkin/seed_1 runs/matrix=galerkin/seed_2") ==
        "error: several folders: name the page with --out, as in --out results/together.html\n");
  CHECK(sweep_refusal("report runs/matrix=galerkin/seed_1 runs --out x.html") ==
        "error: runs: neither results.json nor sweep.json here; give the folder of a run or a sweep\n");
  CHECK(sweep_refusal("report runs/matrix=galerkin/seed_1 --out x.html") ==
        "error: --out is for the page of several runs; a run's own is report.html in its folder\n");
  CHECK(!fs::exists(sweep() / "x.html"));
  const Scratch folder;
  shown_by("report runs/matrix=galerkin/seed_1 runs/matrix=galerkin/seed_2 --out " +
               (folder / "two.html").string(),
           sweep());
  CHECK(page_data(text_of(folder / "two.html"))["runs"].size() == 2);
  const std::vector<fs::path> three = {sweep() / "runs/matrix=galerkin/seed_1",
                                       sweep() / "runs/matrix=coarse/seed_1",
                                       sweep() / "runs/matrix=coarse/seed_3"};
  CHECK((variations_of(three) == std::vector<std::string>{three[0].string(), three[1].string()}));
  CHECK(read_runs(three).runs[2].seed.value() == 3);
}

TEST_CASE("variations of one name are kept apart if they are of different sweeps") {
  const Scratch folder;
  const auto write = [&](const std::string& where, const std::string& name,
                         const std::vector<std::string>& variations) {
    Json runs = Json::array();
    for (const std::string& variation : variations)
      for (int seed = 1; seed <= 2; ++seed)
        runs.push_back({{"name", variation}, {"seed", seed}, {"folder", "r"}, {"status", "pending"}});
    fs::create_directory(folder / where);
    folder.write(where + "/sweep.json", Json{{"sweep", name}, {"complete", true}, {"runs", runs}}.dump());
  };
  write("a", "balls", {"base", "soft"});
  write("b", "cubes", {"base", "stiff"});
  write("c", "cubes", {"base"});
  const auto variations = [&](const std::vector<std::string>& sweeps) {
    std::vector<fs::path> folders;
    for (const std::string& name : sweeps) folders.push_back(folder / name);
    return variations_of(folders);
  };
  using Names = std::vector<std::string>;
  CHECK(variations({"a"}) == Names{"base", "soft"});
  CHECK(variations({"a", "b"}) == Names{"balls: base", "balls: soft", "cubes: base", "cubes: stiff"});
  CHECK(variations({"b", "c"}) == Names{(folder / "b").string() + ": base",
                                        (folder / "b").string() + ": stiff",
                                        (folder / "c").string() + ": base"});
  const RunTable table = table_of(read_runs({folder / "a", folder / "b"}));  // has the sweeps in a column
  REQUIRE(table.rows.size() == 8);
  CHECK(table.rows[0]["run"] == "base");
  CHECK(table.rows[0]["seed"] == 1);
}

TEST_CASE("an experiment and the folder of another one may have the same name") {
  const Scratch folder;
  for (const auto& [from, to] : {std::pair("galerkin", "soft"), {"coarse", "stiff"}, {"coarse", "other"}})
    fs::copy(sweep() / ("runs/matrix=" + std::string(from) + "/seed_1"), folder / to,
             fs::copy_options::recursive);
  Json results = Json::parse(text_of(folder / "other/results.json"));
  results["experiment"] = "soft";
  folder.write("other/results.json", results.dump());
  folder.write("other/config.yaml",
               replaced(text_of(folder / "other/config.yaml"), "name: small", "name: soft"));
  CHECK((variations_of({folder / "soft", folder / "stiff", folder / "other"}) ==
         std::vector<std::string>{(folder / "soft").string(), (folder / "stiff").string(), "soft"}));
}

TEST_CASE("report replaces drape's own pages and no other file") {
  const Scratch folder;
  const auto written = [&](const std::string& runs, const std::string& page) {
    return drape_with("report " + runs + " --out " + (folder / page).string(), sweep());
  };
  const std::string two = "runs/matrix=galerkin/seed_1 runs/matrix=galerkin/seed_2";
  folder.write("notes.html", "<title>mine</title>");
  for (const std::string& runs : {two, std::string(".")}) {
    const Ended refused = written(runs, "notes.html");
    CHECK(refused.exit_code == 2);
    CHECK(refused.err == "error: " + (folder / "notes.html").string() +
                             ": is there already, and no report of drape; name another page with --out\n");
    CHECK(text_of(folder / "notes.html") == "<title>mine</title>");
  }
  for (const std::string own : {"runs/matrix=galerkin/seed_2", "./runs/matrix=galerkin/seed_1"})
    CHECK(sweep_refusal("report " + two + " --out " + own + "/report.html") ==
          "error: " + own +
              "/report.html: is the place of a run's own report; name another page with --out\n");
  CHECK(written(two, "page.html").exit_code == 0);
  CHECK(written(".", "page.html").exit_code == 0);  // its own page is replaced
  CHECK(page_data(text_of(folder / "page.html"))["runs"].size() == 7);
}

TEST_CASE("an incomplete sweep is read as far as it got") {
  const Scratch folder;
  folder.write(
      "sweep.json",
      R"({"sweep": "s", "complete": false, "runs": [{"name": "a", "seed": 1, "folder": "r", "status": "running"}]})");
  drape_ends("report .", folder);
  const Json data = page_data(text_of(folder / "report.html"));
  CHECK(data["complete"] == false);
  CHECK(data["runs"][0]["status"] == "running");
  folder.write("sweep.json", "{\"sweep\": ");
  CHECK(refused_by("report .", folder.path) ==
        "error: ./sweep.json: not a sweep's list of runs; is it cut short?\n");
}

TEST_CASE("a page of several runs says that one of them is not complete") {
  const Edited cut([](Json& all) { all["complete"] = false; });
  shown_by("report a b --out two.html", cut.folder.path);
  CHECK(page_data(text_of(cut.folder / "two.html"))["complete"] == false);
}

TEST_CASE("a sweep without a name is read, with runs that have no results") {
  const Scratch folder;
  folder.write("sweep.json", R"({"runs": [{"name": "a", "seed": 1, "folder": "r", "status": "pending"}]})");
  const RunCollection collection = read_runs({folder.path});
  CHECK(collection.name == "");
  REQUIRE(collection.runs.size() == 1);
  CHECK_FALSE(collection.runs[0].data);
}

TEST_CASE("compare finds nothing between a run and itself") {
  for (const char* bounds : {"", " --bound seconds=1 --bound d_H_fit=1 --bound energy_released=1"}) {
    const Ended ended = drape_with("compare . ." + std::string(bounds), sweep());
    CHECK(ended.exit_code == 0);
    CHECK_THAT(ended.out, Contains(" the same. Times within 10 % or 0.05 s of each other"));
    CHECK((ended.out.find("All bounds hold.\n") == std::string::npos) == std::string(bounds).empty());
  }
}

TEST_CASE("what a run of one level has is compared, and its newton is the experiment's or its method's own") {
  const Scratch folder(small_experiment());
  const std::string run =
      "run e.yaml --levels 1 --method newton --quiet --no-report --set newton.step_size=0.2 ";
  drape_ends(run + "--out a", folder);
  drape_ends(run + "--out b --set 'methods.newton.newton={step_size: 0.3, force_tolerance: 5e-2}'", folder);
  const auto own = [&](const char* name, const char* key) {
    return newton_number(read_run(folder / name).config, "newton", key);
  };
  CHECK(own("a", "step_size") == 0.2);
  CHECK(own("b", "step_size") == 0.3);
  CHECK(own("a", "force_tolerance") == 1e-2);
  CHECK(own("b", "force_tolerance") == 5e-2);
  drape_ends("compare a b --bound largest_stretch=2", folder);
}

TEST_CASE("compare lists changes, and exits with 1 if a bound is broken") {
  const Edited run([](Json& all) {
    Json& pcs = all["methods"]["pcs"];
    pcs["levels"][1]["seconds"] = pcs["levels"][1]["seconds"].get<double>() + 10;
    for (Json& pair : pcs["consistency"]) pair["d_H_fit"] = pair["d_H_fit"].get<double>() / 2;
    all["methods"]["cascadic"]["levels"][1]["iterations"] = 1000;
  });
  const Ended plain = run.compare();
  CHECK(plain.exit_code == 0);
  for (const char* line :
       {"pcs, level 1 +seconds .* slower\n", "pcs, levels 0 → 1 +d_H_fit .* ×0.500 +better\n",
        "cascadic, level 1 +iterations .* more work\n"})
    CHECK_THAT(plain.out, Catch::Matches("[\\s\\S]*" + std::string(line) + "[\\s\\S]*"));
  CHECK(run.compare(" --bound d_H_fit=1 --bound energy_released=1").exit_code == 0);
  const Ended broken = run.compare(" --bound seconds=1.5");
  CHECK(broken.exit_code == 1);
  CHECK_THAT(broken.out,
             Contains("broken: pcs, level 1: seconds went from ") && Contains("slower (bound broken)"));
}

TEST_CASE("compare gives energies no verdict where the models differ, and names the keys") {
  const Edited run([](Json& all) {
    Json& level = all["methods"]["pcs"]["levels"][1];
    level["energy_released"] = level["energy_released"].get<double>() + 0.1;
  });
  const auto matches = [](const std::string& line) {
    return Catch::Matches("[\\s\\S]*" + line + "[\\s\\S]*");
  };
  const std::string config = text_of(run.folder / "b/config.yaml");
  const Ended same = run.compare();
  CHECK_THAT(same.out, matches("pcs, level 1 +energy_released .* better\n") && !Contains("models differ"));
  const auto with_other = [&](const std::string& key) {
    std::string changed = config;
    changed.insert(changed.find(key + ": ") + key.size() + 2, "1");
    run.folder.write("b/config.yaml", changed);
    return run.compare();
  };
  CHECK(with_other("max_steps").out == same.out);
  const Ended other = with_other("bending_modulus");
  CHECK_THAT(
      other.out,
      matches("pcs, level 1 +energy_released .* other\n") &&
          Contains("Energies have no verdict, as their models differ: in material.bending_modulus.\n"));
}

TEST_CASE("energies compare among starts at one place, whatever their noise") {
  const auto model = [](const std::string& start) {
    ConfigErrors errors;
    return parse_yaml("start: {translate: " + start + "}", "e.yaml", errors);
  };
  const ConfigNode low = model("[0, 0, 1]"), noisy = model("[0, 0, 1], perturbation: 1e-3, seed: 2");
  CHECK(model_of(low) == model_of(noisy));
  CHECK((differing_model_keys(low, model("[0, 0, 2]")) == std::vector<std::string>{"start.translate"}));
}

TEST_CASE("a bound is broken if a method no longer converges or exists") {
  const Edited stalled([](Json& all) { all["methods"]["pcs"]["status"] = "stalled"; });
  CHECK(stalled.compare().exit_code == 0);
  CHECK_THAT(stalled.compare().out, Contains("\npcs: converged before and does not now\n"));
  const Ended ended = stalled.compare(" --bound seconds=2");
  CHECK(ended.exit_code == 1);
  CHECK_THAT(ended.out, Contains("broken: pcs: converged before and does not now; no bound holds\n"));
  const Edited gone([](Json& all) { all["methods"].erase("pcs"); });
  CHECK_THAT(gone.compare().out, Contains("only in the first: pcs\n"));
  CHECK(gone.compare(" --bound seconds=2").exit_code == 1);
}

TEST_CASE("bounds on negative energies and on counts that were zero") {
  const Edited run([](Json& all) {
    Json& level = all["methods"]["pcs"]["levels"][1];
    level["energy_released"] = level["energy_released"].get<double>() - 0.1;
  });
  CHECK(run.compare(" --bound energy_released=1.05").exit_code == 1);
  CHECK(run.compare(" --bound energy_released=2").exit_code == 0);
  const auto write = [&](const std::string& side, double released, int intersections) {
    Json all = Json::parse(text_of(run.folder / side / "results.json"));
    Json& level = all["methods"]["pcs"]["levels"][1];
    level["energy_released"] = released, level["intersections"] = intersections;
    run.folder.write(side + "/results.json", all.dump());
  };
  write("a", -1, 0), write("b", -1.03, 1);
  CHECK(run.compare(" --bound energy_released=1.02").exit_code == 1);
  CHECK(run.compare(" --bound energy_released=1.05").exit_code == 0);
  CHECK(run.compare(" --bound intersections=100").exit_code == 1);
}

TEST_CASE("a folder stands for the runs in it") {
  std::string runs;
  for (const std::string seed : {"1", "2", "3"}) runs += " runs/matrix=galerkin/seed_" + seed;
  CHECK(shown_by("table runs/matrix=galerkin", sweep()) == shown_by("table" + runs, sweep()));
  CHECK(shown_by("report runs/matrix=galerkin", sweep()) == "report: runs/matrix=galerkin/report.html\n");
}

TEST_CASE("compare refuses meaningless bounds") {
  CHECK(sweep_refusal("compare . . --bound seconds") ==
        "error: --bound seconds: write it as KEY=RATIO, as in --bound seconds=1.1\n");
  CHECK(sweep_refusal("compare . . --bound second=1") ==
        "error: --bound second=1: there is no quantity \"second\"; did you mean \"seconds\"?\n");
  CHECK(sweep_refusal("compare . . --bound seconds=fast") ==
        "error: --bound seconds=fast: the ratio must be a number above 0, as in --bound seconds=1.1\n");
  CHECK(sweep_refusal("compare . . --bound seconds=-1") ==
        "error: --bound seconds=-1: the ratio must be a number above 0, as in --bound seconds=1.1\n");
  CHECK(sweep_refusal("compare . . --bound smallest_gap=2") ==
        "error: --bound smallest_gap: no match has this quantity on both sides\n");
  CHECK(sweep_refusal("compare . nowhere") ==
        "error: nowhere: neither results.json nor sweep.json here; give the folder of a run or a sweep\n");
}

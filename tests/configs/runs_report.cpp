// Several runs together: the page about a sweep, and compare.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/app/report/compare.h"
#include "core/app/report/run_rows.h"
#include "core/app/report/run_table.h"
#include "tests/support/command.h"

using namespace drape;
namespace fs = std::filesystem;
using Catch::Matchers::Contains;
using OrderedJson = nlohmann::ordered_json;

namespace {

/// A sweep's folder as one would be: two variations with three seeds each, and a run that failed. Made once;
/// cases that change something work on copies.
const fs::path& sweep() {
  static const Scratch folder;
  static const fs::path path = [] {
    folder.write("e.yaml", small_experiment());
    OrderedJson runs = OrderedJson::array();
    for (const std::string matrix : {"galerkin", "coarse"})
      for (int seed = 1; seed <= 3; ++seed) {
        const std::string run = "runs/matrix=" + matrix + "/seed_" + std::to_string(seed);
        const Ended ended = drape_with(
            "run e.yaml --out sweep/" + run + " --method all --threads 1 --quiet --no-report" +
                " --set methods.pcs.hessian=" + matrix + " --set start.seed=" + std::to_string(seed),
            folder.path);
        INFO(ended.err);
        REQUIRE(ended.exit_code == 0);
        runs.push_back(
            {{"name", "matrix=" + matrix}, {"seed", seed}, {"folder", run}, {"status", "converged"}});
      }
    runs.push_back({{"name", "matrix=wrong"},
                    {"seed", 1},
                    {"folder", "runs/wrong"},
                    {"status", "failed"},
                    {"error", "error: a < b\nand more"}});
    folder.write("sweep/sweep.json",
                 OrderedJson{{"sweep", "matrices"}, {"complete", true}, {"runs", runs}}.dump());
    return folder / "sweep";
  }();
  return path;
}

/// The JSON that the page's script reads.
OrderedJson data_of(const std::string& page) {
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const std::size_t begin = page.find(open) + open.size();
  return OrderedJson::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

std::string sweep_refusal(const std::string& arguments) { return refused_by(arguments, sweep()); }

/// A copy of a run whose results are edited.
struct Edited {
  Scratch folder;
  template <class Edit>
  explicit Edited(Edit edit) {
    fs::copy(sweep() / "runs/matrix=galerkin/seed_1", folder / "a", fs::copy_options::recursive);
    fs::copy(folder / "a", folder / "b", fs::copy_options::recursive);
    OrderedJson results = OrderedJson::parse(text_of(folder / "b/results.json"));
    edit(results);
    folder.write("b/results.json", results.dump());
  }
  Ended compare(const std::string& options = "") const {
    return drape_with("compare a b" + options, folder.path);
  }
};

}  // namespace

TEST_CASE("a sweep's rows hold the medians over its seeds") {
  const RunCollection collection = read_runs({sweep()});
  CHECK(collection.name == "matrices");
  CHECK((collection.variations() ==
         std::vector<std::string>{"matrix=galerkin", "matrix=coarse", "matrix=wrong"}));
  const std::vector<RunRow> rows = rows_of(collection);
  REQUIRE(rows.size() == 6);
  CHECK(rows[0].title(true) == "matrix=galerkin, pcs");
  CHECK(rows[0].converged == 3);
  std::vector<double> iterations;
  for (int seed = 1; seed <= 3; ++seed) {
    const OrderedJson all = OrderedJson::parse(
        text_of(sweep() / ("runs/matrix=galerkin/seed_" + std::to_string(seed) + "/results.json")));
    double sum = 0;
    for (const OrderedJson& level : all["methods"]["pcs"]["levels"]) sum += level["iterations"].get<double>();
    iterations.push_back(sum);
  }
  std::sort(iterations.begin(), iterations.end());
  for (const RowQuantity& f : row_quantities(collection.error_measures())) {
    if (f.name != "iterations") continue;
    const auto spread = spread_of(rows[0], f);
    REQUIRE(spread);
    CHECK(spread->low == iterations[0]);
    CHECK(spread->median == iterations[1]);
    CHECK(spread->high == iterations[2]);
  }
  const RunData medians = median_consistency(collection, "matrix=coarse");
  REQUIRE(medians.methods.size() == 3);
  CHECK(medians.methods[0].pair(0, 1)->metrics.of("d_H_fit").value() > 0);
}

TEST_CASE("a final state is not compared with itself where it was the reference") {
  const RunCollection collection = read_runs({sweep()});
  const std::vector<RunRow> rows = rows_of(collection);
  for (const RowQuantity& f : row_quantities(collection.error_measures())) {
    if (f.name != "error_rms" && f.name != "energy_gap") continue;
    for (const RunRow& row : rows) {
      INFO(row.title(true) << " " << f.name);
      CHECK(spread_of(row, f).has_value() == (row.method != "newton"));
    }
  }
  CHECK_THAT(collection_summary(collection),
             Contains(" Final states that were the reference themselves are not compared with it: "
                      "matrix=galerkin, newton in 3 of 3, matrix=coarse, newton in 3 of 3.") &&
                 !Contains("Nearest to the reference (RMS distance): <b>matrix=galerkin, newton"));
}

TEST_CASE("a direct method's cost is that of the level it ends with") {
  const RunCollection collection = read_runs({sweep() / "runs/matrix=galerkin/seed_1"});
  for (const MethodRecord& m : collection.runs[0].data->methods) {
    const double all = *m.levels[0].flops + *m.levels[1].flops;
    CHECK(m.cost(&LevelRecord::flops).value() == (m.name == "newton" ? *m.levels[1].flops : all));
    for (const CostPoint& p : error_curve(*collection.runs[0].data, m.name, 2, 1, "rms"))
      CHECK(p.cost <= all * 1.0001);
  }
}

TEST_CASE("the table and the page of runs have the same costs by the same names") {
  const RunCollection collection = read_runs({sweep() / "runs/matrix=galerkin/seed_1"});
  const RunTable table = table_of(collection);
  const std::vector<RunRow> rows = rows_of(collection);
  REQUIRE(table.rows.size() == rows.size());
  int compared = 0;
  for (std::size_t k = 0; k < rows.size(); ++k)
    for (const RowQuantity& quantity : row_quantities(collection.error_measures())) {
      const Repeat& repeat = rows[k].repeats.at(0);
      INFO(rows[k].method << " " << quantity.name);
      CHECK(table.rows[k]["method"] == rows[k].method);
      const OptionalNumber value = quantity.of(*repeat.run->data, *repeat.method);
      const auto& cell = table.rows[k][quantity.name];
      CHECK(cell.is_null() == !value);
      if (value) CHECK(cell == *value);
      compared += value.has_value();
    }
  CHECK(compared > 3 * 9);
}

TEST_CASE("the table counts steps of the levels that the last state builds on") {
  RunCollection collection = read_runs({sweep() / "runs/matrix=galerkin/seed_1"});
  RunData& run = *collection.runs[0].data;
  for (IterationSeries& series : run.iterations)
    for (RecordedIteration& row : series.rows) row.step_length = 0.5;
  const RunTable table = table_of(collection);
  for (std::size_t k = 0; k < run.methods.size(); ++k) {
    const MethodRecord& method = run.methods[k];
    const bool direct = method.name == "newton";
    INFO(method.name);
    CHECK(table.rows[k]["steps"] == *method.levels[1].steps + (direct ? 0 : *method.levels[0].steps));
    CHECK(table.rows[k]["shortened_steps"] == table.rows[k]["iterations"]);
  }
}

TEST_CASE("report of a sweep is one page with every row, curve and failure") {
  const Ended ended = drape_with("report sweep", sweep().parent_path());
  INFO(ended.err);
  REQUIRE(ended.exit_code == 0);
  CHECK(ended.out == "report: sweep/report.html\n");
  const std::string page = text_of(sweep() / "report.html");
  CHECK_THAT(page, Contains("7 runs of 3 variations: 6 converged, 1 failed.") &&
                       Contains("matrix=galerkin") && Contains("error: a &lt; b\nand more"));
  const OrderedJson data = data_of(page);
  CHECK(data["rows"].size() == 6);
  for (const char* work : {"seconds", "iterations", "flops"})
    for (const char* target : {"own", "reference"})
      for (const char* measure : {"rms", "hausdorff", "d_H_fit", "silhouette_mismatch", "energy_gap"}) {
        const OrderedJson& plot = data["errors"][work][target][measure];
        INFO(work << " " << target << " " << measure);
        REQUIRE(plot["curves"].size() == 6);
        REQUIRE(!plot["front"].empty());
        double last = 0, error = 1e300;
        for (const OrderedJson& point : plot["front"]) {
          CHECK(point[0].get<double>() >= last);
          CHECK(point[1].get<double>() <= error);  // of six digits, which may be the same
          last = point[0], error = point[1];
        }
      }
  // A run's own page is linked to where it is.
  REQUIRE(drape_with("report 'runs/matrix=coarse/seed_2' --width 90", sweep()).exit_code == 0);
  REQUIRE(drape_with("report .", sweep()).exit_code == 0);
  CHECK_THAT(text_of(sweep() / "report.html"), Contains("href=\"runs/matrix=coarse/seed_2/report.html\""));
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
  const Ended ended = drape_with("report runs/matrix=galerkin/seed_1 runs/matrix=galerkin/seed_2 --out " +
                                     (folder / "two.html").string(),
                                 sweep());
  CHECK(ended.exit_code == 0);
  CHECK_THAT(text_of(folder / "two.html"), Contains("2 runs of 1 variation: 2 converged."));
  const RunCollection collection =
      read_runs({sweep() / "runs/matrix=galerkin/seed_1", sweep() / "runs/matrix=coarse/seed_1",
                 sweep() / "runs/matrix=coarse/seed_3"});
  // Both folders are called seed_1.
  CHECK((collection.variations() ==
         std::vector<std::string>{(sweep() / "runs/matrix=galerkin/seed_1").string(),
                                  (sweep() / "runs/matrix=coarse/seed_1").string()}));
  CHECK(collection.runs[2].seed.value() == 3);
}

TEST_CASE("variations of one name are kept apart if they are of different sweeps") {
  const Scratch folder;
  const auto write = [&](const std::string& where, const std::string& name,
                         const std::vector<std::string>& variations) {
    OrderedJson runs = OrderedJson::array();
    for (const std::string& variation : variations)
      for (int seed = 1; seed <= 2; ++seed)
        runs.push_back({{"name", variation}, {"seed", seed}, {"folder", "r"}, {"status", "pending"}});
    fs::create_directory(folder / where);
    folder.write(where + "/sweep.json",
                 OrderedJson{{"sweep", name}, {"complete", true}, {"runs", runs}}.dump());
  };
  write("a", "balls", {"base", "soft"});
  write("b", "cubes", {"base", "stiff"});
  write("c", "cubes", {"base"});
  const auto variations = [&](const std::vector<std::string>& sweeps) {
    std::vector<fs::path> folders;
    for (const std::string& name : sweeps) folders.push_back(folder / name);
    return read_runs(folders).variations();
  };
  using Names = std::vector<std::string>;
  CHECK(variations({"a"}) == Names{"base", "soft"});
  CHECK(variations({"a", "b"}) == Names{"balls: base", "soft", "cubes: base", "stiff"});
  CHECK(variations({"b", "c"}) ==
        Names{(folder / "b").string() + ": base", "stiff", (folder / "c").string() + ": base"});
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
  OrderedJson results = OrderedJson::parse(text_of(folder / "other/results.json"));
  results["experiment"] = "soft";
  folder.write("other/results.json", results.dump());
  folder.write("other/config.yaml",
               replaced(text_of(folder / "other/config.yaml"), "name: small", "name: soft"));
  const RunCollection collection = read_runs({folder / "soft", folder / "stiff", folder / "other"});
  CHECK((collection.variations() == std::vector<std::string>{"soft", "stiff", (folder / "other").string()}));
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
  CHECK(written(two, "page.html").exit_code == 0);
  CHECK(written(".", "page.html").exit_code == 0);  // its own page is replaced
  CHECK_THAT(text_of(folder / "page.html"), Contains("7 runs of 3 variations"));
}

TEST_CASE("an incomplete sweep is read as far as it got") {
  const Scratch folder;
  folder.write(
      "sweep.json",
      R"({"sweep": "s", "complete": false, "runs": [{"name": "a", "seed": 1, "folder": "r", "status": "running"}]})");
  CHECK(drape_with("report .", folder.path).exit_code == 0);
  CHECK_THAT(text_of(folder / "report.html"), Contains("Not all runs are done") && Contains("1 running") &&
                                                  Contains("No run has written results yet."));
  folder.write("sweep.json", "{\"sweep\": ");
  const Ended ended = drape_with("report .", folder.path);
  CHECK(ended.exit_code == 2);
  CHECK(ended.err == "error: ./sweep.json: not a sweep's list of runs; is it cut short?\n");
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

TEST_CASE("compare lists changes, and exits with 1 if a bound is broken") {
  const Edited run([](OrderedJson& all) {
    OrderedJson& pcs = all["methods"]["pcs"];
    pcs["levels"][1]["seconds"] = pcs["levels"][1]["seconds"].get<double>() + 10;
    for (OrderedJson& pair : pcs["consistency"]) pair["d_H_fit"] = pair["d_H_fit"].get<double>() / 2;
    all["methods"]["cascadic"]["levels"][1]["iterations"] = 1000;
  });
  const Ended plain = run.compare();
  CHECK(plain.exit_code == 0);
  for (const char* line :
       {"pcs, level 1 +seconds .* slower\n", "pcs, levels 0 → 1 +d_H_fit .* ×0.500 +better\n",
        "cascadic, level 1 +iterations .* more work\n"})
    CHECK_THAT(plain.out, Catch::Matchers::Matches("[\\s\\S]*" + std::string(line) + "[\\s\\S]*"));
  CHECK(run.compare(" --bound d_H_fit=1 --bound energy_released=1").exit_code == 0);
  const Ended broken = run.compare(" --bound seconds=1.5");
  CHECK(broken.exit_code == 1);
  CHECK_THAT(broken.out,
             Contains("broken: pcs, level 1: seconds went from ") && Contains("slower (bound broken)"));
}

TEST_CASE("compare gives energies no verdict where the models differ, and names the keys") {
  const Edited run([](OrderedJson& all) {
    OrderedJson& level = all["methods"]["pcs"]["levels"][1];
    level["energy_released"] = level["energy_released"].get<double>() + 0.1;
  });
  const auto matches = [](const std::string& line) {
    return Catch::Matchers::Matches("[\\s\\S]*" + line + "[\\s\\S]*");
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

TEST_CASE("a bound is broken if a method no longer converges or exists") {
  const Edited stalled([](OrderedJson& all) { all["methods"]["pcs"]["status"] = "stalled"; });
  CHECK(stalled.compare().exit_code == 0);
  const Ended ended = stalled.compare(" --bound seconds=2");
  CHECK(ended.exit_code == 1);
  CHECK_THAT(ended.out, Contains("broken: pcs: converged before and does not now; no bound holds\n"));
  const Edited gone([](OrderedJson& all) { all["methods"].erase("pcs"); });
  CHECK_THAT(gone.compare().out, Contains("only in the first: pcs\n"));
  CHECK(gone.compare(" --bound seconds=2").exit_code == 1);
}

TEST_CASE("bounds on negative energies and on counts that were zero") {
  const Edited run([](OrderedJson& all) {
    OrderedJson& level = all["methods"]["pcs"]["levels"][1];
    level["energy_released"] = level["energy_released"].get<double>() - 0.1;
  });
  CHECK(run.compare(" --bound energy_released=1.05").exit_code == 1);
  CHECK(run.compare(" --bound energy_released=2").exit_code == 0);
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

// Several runs together: the page about them, and the names by which it tells them apart.

#include "core/app/experiment/experiment.h"
#include "core/app/report/compare.h"
#include "core/app/report/run_table.h"
#include "core/kernel/files/string_utils.h"
#include "tests/configs/runs.h"
#include "tests/support/page_data.h"

using namespace drape;

namespace {

/// A run of the sweep below.
std::string run_of(const std::string& matrix, int seed) {
  return "runs/matrix=" + matrix + "/seed_" + std::to_string(seed);
}

const std::string first = run_of("galerkin", 1), second = run_of("galerkin", 2);

/// A sweep's folder as one would be: two variations with three seeds each, and a run that failed. Made once;
/// cases that change something work on copies.
const Scratch& sweep() {
  static const Scratch folder(small_experiment());
  static const bool made = [] {
    Json runs = Json::array();
    for (const std::string matrix : {"galerkin", "coarse"})
      for (int seed = 1; seed <= 3; ++seed) {
        const std::string run = run_of(matrix, seed);
        run_into(run, folder,
                 "--method all --threads 1 --set methods.pcs.hessian=" + matrix +
                     " --set start.seed=" + std::to_string(seed));
        runs.push_back(
            {{"name", "matrix=" + matrix}, {"seed", seed}, {"folder", run}, {"status", "converged"}});
      }
    runs.push_back(
        Json::parse(R"({"name": "matrix=wrong", "seed": 1, "folder": "runs/wrong", "status": "failed",
                                   "error": "error: a < b\nand more"})"));
    folder.write("sweep.json", Json{{"sweep", "matrices"}, {"complete", true}, {"runs", runs}}.dump());
    return true;
  }();
  REQUIRE(made);
  return folder;
}

using Names = std::vector<std::string>;

/// The variations of runs, in order of appearance.
Names variations_of(const std::vector<fs::path>& folders) {
  Names names;
  for (const RunRecord& run : read_runs(folders).runs)
    if (std::find(names.begin(), names.end(), run.variation) == names.end()) names.push_back(run.variation);
  return names;
}

nlohmann::ordered_json page_in(const fs::path& file) { return page_data(text_of(file)); }

void copy_run(const std::string& run, const fs::path& to) {
  fs::copy(sweep() / run, to, fs::copy_options::recursive);
}

}  // namespace

TEST_CASE("a sweep is read run by run, and a final state is not compared with itself as the reference") {
  const RunCollection collection = read_runs({sweep().path});
  CHECK(collection.name == "matrices");
  CHECK(collection.runs.size() == 7);
  CHECK(variations_of({sweep().path}) == Names{"matrix=galerkin", "matrix=coarse", "matrix=wrong"});
  int rows = 0;
  for (const TableRow& row : table_of(collection).rows) {
    if (row["method"] == "") continue;
    ++rows;
    for (const char* name : {"error_rms", "energy_gap"}) {
      INFO(row.dump() << " " << name);
      CHECK(row[name].is_null() == (row["method"] == "newton"));
    }
  }
  CHECK(rows == 18);
}

TEST_CASE("a direct method's cost and steps are those of the level it ends with") {
  const Scratch folder;
  copy_run(first, folder / "a");
  std::istringstream lines(text_of(folder / "a/iterations.csv"));
  std::string text, line;
  for (bool head = true; std::getline(lines, line); head = false) {
    std::vector<std::string> cells = split(line, ',');
    REQUIRE((!head || cells.at(8) == "step_length"));
    if (!head) cells.at(8) = "0.5";
    for (const std::string& cell : cells) text += cell + (&cell == &cells.back() ? "\n" : ",");
  }
  folder.write("a/iterations.csv", text);
  const RunCollection collection = read_runs({folder / "a"});
  const std::vector<TableRow> rows = table_of(collection).rows;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const MethodRecord& m = collection.runs[0].data->methods.at(k);
    INFO(m.name);
    const auto expected = [&](const char* name) {
      const double fine = number_member(m.levels[1].values, name).value();
      return m.name == "newton" ? fine : number_member(m.levels[0].values, name).value() + fine;
    };
    CHECK(m.cost("flops").value() == expected("flops"));
    CHECK(rows[k]["steps"] == expected("steps"));
    CHECK(rows[k]["shortened_steps"] == rows[k]["iterations"]);
  }
}

TEST_CASE("report of a sweep is one page with every row, state and failure") {
  const std::string name = sweep().path.filename();
  CHECK(shown_by("report " + name, sweep().path.parent_path()) == "report: " + name + "/report.html\n");
  const Json data = page_in(sweep() / "report.html");
  CHECK(data["kind"] == "runs");
  CHECK(data["table"]["rows"].size() == 19);
  REQUIRE(data["runs"].size() == 7);
  int rows = 0;
  for (const Json& run : data["runs"]) rows += run["count"].get<int>();
  CHECK(rows == 19);
  CHECK(data["runs"][0]["pictures"].size() == 3);
  // They differ in a solver's setting, and in the noise at the start.
  for (const Json& row : data["table"]["rows"]) CHECK((row["method"] == "" || row["physics"] == 0));
  CHECK(data["table"]["summary"].size() == 7);
  CHECK(data["table"]["summary"][0]["seconds"]["count"] == 3);
  CHECK(data["model_keys"] == Json(model_keys()));
  CHECK(data["runs"][0]["reference"]["method"] == "newton");
  CHECK(data["runs"][0]["errors"]["rows"].size() > 6);
  CHECK(data["runs"][0]["first_levels"]["newton"] == 1);
  CHECK(data["runs"][6]["error"] == "error: a < b\nand more");
  CHECK(data["runs"][6]["pictures"].empty());
  // A run's own page is written where there was none, stays, and is linked to where it is.
  const std::string own = run_of("coarse", 2) + "/report.html";
  CHECK(data["runs"][4]["report"] == own);
  CHECK(page_in(sweep() / own)["kind"] == "run");
  CHECK(data["runs"][6]["report"] == nullptr);
  const auto written = fs::last_write_time(sweep() / own);
  shown_by("report .", sweep().path);
  CHECK(fs::last_write_time(sweep() / own) == written);
  const Scratch above;
  fs::create_symlink(sweep().path, above / "sweep");
  fs::create_directory(above / "below");
  shown_by("report ../sweep --out ../page.html", above / "below");
  CHECK(page_in(above / "page.html")["runs"][4]["report"] == "sweep/" + own);
}

TEST_CASE("report of several folders takes a page's name, and groups runs by all but their seed") {
  const std::string none = ": neither results.json nor sweep.json here; ";
  check_refusals(
      sweep(), "report ",
      {{first + " " + second, "several folders: name the page with --out, as in --out "},
       {first + " runs --out x.html", "runs" + none},
       {first + " --out x.html", "--out is for the page of several runs; a run's own is report.html in "}});
  const Scratch folder;
  shown_by("report " + first + " " + second + " --out " + (folder / "two.html").string(), sweep().path);
  CHECK(page_in(folder / "two.html")["runs"].size() == 2);
  const std::vector<fs::path> three = {sweep() / first, sweep() / run_of("coarse", 1),
                                       sweep() / run_of("coarse", 3)};
  CHECK(variations_of(three) == Names{three[0].string(), three[1].string()});
  CHECK(read_runs(three).runs[2].seed.value() == 3);
  // A folder stands for the runs in it.
  CHECK(shown_by("table runs/matrix=galerkin", sweep().path) ==
        shown_by("table " + first + " " + second + " " + run_of("galerkin", 3), sweep().path));
  CHECK(shown_by("report runs/matrix=galerkin", sweep().path) ==
        "report: runs/matrix=galerkin/report.html\n");
}

TEST_CASE("variations of one name are kept apart if they are of different sweeps") {
  const Scratch folder;
  const auto write = [&](const std::string& where, const std::string& name, const Names& variations) {
    Json runs = Json::array();
    for (const std::string& variation : variations)
      for (int seed = 1; seed <= 2; ++seed)
        runs.push_back({{"name", variation}, {"seed", seed}, {"folder", "r"}, {"status", "pending"}});
    fs::create_directory(folder / where);
    folder.write(where + "/sweep.json", Json{{"sweep", name}, {"complete", true}, {"runs", runs}}.dump());
    return folder / where;
  };
  const fs::path a = write("a", "balls", {"base", "soft"}), b = write("b", "cubes", {"base", "stiff"}),
                 c = write("c", "cubes", {"base"});
  CHECK(variations_of({a}) == Names{"base", "soft"});
  CHECK(variations_of({a, b}) == Names{"balls: base", "balls: soft", "cubes: base", "cubes: stiff"});
  CHECK(variations_of({b, c}) == Names{b.string() + ": base", b.string() + ": stiff", c.string() + ": base"});
  const RunTable table = table_of(read_runs({a, b}));  // has the sweeps in a column
  REQUIRE(table.rows.size() == 8);
  CHECK(table.rows[0]["run"] == "base");
  CHECK(table.rows[0]["seed"] == 1);
}

TEST_CASE("an experiment and the folder of another one may have the same name") {
  const Scratch folder;
  copy_run(first, folder / "soft");
  for (const char* name : {"stiff", "other"}) copy_run(run_of("coarse", 1), folder / name);
  edit_json(folder / "other/results.json", [](Json& all) { all["experiment"] = "soft"; });
  folder.write("other/config.yaml",
               replaced(text_of(folder / "other/config.yaml"), "name: small", "name: soft"));
  CHECK(variations_of({folder / "soft", folder / "stiff", folder / "other"}) ==
        Names{(folder / "soft").string(), (folder / "stiff").string(), "soft"});
}

TEST_CASE("report replaces drape's own pages and no other file") {
  const Scratch folder;
  const std::string two = first + " " + second, notes = (folder / "notes.html").string(),
                    page = (folder / "page.html").string();
  folder.write("notes.html", "<title>mine</title>");
  for (const std::string& runs : {two, std::string(".")})
    check_refusals(sweep(), "report ",
                   {{runs + " --out " + notes, notes + ": is there already, and no report of "}});
  CHECK(text_of(notes) == "<title>mine</title>");
  for (const std::string& own : {second, "./" + first})
    check_refusals(sweep(), "report ",
                   {{two + " --out " + own + "/report.html", own + "/report.html: is the place of a "}});
  shown_by("report " + two + " --out " + page, sweep().path);
  shown_by("report . --out " + page, sweep().path);  // its own page is replaced
  CHECK(page_in(page)["runs"].size() == 7);
}

TEST_CASE("an incomplete sweep is read as far as it got, a nameless one too, and a page tells of cut runs") {
  const Scratch folder;
  const std::string runs = R"("runs": [{"name": "a", "seed": 1, "folder": "r", "status": "running"}]})";
  folder.write("sweep.json", R"({"sweep": "s", "complete": false, )" + runs);
  drape_ends("report .", folder);
  const Json data = page_in(folder / "report.html");
  CHECK(data["complete"] == false);
  CHECK(data["runs"][0]["status"] == "running");
  folder.write("sweep.json", "{" + runs);
  const RunCollection collection = read_runs({folder.path});
  CHECK(collection.name == "");
  REQUIRE(collection.runs.size() == 1);
  CHECK_FALSE(collection.runs[0].data);
  folder.write("sweep.json", "{\"sweep\": ");
  CHECK(refused(folder, "report .") == "error: ./sweep.json: not a sweep's list of runs; is it cut short?\n");

  for (const char* name : {"a", "b"}) copy_run(first, folder / name);
  edit_json(folder / "b/results.json", [](Json& all) { all["complete"] = false; });
  shown_by("report a b --out two.html", folder.path);
  CHECK(page_in(folder / "two.html")["complete"] == false);
}

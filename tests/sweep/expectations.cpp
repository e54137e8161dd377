// Several experiments in one sweep, runs that are to fail, and the table of how all of them ended.

#include <nlohmann/json.hpp>

#include "core/app/report/run_table.h"
#include "tests/support/command.h"

using namespace drape;
using Catch::Contains;
using Catch::StartsWith;

namespace {

/// Cases that end in each way that they can by themselves; the last not as expected.
std::string cases() {
  return R"(
name: cases
base: e.yaml
set: {levels: 1}
methods: [newton]
ablation:
  - {name: easy}
  - {name: silent, set: {refiner: midpoint}, expect: {message: snow}}
  - name: unheld
    set: {pins: [{region: ball, point: [9, 9, 9], radius: 0.1}]}
    expect: {status: refused, message: widen its region}
  - name: refused for another reason
    set: {pins: [{region: ball, point: [9, 9, 8], radius: 0.1}]}
    expect: {status: refused, message: snow}
  - {name: short, set: {newton.max_steps: 1}, expect: {status: max_steps_reached, message: max_steps = 1}}
  - {name: for another reason, set: {newton.max_steps: 2}, expect: {status: max_steps_reached, message: snow}}
)";
}

/// One more, and a limit on the clock, which a busy machine lets no other case exceed: they have ended
/// before.
const std::string endless =
    "  - {name: endless, set: {newton: {step_size: 1e-7, step_growth: 1, max_steps: 100000000}}}\n"
    "time_limit: 1\n";

/// A run of one method and one level, both of this status.
RunRecord run_of(const std::string& status, const std::map<std::string, double>& values) {
  RunRecord run;
  run.status = "converged";
  MethodRecord& method = run.data.emplace().methods.emplace_back();
  LevelRecord& level = method.levels.emplace_back();
  method.status = level.status = status;
  level.values = values;
  return run;
}

bool passes(RunRecord run, const std::string& expected = "converged") {
  run.expected = expected;
  return table_of({"set", "", true, {run}}).all_pass();
}

}  // namespace

TEST_CASE("a run passes when it ends as its sweep expects, for the reason expected") {
  const Scratch folder(small_experiment());
  folder.write("s.yaml", cases());
  CHECK_THAT(drape_ends("sweep s.yaml --out out", folder, 1).err,
             Contains("unheld, seed 1: refused, as expected, after") &&
                 Contains("refused for another reason, seed 1: failed"));
  folder.write("s.yaml", cases() + endless);
  const Ended swept = drape_ends("sweep s.yaml --out out", folder, 1);
  CHECK_THAT(swept.err, Contains("endless, seed 1: failed") && Contains("exceeded the sweep's time_limit") &&
                            Contains("; 1 failed"));
  CHECK_THAT(swept.out, Contains("unheld     ") && Contains("refused, as expected  ") &&
                            Contains("widen its region") && Contains("exceeded the sweep's time_limit"));

  const Json rows = Json::parse(drape_ends("table out --format json", folder, 1).out);
  std::string outcomes;
  for (const Json& row : rows)
    outcomes += row["run"].get<std::string>() + ": " + row["status"].get<std::string>() +
                (row["pass"] == true ? ", passes\n" : "\n");
  REQUIRE(outcomes ==
          "easy: converged, passes\nsilent: converged\nunheld: refused, passes\n"
          "refused for another reason: refused\nshort: max_steps_reached, passes\n"
          "for another reason: max_steps_reached\nendless: timeout\n");
  CHECK(rows[0]["method"] == "newton");
  CHECK(rows[0]["vertices"] > 10);
  CHECK(rows[4]["iterations"] == 1);
  CHECK(rows[0]["energy_released"].is_number());
  CHECK(rows[2]["vertices"].is_null());
  CHECK_THAT(rows[2]["message"].get<std::string>(), Contains("selects no vertex"));

  CHECK_THAT(drape_with("table out --columns run,pass,status,steps", folder.path).out,
             StartsWith("| run | pass | status | steps |\n| --- | --- | --- | ---: |\n") &&
                 Contains("| short | yes | max_steps_reached | 1 |\n| for another reason | NO | "
                          "max_steps_reached | 2 |\n| endless | NO | timeout |  |\n"));
  CHECK_THAT(drape_with("table out --format csv --columns run,pass,status", folder.path).out,
             StartsWith("run,pass,status\neasy,yes,converged\n"));
  CHECK(drape_with("table out --columns runs", folder.path).err ==
        "error: there is no column \"runs\"; did you mean \"run\"?\n");
}

TEST_CASE("every value that a metric declares is a column by its name") {
  RunData data;
  data.metrics = {{"sag", MetricScope::state, {.columns = {{.name = "sag"}}}},
                  {"drift", MetricScope::pair, {.columns = {{.name = "drift", .shown = Shown::stored}}}},
                  {"worst", MetricScope::state, {.columns = {{.name = "worst", .shown = Shown::summary}}}}};
  MethodRecord& method = data.methods.emplace_back();
  method.name = method.status = "newton";
  for (int level = 0; level < 2; ++level) {
    LevelRecord& one = method.levels.emplace_back();
    one.level = level;
    one.values = {{"sag", 3 - level}, {"worst", 3 - level}};
  }
  method.consistency.push_back({0, 1, {{"drift", 0.5}}, {}});
  RunRecord run;
  run.data = data;
  const RunTable table = table_of({"set", "", true, {run}});
  CHECK(table_text(table, {"sag", "drift", "worst"}, TableFormat::csv) == "sag,drift,worst\n2,0.5,3\n");
  CHECK_THAT(table_text(table, {}, TableFormat::csv), Contains(",sag,drift"));
  CHECK_THAT(table_text(table, {}, TableFormat::markdown),
             Contains("| worst |") && !Contains("sag") && !Contains("drift"));
}

TEST_CASE("an intersection, an energy that is no number or lost results fail whatever the status") {
  CHECK(passes(run_of("converged", {{"energy_on_finest", 1}, {"intersections", 0}})));
  CHECK(!passes(run_of("converged", {{"energy_on_finest", 1}, {"intersections", 1}})));
  CHECK(!passes(run_of("converged", {{"intersections", 0}})));
  RunRecord lost;
  lost.status = "converged";
  CHECK(!passes(lost));
}

TEST_CASE("what has converged to rounding passes where it was to converge, and is told apart") {
  const auto ended = [](const std::string& status) { return run_of(status, {{"energy_on_finest", 1}}); };
  CHECK(passes(ended("converged_to_rounding")));
  CHECK(passes(ended("converged_to_rounding"), "converged_to_rounding"));
  CHECK(!passes(ended("converged"), "converged_to_rounding"));
  CHECK(!passes(ended("converged_to_rounding"), "stalled"));
  CHECK(!passes(ended("stalled")));
}

TEST_CASE("a table counts no shortened steps where rows of iterations.csv are missing") {
  const RunTable table = table_of({"set", "", true, {run_of("converged", {{"iterations", 3}})}});
  CHECK(table.rows[0]["shortened_steps"].is_null());
}

TEST_CASE("a sweep over several experiments names each run by its experiment") {
  const Scratch folder;
  for (const char* sub : {"scenes", "sweeps"}) std::filesystem::create_directory(folder / sub);
  folder.write("scenes/b.yaml", replaced(small_experiment(), "name: small", "name: second"));
  folder.write("scenes/a.yaml", replaced(small_experiment(), "name: small", "name: first"));
  folder.write("sweeps/s.yaml",
               "name: s\nexperiments: [../scenes/*.yaml]\nset: {levels: 1}\nmethods: [newton]\n");
  drape_ends("sweep sweeps/s.yaml --out out", folder);
  CHECK_THAT(drape_with("table out --columns run,method,pass", folder.path).out,
             Contains("| first | newton | yes |\n| second | newton | yes |\n"));
  CHECK(std::filesystem::exists(folder / "out/runs/first/seed_1/results.json"));

  folder.write("sweeps/two.yaml",
               "name: two\nexperiments: [../scenes/a.yaml, ../scenes/b.yaml]\nset: {levels: 1}\n"
               "ablation: [{name: as it is}, {name: loop, set: {refiner: midpoint}}]\n");
  CHECK_THAT(drape_with("sweep sweeps/two.yaml --dry-run", folder.path).out,
             Contains("runs/first,_as_it_is/seed_1 ") && Contains("runs/second,_loop/seed_1 "));

  const std::vector<std::pair<std::string, std::string>> faults{
      {"base: \"\"", "is empty; name an experiment"},
      {"experiments: []", "is empty; name an experiment"},
      {"", R"(sweeps/bad.yaml:1:1: "base" is required and missing, or "experiments" in its place)"},
      {"base: ../scenes/a.yaml\nexperiments: [../scenes/b.yaml]",
       R"(sweeps/bad.yaml:3:14: "base" and "experiments" are both given; keep one of them)"},
      {"experiments: [../scene/*.yaml]",
       "sweeps/bad.yaml:2:15: no file is called like ../scene/*.yaml, seen from this file"},
      {"experiments: [../scenes/a.yaml, ../scenes/a.yaml]",
       "sweeps/bad.yaml:2:33: experiments sweeps/../scenes/a.yaml and sweeps/../scenes/a.yaml have the same"},
      {"experiments: [../scenes/c.yaml]",
       "no such file (the sweep's \"experiments\", named at sweeps/bad.yaml:2:15)"},
      {"experiments: [../scenes/a.yaml]\nset: {levels: 0}", "\"levels\" must be at least 1"}};
  for (const auto& [text, fault] : faults) {
    folder.write("sweeps/bad.yaml", "name: bad\n" + text + "\n");
    CHECK_THAT(refused_by("sweep sweeps/bad.yaml", folder.path), Contains(fault));
  }
}

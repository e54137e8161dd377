// Which methods a run runs, what it says, and what it leaves behind.

#include <sched.h>

#include <set>

#include "core/app/files/csv.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/mesh_files/io.h"
#include "tests/configs/runs.h"

namespace {

constexpr int levels = 3;
const std::vector<std::string> methods = {"cascadic", "newton", "pcs"};

/// The small experiment on three levels, run once for all cases.
const fs::path& whole_run() {
  static const Scratch folder(small_experiment());
  static const fs::path path = [] {
    const Ended ended = drape_ends("run e.yaml --out out --method all --threads 1 --levels 3", folder);
    REQUIRE(ended.out == "report: out/report.html\n");
    // One line stays for each level of each method, then the methods' table with its heads.
    REQUIRE(std::count(ended.err.begin(), ended.err.end(), '\n') == (levels + 1) * int(methods.size()) + 1);
    return folder / "out";
  }();
  return path;
}

std::set<std::string> keys(const nlohmann::json& object) {
  std::set<std::string> names;
  for (const auto& [key, value] : object.items()) names.insert(key);
  return names;
}

/// Those of the names that docs/reference/outputs.md does not have before the colon of an item of a list.
std::vector<std::string> undocumented(std::vector<std::string> names) {
  std::istringstream page(text_of(folders::source() / "docs/reference/outputs.md"));
  for (std::string line; std::getline(page, line);)
    if (line.starts_with("- "))
      std::erase_if(names, [&](const std::string& name) {
        return line.substr(0, line.find(": ")).find('`' + name + '`') != std::string::npos;
      });
  return names;
}

/// The methods in the results of a short run, in order, and the note about others; or the refusal.
std::string methods_of(const std::string& methods, const std::string& options) {
  const Scratch folder(replaced(small_experiment(),
                                "methods:\n  pcs: {}\n  cascadic: {}\n  newton: {}\nreference: newton\n",
                                "methods: " + methods + "\n"));
  const Ended ended =
      drape_with("run e.yaml --out out --levels 1 --set newton.max_steps=1 --no-report --measure " + options,
                 folder.path);
  CHECK(ended.exit_code == (fs::exists(folder / "out") ? 1 : 2));
  if (ended.exit_code == 2) return ended.err;
  std::string names;
  const auto results = nlohmann::ordered_json::parse(text_of(folder / "out/results.json"));
  for (const auto& [name, method] : results.at("methods").items()) names += name + " ";
  const std::size_t note = ended.err.find("only pcs was run");
  return names + (note == std::string::npos ? "" : ended.err.substr(note));
}

}  // namespace

TEST_CASE("pcs runs unless methods are named, and the user learns of the others") {
  const std::string three = "{cascadic: {}, pcs: {}, newton: {}}",
                    two = "{direct: {type: newton}, cascadic: {}}";
  CHECK(methods_of(three, "") == "pcs only pcs was run; --method all adds cascadic, newton\n");
  CHECK(methods_of(three, "--quiet") == "pcs ");
  CHECK(methods_of(three, "--method newton,cascadic") == "cascadic newton ");  // in the experiment's order
  CHECK(methods_of(three, "--method all") == "cascadic pcs newton ");
  CHECK(methods_of("{newton: {}}", "") == "newton ");
  check_error(methods_of(two, ""), "the experiment has no method pcs, which runs by default; ");
  CHECK(methods_of(two, "--method all") == "direct cascadic ");
  CHECK_THAT(methods_of("{all: {type: pcs}}", ""), Contains("\"all\" cannot name a method, since "));
}

TEST_CASE("a run of several methods ends with a table; -v shows every iteration, -q nothing") {
  const Scratch folder(small_experiment());
  const auto said = [&](const std::string& options) {
    return drape_with("run e.yaml --no-report --measure --overwrite -j 1 -o out " + options, folder.path).err;
  };
  const std::string both = said("--method pcs,newton");
  CHECK_THAT(
      both.substr(std::min(both.size(), both.find("\nmethod  status     preview_seconds  preview_rms  "))),
      Contains("\npcs     converged  ") && Contains("\nnewton  converged  "));
  CHECK_THAT(said("--levels 1 -v"), Contains("pcs level 0/0 step 0 iteration 0  residual ") &&
                                        Contains("step size ") && !Contains("preview_rms"));
  CHECK(said("--levels 1 -q") == "");
  CHECK_THAT(refused(folder, "run e.yaml -o out -q -v"), Contains(" excludes --"));
}

TEST_CASE("results.json has every key, finite figures and every pair of levels; what it names reads back") {
  const nlohmann::json all = results_in(whole_run());
  CHECK(all.at("experiment") == "small");
  CHECK(all.at("complete") == true);
  REQUIRE((keys(all.at("methods")) == std::set<std::string>(methods.begin(), methods.end())));
  std::set<std::string> declared;
  for (const auto& [metric, declaration] : all["metrics"].items())
    for (const nlohmann::json& column : declaration["columns"])
      declared.insert(column["name"].get<std::string>());
  for (const auto& [name, method] : all["methods"].items()) {
    INFO(name);
    CHECK(method.at("status") == "converged");
    CHECK(method.at("seconds") > 0);
    CHECK(method.at("peak_memory_bytes") > 1'000'000);
    REQUIRE(method.at("levels").size() == levels);
    double seconds = 0;
    for (int l = 0; l < levels; ++l) {
      INFO("level " << l);
      const nlohmann::json& level = method["levels"][l];
      std::vector<std::string> own;
      for (const std::string& key : keys(level))
        if (!declared.count(key)) own.push_back(key);
      CHECK(undocumented(own).empty());
      const int side = 5 * (1 << l);
      CHECK(level.at("level") == l);
      CHECK(level.at("vertices") == (side + 1) * (side + 1));
      CHECK(level.at("triangles") == 2 * side * side);
      CHECK(level.at("status") == "converged");
      CHECK(level.at("steps") > 0);
      CHECK(level.at("iterations") >= level["steps"]);
      CHECK(level.at("force_residual").get<double>() <= 1e-2);
      CHECK(level.at("decrement") >= 0);
      CHECK(level.at("largest_stretch") > 1);
      for (const char* energy : {"energy", "energy_on_finest", "energy_released"})
        CHECK(level.at(energy).is_number());
      for (const char* of_contact : {"intersections", "smallest_gap"})  // which no contact model looked for
        CHECK(level.at(of_contact).is_null());
      CHECK(level.at("cpu_seconds") > 0);
      for (const char* load : {"load_before", "load_after"}) CHECK(level.at(load) >= 0);
      double phases = 0;
      for (const auto& [phase, value] : level.at("seconds_by_phase").items()) phases += value.get<double>();
      CHECK(phases > 0);
      CHECK(phases <= level["seconds"].get<double>() * 1.001);
      seconds += level["seconds"].get<double>();

      const fs::path file = whole_run() / level.at("mesh").get<std::string>();
      const drape::TriangleMesh mesh = drape::read_mesh(file),
                                rest =
                                    drape::read_mesh(whole_run() / ("rest/l" + std::to_string(l) + ".ply"));
      CHECK(mesh.vertices.rows() == (side + 1) * (side + 1));
      CHECK(mesh.vertices.allFinite());
      CHECK((mesh.triangles == rest.triangles));
      CHECK(text_of(fs::path(file).replace_extension(".vtp")).ends_with("</VTKFile>\n"));
    }
    CHECK(method["seconds"].get<double>() == Approx(seconds));
    // Without limits and contact both are the same sum.
    CHECK(method["levels"].back()["energy_on_finest"] == method["levels"].back()["energy"]);

    std::vector<std::pair<int, int>> pairs;
    for (const nlohmann::json& pair : method.at("consistency")) {
      pairs.emplace_back(pair["coarse"], pair["fine"]);
      REQUIRE(pair.contains("fields") == (pair["fine"] == levels - 1));
      if (pair.contains("fields"))
        for (const auto& field : drape::read_ply_fields(whole_run() / pair["fields"].get<std::string>()))
          CHECK(field.values.allFinite());
      for (const char* measure : {"distance_rms", "silhouette_overlap", "energy_above_end", "d_H_fit",
                                  "d_H_ddg", "d_K_fit", "d_K_ddg"}) {
        INFO(measure);
        CHECK(pair["of_start"].contains(measure));
        CHECK(pair.contains(measure));
        if (std::string(measure).starts_with("d_")) CHECK(pair[measure] > 0);
      }
    }
    CHECK((pairs == std::vector<std::pair<int, int>>{{0, 1}, {0, 2}, {1, 2}}));
    CHECK(method.contains("reference") == (name != "newton"));
  }
}

TEST_CASE("iterations.csv has a row for every Newton iteration, and the proxy where it is minimised") {
  const drape::Csv csv(whole_run() / "iterations.csv");
  CHECK(csv.names() ==
        drape::split("method,level,step,iteration,seconds,energy,decrement,force_residual,step_length,"
                     "proxy_energy,step_size,contacts,smallest_gap,intersections,flops,time",
                     ','));
  CHECK(undocumented(csv.names()).empty());
  std::map<std::pair<std::string, int>, int> rows;
  for (std::size_t row = 0; row < csv.size(); ++row) {
    const std::string method = csv.text(row, "method");
    const int level = static_cast<int>(csv.number(row, "level").value());
    ++rows[{method, level}];
    std::set<std::string> empty = {"method", "contacts", "smallest_gap", "intersections", "time"};
    if (method != "pcs" || level == levels - 1) empty.insert("proxy_energy");
    for (const std::string& column : csv.names()) {
      INFO("row " << row << ", " << column);
      CHECK(csv.number(row, column).has_value() == !empty.count(column));  // no contact, no schedule
    }
    CHECK(csv.number(row, "flops").value() > 0);
  }
  const nlohmann::json all = results_in(whole_run())["methods"];
  for (const std::string& method : methods)
    for (int l = 0; l < levels; ++l)
      CHECK(rows[{method, l}] == all[method]["levels"][l]["iterations"].get<int>());
  CHECK(rows.size() == methods.size() * levels);
}

TEST_CASE("log.jsonl is one JSON object a line, from start to end; no file is incomplete") {
  std::istringstream lines(text_of(whole_run() / "log.jsonl"));
  std::map<std::string, int> events;
  double last = 0;
  for (std::string line; std::getline(lines, line);) {
    const nlohmann::json entry = nlohmann::json::parse(line);
    ++events[entry.at("event").get<std::string>()];
    CHECK(entry.at("time") >= last);
    last = entry["time"];
  }
  CHECK((events == std::map<std::string, int>{{"run_started", 1},
                                              {"method_started", 3},
                                              {"level_started", 9},
                                              {"level_finished", 9},
                                              {"method_finished", 3},
                                              {"run_finished", 1}}));
  for (const auto& [name, bytes] : files_in(whole_run())) CHECK_FALSE(name.ends_with(".part"));
  CHECK(text_of(whole_run() / "report.html").ends_with("</html>\n"));
}

TEST_CASE("the saved config has the defaults, and reproduces itself and the meshes, bit for bit") {
  const std::string config = text_of(whole_run() / "config.yaml");
  for (const char* line : {"\n  density: 472.6\n", "\ncontact: []\n", "\n  corner_angle: 30\n",
                           "\n    acceleration: [0, 0, -9.81]\n", "\n  - type: stretch\n"})
    CHECK_THAT(config, Contains(line));
  const Scratch folder;
  drape_ends("run " + (whole_run() / "config.yaml").string() +
                 " --out out --method all --threads 1 -q --no-report --measure",
             folder);
  std::vector<std::string> names = {"config.yaml"};
  for (const auto& [name, bytes] : files_in(whole_run()))
    if (name.starts_with("levels/") && name.ends_with(".ply")) names.push_back(name);
  REQUIRE(names.size() == 1 + levels * methods.size());
  check_same_files(folder / "out", whole_run(), names);
}

TEST_CASE("a run takes as many threads as there are cores that it may use") {
  // The command inherits the test's cores.
  cpu_set_t before, first;
  REQUIRE(sched_getaffinity(0, sizeof before, &before) == 0);
  CPU_ZERO(&first);
  for (int cpu = 0; CPU_COUNT(&first) == 0; ++cpu)
    if (CPU_ISSET(cpu, &before)) CPU_SET(cpu, &first);
  REQUIRE(sched_setaffinity(0, sizeof first, &first) == 0);
  const Scratch folder(small_experiment());
  const Ended ended = drape_with("run e.yaml --out out --quiet --no-report --measure", folder.path);
  sched_setaffinity(0, sizeof before, &before);
  REQUIRE(ended.exit_code == 0);
  const nlohmann::json machine = results_in(folder / "out")["machine"];
  CHECK(machine["threads"] == 1);
  CHECK(machine["cores"] == 1);
  CHECK(machine["processors"] >= 1);
}

TEST_CASE("a metric that throws leaves a note, and the run continues") {
  const std::string fault =
      "not finite: energy neo_hookean is not, as triangle 0 (0, 1, 7) has no area there; change the start";
  const Scratch folder(replaced(small_experiment(), "[0.9, 0.9, 1]", "[0, 0, 1]"));
  CHECK_THAT(drape_with("check e.yaml", folder.path).err,
             Contains("\nerror: e.yaml:4:8: energy or forces at the start of level 0 are " + fault + "\n"));
  const Ended ended = run_into("out", folder, "--method all --threads 1", 1);
  CHECK_THAT(ended.err, StartsWith("warning: e.yaml:4:8: the start has 0 times the lengths"));
  std::istringstream lines(ended.err.substr(ended.err.find('\n') + 1));
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("error: "))  // of a method that did not converge
      CHECK_THAT(line, StartsWith("metric ") && Contains(" was not measured: "));
  const nlohmann::json all = results_in(folder / "out");
  CHECK(all["complete"] == true);
  CHECK(all["methods"].size() == methods.size());
  for (const auto& [name, method] : all["methods"].items()) {
    CHECK(method["status"] == "infeasible");
    CHECK(method["levels"][0]["message"] == "energy or forces at the start are " + fault);
    CHECK_THAT(method["consistency"][0]["not_measured"]["curvature_consistency"].get<std::string>(),
               StartsWith("curvature: the triangles around vertex 0 "));
  }
}

TEST_CASE("a run that ended before its first method did has a row that does not pass") {
  const Scratch folder(small_experiment());
  run_into("out", folder, "--method pcs");
  nlohmann::json all = results_in(folder / "out");
  all["methods"] = nlohmann::json::object();
  all["complete"] = false;
  folder.write("out/results.json", all.dump());
  CHECK_THAT(drape_ends("table out", folder, 1).out,
             Contains("running") && Contains("no method has begun; if the run has ended"));
  all["aborted"] = "the disk is full";
  folder.write("out/results.json", all.dump());
  CHECK_THAT(drape_ends("table out", folder, 1).out, Contains("| aborted | the disk is full |"));
  drape_ends("report out", folder);
}

// What a finished run leaves behind.

#include <sched.h>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>

#include "core/app/files/csv.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/mesh_files/io.h"
#include "tests/support/command.h"

namespace fs = std::filesystem;

namespace {

constexpr int levels = 3;
const std::vector<std::string> methods = {"cascadic", "newton", "pcs"};

/// The small experiment on three levels, run once for all cases.
const fs::path& whole_run() {
  static const Scratch folder;
  static const fs::path path = [] {
    folder.write("e.yaml", small_experiment());
    const Ended ended = drape_ends("run e.yaml --out out --method all --threads 1 --levels 3", folder);
    REQUIRE(ended.out == "report: out/report.html\n");
    // One line stays for each level of each method, then the methods' table with its heads.
    REQUIRE(std::count(ended.err.begin(), ended.err.end(), '\n') == (levels + 1) * int(methods.size()) + 1);
    return folder / "out";
  }();
  return path;
}

nlohmann::json results() { return json_in(whole_run() / "results.json"); }

std::set<std::string> keys(const nlohmann::json& object) {
  std::set<std::string> names;
  for (const auto& [key, value] : object.items()) names.insert(key);
  return names;
}

/// Whether the object has all of these keys.
bool has(const nlohmann::json& object, const std::set<std::string>& names) {
  const std::set<std::string> present = keys(object);
  for (const std::string& name : names) {
    UNSCOPED_INFO("key " << name);
    if (!present.count(name)) return false;
  }
  return true;
}

/// Those of the names that docs/reference/outputs.md does not have in the first column of a table.
std::vector<std::string> undocumented(std::vector<std::string> names) {
  std::istringstream page(text_of(folders::source() / "docs/reference/outputs.md"));
  for (std::string line; std::getline(page, line);)
    if (line.rfind("| ", 0) == 0)
      std::erase_if(names, [&](const std::string& name) {
        return line.substr(0, line.find('|', 1)).find('`' + name + '`') != std::string::npos;
      });
  return names;
}

}  // namespace

TEST_CASE("results.json has every key, finite figures and every pair of levels") {
  const nlohmann::json all = results();
  CHECK(all.at("experiment") == "small");
  CHECK(all.at("complete") == true);
  REQUIRE((keys(all.at("methods")) == std::set<std::string>(methods.begin(), methods.end())));
  for (const auto& [name, method] : all["methods"].items()) {
    INFO(name);
    REQUIRE(has(method, {"status", "seconds", "peak_memory_bytes", "levels", "consistency"}));
    CHECK(method["status"] == "converged");
    CHECK(method["seconds"].get<double>() > 0);
    CHECK(method["peak_memory_bytes"].get<long>() > 1'000'000);
    REQUIRE(method["levels"].size() == levels);
    double seconds = 0;
    for (int l = 0; l < levels; ++l) {
      INFO("level " << l);
      const nlohmann::json& level = method["levels"][l];
      REQUIRE(has(level, {"level", "vertices", "triangles", "status", "steps", "iterations", "seconds",
                          "seconds_by_phase", "energy", "energy_on_finest", "energy_released", "decrement",
                          "force_residual", "largest_stretch", "intersections", "smallest_gap", "mesh"}));
      std::set<std::string> declared;
      for (const auto& [metric, declaration] : all["metrics"].items())
        for (const nlohmann::json& column : declaration["columns"])
          declared.insert(column["name"].get<std::string>());
      std::vector<std::string> own;
      for (const std::string& key : keys(level))
        if (!declared.count(key)) own.push_back(key);
      CHECK(undocumented(own).empty());
      const int side = 5 * (1 << l);
      CHECK(level["level"] == l);
      CHECK(level["vertices"] == (side + 1) * (side + 1));
      CHECK(level["triangles"] == 2 * side * side);
      CHECK(level["status"] == "converged");
      CHECK(level["steps"].get<int>() > 0);
      CHECK(level["iterations"].get<int>() >= level["steps"].get<int>());
      CHECK(level["force_residual"].get<double>() <= 1e-2);
      CHECK(level["decrement"].get<double>() >= 0);
      CHECK(level["energy"].is_number());
      CHECK(level["energy_on_finest"].is_number());
      CHECK(level["largest_stretch"].get<double>() > 1);
      CHECK(level["intersections"].is_null());  // no contact model looked
      CHECK(level["smallest_gap"].is_null());
      double phases = 0;
      for (const auto& [phase, value] : level["seconds_by_phase"].items()) phases += value.get<double>();
      CHECK(phases > 0);
      CHECK(phases <= level["seconds"].get<double>() * 1.001);
      seconds += level["seconds"].get<double>();
    }
    CHECK(method["seconds"].get<double>() == Approx(seconds));
    // Without limits and contact both are the same sum.
    CHECK(method["levels"].back()["energy_on_finest"] == method["levels"].back()["energy"]);

    std::vector<std::pair<int, int>> pairs;
    for (const nlohmann::json& pair : method["consistency"]) {
      const std::set<std::string> measures = {"d_H_fit",         "d_H_ddg",      "d_K_fit",
                                              "d_K_ddg",         "distance_rms", "silhouette_overlap",
                                              "energy_above_end"};
      REQUIRE(has(pair, {"coarse", "fine"}));
      REQUIRE(has(pair, measures));
      REQUIRE(has(pair["of_start"], measures));
      pairs.emplace_back(pair["coarse"], pair["fine"]);
      for (const char* measure : {"d_H_fit", "d_H_ddg", "d_K_fit", "d_K_ddg"}) {
        INFO(measure);
        CHECK(pair[measure].get<double>() > 0);
      }
    }
    CHECK((pairs == std::vector<std::pair<int, int>>{{0, 1}, {0, 2}, {1, 2}}));
    CHECK(method.contains("reference") == (name != "newton"));
  }
}

TEST_CASE("every mesh and field that is named reads back, on the level's triangles") {
  const nlohmann::json all = results();
  std::vector<drape::Triangles> triangles;
  for (int l = 0; l < levels; ++l)
    triangles.push_back(drape::read_mesh(whole_run() / ("rest/l" + std::to_string(l) + ".ply")).triangles);
  for (const auto& [name, method] : all["methods"].items()) {
    for (int l = 0; l < levels; ++l) {
      const fs::path file = whole_run() / method["levels"][l]["mesh"].get<std::string>();
      INFO(file);
      const drape::TriangleMesh mesh = drape::read_mesh(file);
      CHECK(mesh.vertices.rows() == method["levels"][l]["vertices"].get<int>());
      CHECK(mesh.vertices.allFinite());
      CHECK((mesh.triangles.array() == triangles[l].array()).all());
      CHECK(text_of(fs::path(file).replace_extension(".vtp")).ends_with("</VTKFile>\n"));
    }
    int fields = 0;
    for (const nlohmann::json& pair : method["consistency"]) {
      CHECK(pair.contains("fields") == (pair["fine"] == levels - 1));
      if (!pair.contains("fields")) continue;
      ++fields;
      for (const drape::VertexField& field :
           drape::read_ply_fields(whole_run() / pair["fields"].get<std::string>())) {
        INFO(field.name);
        CHECK(field.values.allFinite());
      }
    }
    CHECK(fields == levels - 1);
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
  const nlohmann::json all = results();
  for (const std::string& method : methods)
    for (int l = 0; l < levels; ++l)
      CHECK(rows[{method, l}] == all["methods"][method]["levels"][l]["iterations"].get<int>());
  CHECK(rows.size() == methods.size() * levels);
}

TEST_CASE("log.jsonl is one JSON object a line, from start to end") {
  std::istringstream lines(text_of(whole_run() / "log.jsonl"));
  std::map<std::string, int> events;
  double last = 0;
  for (std::string line; std::getline(lines, line);) {
    const nlohmann::json entry = nlohmann::json::parse(line);
    ++events[entry.at("event").get<std::string>()];
    CHECK(entry.at("time").get<double>() >= last);
    last = entry["time"];
  }
  CHECK((events == std::map<std::string, int>{{"run_started", 1},
                                              {"method_started", 3},
                                              {"level_started", 9},
                                              {"level_finished", 9},
                                              {"method_finished", 3},
                                              {"run_finished", 1}}));
}

TEST_CASE("the report is there, and no incomplete file") {
  CHECK(text_of(whole_run() / "report.html").ends_with("</html>\n"));
  for (const auto& entry : fs::recursive_directory_iterator(whole_run())) {
    INFO(entry.path());
    CHECK(entry.path().extension() != ".part");
  }
}

TEST_CASE("the saved config reproduces itself and the meshes, bit for bit") {
  const Scratch folder;
  const std::string config = (whole_run() / "config.yaml").string();
  drape_ends("run " + config + " --out out --method all --threads 1 --quiet --no-report", folder);
  CHECK(text_of(folder / "out/config.yaml") == text_of(config));
  for (const std::string& method : methods)
    for (int l = 0; l < levels; ++l) {
      const std::string mesh = "levels/" + method + "_l" + std::to_string(l) + ".ply";
      INFO(mesh);
      CHECK((text_of(folder / ("out/" + mesh)) == text_of(whole_run() / mesh)));
    }
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
  const Ended ended = drape_with("run e.yaml --out out --quiet --no-report", folder.path);
  sched_setaffinity(0, sizeof before, &before);
  REQUIRE(ended.exit_code == 0);
  const nlohmann::json machine = json_in(folder / "out/results.json")["machine"];
  CHECK(machine["threads"] == 1);
  CHECK(machine["cores"] == 1);
}

TEST_CASE("the saved config has the defaults of omitted parameters") {
  const std::string config = text_of(whole_run() / "config.yaml");
  for (const char* line : {"\n  density: 472.6\n", "\ncontact: []\n", "\n  corner_angle: 30\n",
                           "\n    acceleration: [0, 0, -9.81]\n", "\n  - type: stretch\n"})
    CHECK_THAT(config, Catch::Contains(line));
}

TEST_CASE("a metric that throws leaves a note, and the run continues") {
  const Scratch folder(replaced(small_experiment(), "[0.9, 0.9, 1]", "[0, 0, 1]"));
  CHECK_THAT(drape_with("check e.yaml", folder.path).err,
             Catch::Contains("\nerror: e.yaml:4:8: energy or forces at the start of level 0 are not "
                             "finite: energy neo_hookean is not, as triangle 0 (0, 1, 7) has no "
                             "area there; change the start\n"));
  const Ended ended =
      drape_ends("run e.yaml --out out --method all --threads 1 --quiet --no-report", folder, 1);
  CHECK_THAT(ended.err, Catch::StartsWith("warning: e.yaml:4:8: the start has 0 times the lengths"));
  std::istringstream lines(ended.err.substr(ended.err.find('\n') + 1));
  for (std::string line; std::getline(lines, line);)
    CHECK_THAT(line, Catch::StartsWith("metric ") && Catch::Contains(" was not measured: "));
  const nlohmann::json all = json_in(folder / "out/results.json");
  CHECK(all["complete"] == true);
  REQUIRE((keys(all["methods"]) == std::set<std::string>(methods.begin(), methods.end())));
  for (const auto& [name, method] : all["methods"].items()) {
    CHECK(method["status"] == "infeasible");
    CHECK(method["levels"][0]["message"] ==
          "energy or forces at the start are not finite: energy neo_hookean is not, as triangle 0 (0, 1, 7) "
          "has no area there; change the start");
    CHECK_THAT(method["consistency"][0]["not_measured"]["curvature_consistency"].get<std::string>(),
               Catch::StartsWith("curvature: the triangles around vertex 0 "));
  }
}

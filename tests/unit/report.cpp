#include "core/app/report/report.h"

#include <unistd.h>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/app/report/chart_data.h"
#include "core/app/report/pictures.h"
#include "core/app/report/tables.h"
#include "core/app/view/colours.h"
#include "core/app/view/html.h"
#include "core/kernel/files/file.h"
#include "core/kernel/interfaces/topology.h"
#include "core/kernel/threads/parallel.h"
#include "core/numerics/mesh_files/base64.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/declared_metrics.h"

using namespace drape;
namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

namespace {

/// The 1→4 split at midpoints, numbered as Refinement is.
TriangleMesh split(const TriangleMesh& coarse) {
  const int n = static_cast<int>(coarse.vertices.rows());
  const Topology topology = Topology::of(coarse.triangles, n);
  TriangleMesh fine{Positions(n + topology.edges.rows(), 3), Triangles(4 * coarse.triangles.rows(), 3)};
  fine.vertices.topRows(n) = coarse.vertices;
  for (int e = 0; e < topology.edges.rows(); ++e) {
    fine.vertices.row(n + e) =
        (coarse.vertices.row(topology.edges(e, 0)) + coarse.vertices.row(topology.edges(e, 1))) / 2;
  }
  for (int t = 0; t < coarse.triangles.rows(); ++t) {
    const auto v = coarse.triangles.row(t);
    const Eigen::RowVector3i m = topology.triangle_edges.row(t).array() + n;
    fine.triangles.row(4 * t) << v[0], m[2], m[1];
    fine.triangles.row(4 * t + 1) << v[1], m[0], m[2];
    fine.triangles.row(4 * t + 2) << v[2], m[1], m[0];
    fine.triangles.row(4 * t + 3) = m;
  }
  return fine;
}

Positions rippled(const Positions& rest, double waves) {
  Positions x = rest;
  x.col(2) = 0.08 * (waves * rest.col(0).array()).sin();
  return x;
}

Eigen::VectorXd ripple_curvature(const Positions& rest, double waves) {
  return -0.08 * waves * waves * (waves * rest.col(0).array()).sin();
}

constexpr int small_pictures = 300;  // pixels wide, in a ninth of the default's time

/// A run of two methods on two levels, in a folder of its own that goes with it.
struct SampleRun {
  // By process, so that several runs of the tests on one machine keep apart.
  fs::path folder = fs::temp_directory_path() / ("drape_report_test_" + std::to_string(::getpid()));
  Json results;

  SampleRun() {
    fs::remove_all(folder);
    for (const char* name : {"levels", "fields", "rest"}) fs::create_directories(folder / name);
    const TriangleMesh rest[2] = {grid({1, 1}, 13, 13, Diagonals::one_way),
                                  split(grid({1, 1}, 13, 13, Diagonals::one_way))};
    for (int l = 0; l < 2; ++l) write_ply(folder / "rest" / ("l" + std::to_string(l) + ".ply"), rest[l]);
    results = {{"experiment", "sample"},
               {"description", "A rippled sheet."},
               {"complete", true},
               {"machine", {{"cpu", "test processor"}, {"cores", 2}, {"threads", 1}}},
               {"version", "drape 0.0.0"},
               {"tolerance", {{"force_residual", 1e-3}}},
               {"metrics", json_of(sample_metrics())}};
    std::string steps =
        "method,level,step,iteration,seconds,energy,decrement,force_residual,step_length,proxy_energy,step_"
        "size\n";
    for (const std::string method : {"newton", "pcs"}) {
      const double waves[2] = {20, method == "pcs" ? 20.0 : 11.0};
      Json& entry = results["methods"][method];
      entry = {{"status", "converged"}, {"seconds", 12.345}, {"peak_memory_bytes", 123456789}};
      for (int l = 0; l < 2; ++l) {
        const std::string mesh = "levels/" + method + "_l" + std::to_string(l) + ".ply";
        write_ply(folder / mesh, {rippled(rest[l].vertices, waves[l]), rest[l].triangles});
        entry["levels"].push_back({{"level", l},
                                   {"vertices", rest[l].vertices.rows()},
                                   {"triangles", rest[l].triangles.rows()},
                                   {"status", "converged"},
                                   {"steps", 17},
                                   {"iterations", 1234},
                                   {"seconds", 6.1},
                                   {"seconds_by_phase", {{"factorise", 3.5}, {"assemble", 1.5}}},
                                   {"energy", -0.7654 - l},
                                   {"energy_released", method == "pcs" ? 1.7654 : 1.5432},
                                   {"force_residual", 8.76e-4},
                                   {"largest_stretch", 1.0432},
                                   {"intersections", nullptr},
                                   {"energy_parts_released", {{"membrane", -0.4321}, {"gravity", 2.345}}},
                                   {"mesh", mesh}});
        for (int k = 0; k < 3; ++k) {
          steps += method + "," + std::to_string(l) + "," + std::to_string(k) + ",0," +
                   std::to_string(k + 1) + "," + std::to_string(1.0 / (1 << k)) + ",0.1," +
                   std::to_string(0.5 / (k + 1)) + ",1,,0.5\n";
        }
      }
      const std::string fields = "fields/" + method + "_l0_l1.ply";
      const Eigen::VectorXd coarse = ripple_curvature(rest[1].vertices, waves[0]);
      const Eigen::VectorXd fine = ripple_curvature(rest[1].vertices, waves[1]);
      write_ply(folder / fields, {rippled(rest[1].vertices, waves[1]), rest[1].triangles},
                {{"H_difference", (coarse - fine) / 2},
                 {"principal_curvature", fine},
                 {"principal_curvature_other", coarse}});
      const double factor = method == "pcs" ? 1 : 10;
      entry["consistency"].push_back({{"coarse", 0},
                                      {"fine", 1},
                                      {"d_H_fit", 13.57 * factor},
                                      {"d_H_ddg", 24.68 * factor},
                                      {"d_K_fit", 31415.9 * factor},
                                      {"d_K_ddg", 27182.8 * factor},
                                      {"distance_rms", 0.0123},
                                      {"fields", fields}});
    }
    write_file(folder / "iterations.csv", steps);
    write_file(folder / "config.yaml", "cloth: {size: 1 m}\n");
  }
  ~SampleRun() { fs::remove_all(folder); }

  /// The page without Chart.js and the script, after writing the report.
  std::string page(bool with_pictures = false, std::optional<int> width = small_pictures) const {
    write_file(folder / "results.json", results.dump());
    write_report(
        folder, [&] { return !with_pictures; }, width);
    const std::string text = read_file(folder / "report.html");
    const std::size_t scripts = text.find("<script>");
    REQUIRE(scripts != std::string::npos);
    return text.substr(0, scripts);
  }
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// The page without its pictures' bytes, in which any short word may turn up.
std::string visible_words(std::string page) {
  for (std::size_t at = page.find("base64,"); at != std::string::npos; at = page.find("base64,", at)) {
    at += 7;
    page.erase(at, page.find('"', at) - at);
  }
  return page;
}

int occurrences(const std::string& text, const std::string& part) {
  int count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// Standard deviation of the brightness in the picture's middle.
double contrast(const Image& image) {
  double sum = 0, squares = 0;
  int count = 0;
  for (int y = image.height / 3; y < 2 * image.height / 3; ++y) {
    for (int x = image.width / 3; x < 2 * image.width / 3; ++x) {
      const double value = image.pixels[3 * (std::size_t(y) * image.width + x) + 1];
      sum += value, squares += value * value, ++count;
    }
  }
  return std::sqrt(squares / count - sum / count * sum / count);
}

}  // namespace

TEST_CASE("a report holds the figures of its run") {
  const SampleRun run;
  const std::string page = run.page(true, {});

  CHECK(contains(page, "2 of 2 methods converged"));
  CHECK(contains(page, "<b>pcs</b> ends with the lowest energy (it released 1.77 J, newton 0.222 J less)"));
  CHECK(contains(page, "<b>pcs</b> changes its mean curvature least"));
  CHECK(contains(page, "<td>12.3</td>"));                               // seconds
  CHECK(contains(page, "<td>2\u202f468</td>"));                         // iterations, both levels
  CHECK(contains(page, "<td>8.76e-4</td>"));                            // force residual
  CHECK(contains(page, "<td>123 MB</td>"));                             // peak memory
  CHECK(contains(page, "<td><strong>13.6</strong></td><td>136</td>"));  // pcs leads, the lower is bold
  CHECK(contains(page, "<td><strong>2.72e4</strong></td><td>2.72e5</td>"));
  CHECK(contains(page, "-0.4321"));  // what a part of the energy released, in a plot
  CHECK(contains(page, "<th data-column=\"largest_stretch\">largest stretch</th>"));
  CHECK(contains(page, "<td>1.0432</td>"));
  CHECK(contains(page, "d<sub>H</sub> is of mean curvature."));
  CHECK(contains(page, "cloth: {size: 1 m}"));
  CHECK(contains(page, "169 vertices"));
  const std::string words = visible_words(page);
  CHECK(words.size() < page.size() / 2);
  for (const char* bad : {"NaN", ">nan", ">inf", "-inf", "{{", "}}\n", "http:", "https:"}) {
    INFO(bad);
    CHECK_FALSE(contains(words, bad));
  }
  CHECK(contains(read_file(run.folder / "report.html"), "Chart.js v3"));
  CHECK(fs::file_size(run.folder / "report.html") < 25'000'000);
}

TEST_CASE("a report that is told to stop skips the remaining pictures, with a note") {
  const SampleRun run;
  write_file(run.folder / "results.json", run.results.dump());
  int asked = 0;
  constexpr int most = 3 * 29 * 22;  // a picture of 900×700 asks twice for each of its 29×22 tiles
  const auto cancelled = [&] { return ++asked > most; };
  set_thread_count(1);  // the thread that draws asks; helpers would take tiles from it
  const PictureSet set = draw_pictures(read_run(run.folder), cancelled);
  set_thread_count(0);
  CHECK(set.pictures.size() == 1);
  CHECK(asked == most + 1);
  REQUIRE(set.notes.size() == 1);
  CHECK_THAT(set.notes.front(), Catch::Contains("drape report " + run.folder.string()));
}

TEST_CASE("the pictures of a report are drawn, stored and inlined") {
  const SampleRun run;
  const std::string page = run.page(true);
  const PictureSet set = draw_pictures(read_run(run.folder), {}, small_pictures);
  CHECK(set.notes.empty());
  REQUIRE(set.fields.size() == 2);
  CHECK(set.fields[0].on_rest);
  CHECK(set.fields[0].scale > 10);
  CHECK(contains(page,
                 "<h2>Where the curvature changes</h2>\n<p>Difference in mean curvature. Drawn on the flat "
                 "rest shape."));
  CHECK(contains(page, "<b>pcs</b>, level 0 to 1: d<sub>H</sub><sup>fit</sup> = 13.6"));
  REQUIRE(set.pictures.size() == 2 * (2 + 1 + 1 + 2));
  CHECK(set.find("pcs_l0.png")->image.width == 300);
  CHECK(set.find("pcs_l0.png")->image.height == 233);
  for (const auto& [name, picture] : set.pictures) {
    INFO(name);
    const std::string file = read_file(run.folder / "pictures" / name);
    CHECK(file.substr(1, 3) == "PNG");
    CHECK(contains(page, base64(file)));
    // PCS keeps its ripples, so its difference is one colour all over.
    if (name == "pcs_l0_l1_H_difference.png") {
      CHECK(contrast(picture.image) < 1);
    } else {
      CHECK(contrast(picture.image) > 5);
    }
  }
  CHECK(occurrences(page, "<img width") == 12);
  CHECK(contains(page, "<b>pcs</b>, level 1, with the outline of level 0"));
  CHECK(occurrences(page, "alt=\"\"") == 0);
  const auto pixels = [&set](const char* name) { return set.find(name)->image.pixels; };
  CHECK(pixels("pcs_l1.png") == pixels("pcs_l1.png"));
  CHECK(pixels("pcs_l1.png") != pixels("newton_l1.png"));
  CHECK(pixels("pcs_l1.png") != pixels("pcs_l0_on_l1.png"));
  CHECK(pixels("pcs_l1.png") != pixels("pcs_l1_folds.png"));
}

TEST_CASE("a report of a partial run has dashes and sentences instead") {
  SampleRun run;
  Json& newton = run.results["methods"]["newton"];

  SECTION("a method that has just started") {
    run.results["complete"] = false;
    newton = {{"status", "running"}};
    const std::string page = run.page(true);
    CHECK(contains(page, "The run is not complete"));
    CHECK(contains(page, "1 of 2 methods converged"));
    CHECK(contains(page, "no picture"));
    CHECK(contains(page, "<td>–</td>"));
  }
  SECTION("null figures and missing keys") {
    for (auto& [key, value] : newton["levels"][1].items()) {
      if (key != "level") value = nullptr;
    }
    newton["consistency"][0]["d_H_fit"] = nullptr;
    newton["levels"][0].erase("energy_parts_released");
    newton["seconds"] = std::nan("");
    const std::string page = run.page();
    CHECK(contains(page, "<td>13.6</td><td>–</td>"));  // nothing to compare with: not bold
    CHECK_FALSE(contains(visible_words(page), "NaN"));
  }
  SECTION("no fields, steps, configuration and rest shapes") {
    for (const char* name : {"fields", "rest", "levels", "iterations.csv", "config.yaml"})
      fs::remove_all(run.folder / name);
    const std::string page = run.page(true);
    CHECK(occurrences(page, "No field was stored for these pictures in this run.") == 2);
    CHECK(contains(page, "config.yaml was not stored."));
    CHECK_FALSE(contains(page, "<img width"));
  }
  SECTION("nothing but a name") {
    run.results = {{"experiment", "early"}};
    CHECK(contains(run.page(), "holds no method's results yet"));
  }
  SECTION("a mesh cut short and one with holes in its numbers") {
    fs::resize_file(run.folder / "levels/newton_l1.ply",
                    fs::file_size(run.folder / "levels/newton_l1.ply") / 2);
    TriangleMesh mesh = read_mesh(run.folder / "levels/pcs_l1.ply");
    mesh.vertices(5, 1) = std::nan("");
    write_ply(run.folder / "levels/pcs_l1.ply", mesh);
    const std::string page = run.page(true);
    CHECK(contains(page, "newton_l1.ply"));
    CHECK(contains(page, "pcs_l1.ply: vertex 5 (counted from 0) has a coordinate that is not finite"));
    CHECK(contains(page, "Not drawn"));
    const PictureSet pictures = draw_pictures(read_run(run.folder), {}, small_pictures);
    CHECK(pictures.find("pcs_l1.png") == nullptr);
    CHECK(pictures.find("pcs_l0_on_l1.png") == nullptr);
    REQUIRE(pictures.find("pcs_l0.png"));
    CHECK(contrast(pictures.find("pcs_l0.png")->image) > 5);
  }
  SECTION("a last line of steps cut off") {
    write_file(run.folder / "iterations.csv", read_file(run.folder / "iterations.csv") + "pcs,1,9");
    run.page();
    const RunData data = read_run(run.folder);
    REQUIRE(data.iterations.size() == 4);
    CHECK(data.iterations[1].method == "pcs");
    CHECK(data.iterations[1].rows.size() == 3);
  }
}

TEST_CASE("names in a report cannot break the page or leave its folder") {
  SampleRun run;
  const std::string evil = "../<b>\"x'</script>&";
  run.results["experiment"] = evil;
  run.results["description"] = evil;
  run.results["methods"][evil] = run.results["methods"]["pcs"];
  run.results["methods"][evil]["status"] = evil;
  run.results["methods"][evil]["levels"][0]["energy_parts_released"][evil] = 1;
  write_file(run.folder / "config.yaml", "# " + evil);
  const std::string page = run.page(true);
  CHECK_FALSE(contains(page, evil));
  CHECK_FALSE(contains(page, "<b>\""));
  CHECK(contains(page, "<h1>../&lt;b&gt;&quot;x&#39;&lt;/script&gt;&amp;</h1>"));
  CHECK(fs::exists(run.folder / "pictures" / "..__b__x___script___l0.png"));
  CHECK_FALSE(contains(chart_data(read_run(run.folder)), "<"));
}

TEST_CASE("methods of different names have different pictures") {
  const auto pictures = [](const std::string& name) {
    MethodRecord method;
    method.name = name;
    MetricPicture metric;
    metric.name = "folds";
    ConsistencyRecord pair;
    pair.fine = 1;
    return std::vector<std::string>{state_picture(method, 0), outline_picture(method, {0, 1}),
                                    threshold_picture(metric, method, 0),
                                    difference_picture(metric, method, pair)};
  };
  CHECK(pictures("a.b")[0] == "a.b_l0.png");
  const std::vector<std::string> names = {"a.b", "a_b", "a-b", "方法一", "方法二"};
  for (const std::string& a : names)
    for (const std::string& b : names)
      for (std::size_t k = 0; k < 4; ++k) CHECK((pictures(a)[k] == pictures(b)[k]) == (a == b));
}

TEST_CASE("a report needs results.json") {
  const SampleRun run;
  CHECK_THROWS_WITH(write_report(run.folder), Catch::Contains("no results.json"));
  write_file(run.folder / "results.json", "{\"experiment\": ");
  CHECK_THROWS_WITH(write_report(run.folder), Catch::Contains("not a JSON object"));
  CHECK_FALSE(fs::exists(run.folder / "report.html"));
}

TEST_CASE("chart data compares energies of one level only, and never the proxy with the plain energy") {
  SampleRun run;
  run.results["methods"]["pcs"]["levels"][0]["level"] = 0;
  write_file(run.folder / "results.json", run.results.dump());
  write_file(run.folder / "iterations.csv",
             "method,level,step,iteration,seconds,energy,decrement,force_residual,step_length,proxy_energy\n"
             "pcs,0,0,0,1,5,1,1,1,-9\npcs,0,1,0,2,4,1,0.1,1,-10\n"
             "pcs,1,0,0,3,2,1,1,1,\npcs,1,1,0,4,1,1,0.1,1,\n"
             "newton,1,0,0,3,3,1,1,1,\nnewton,1,1,0,4,1.5,1,0.1,1,\nnewton,0,0,0,1,7,1,1,1,\n");
  const Json data = Json::parse(chart_data(read_run(run.folder)));
  REQUIRE(data["series"].size() == 4);
  CHECK(data["series"][0]["gap"] == Json({1, 0}));
  CHECK(data["series"][1]["gap"] == Json({1, 0}));
  CHECK(data["series"][2]["gap"] == Json::array({0}));
  CHECK(data["series"][3]["gap"] == Json({2, 0.5}));
  CHECK(data["series"][3]["force_residual"] == Json({1, 0.1}));
  CHECK(data["phases"]["values"][0] == Json({3.5, 3.5, 3.5, 3.5}));
  CHECK(data["tolerance"] == 1e-3);
}

TEST_CASE("a report has plots of load increments if there is a schedule") {
  SampleRun run;
  CHECK_FALSE(contains(run.page(), "id=\"load-stepping\""));
  Json& increments = run.results["methods"]["pcs"]["increments"];
  for (const int level : {1, 0})
    for (const double time : {0.5, 1.0})
      increments.push_back(
          {{"level", level}, {"time", time}, {"steps", 10 * time}, {"energy_released", time}});
  const std::string page = run.page();
  CHECK(contains(page, "id=\"load-stepping\""));
  CHECK(contains(page, "id=\"increment-energy\""));
  const Json data = Json::parse(chart_data(read_run(run.folder)))["increments"];
  REQUIRE(data.size() == 2);
  CHECK(data[0]["level"] == 0);
  CHECK(data[1]["level"] == 1);
  CHECK(data[1]["time"] == Json({0.5, 1}));
  CHECK(data[1]["steps"] == Json({5, 10}));
  CHECK(data[1]["energy_released"] == Json({0.5, 1}));
}

TEST_CASE("figures in a report have three digits") {
  const std::pair<double, const char*> cases[] = {
      {0, "0"},         {403.4, "403"},     {9999, "1.00e4"},   {1234, "1230"},    {0.02134, "0.0213"},
      {0.9996, "1.00"}, {7.21e5, "7.21e5"}, {-1.2345, "-1.23"}, {4e-4, "4.00e-4"}, {99.96, "100"}};
  for (const auto& [value, text] : cases) CHECK(html::number_text(value) == text);
  CHECK(html::number_text({}) == "–");
  CHECK(html::count(1234567) == "1\u202f234\u202f567");
  CHECK(html::count(123) == "123");
  CHECK(html::bytes(2.5e9) == "2.50 GB");
  CHECK(base64("light work.") == "bGlnaHQgd29yay4=");
  CHECK(base64("light wor") == "bGlnaHQgd29y");
  CHECK(base64("light wo") == "bGlnaHQgd28=");
  CHECK_THROWS_WITH(html::fill("a {{b}} c", {}), Catch::Contains("{{b}}"));
}

TEST_CASE("colour maps are symmetric around their middle and clamp at their ends") {
  Eigen::VectorXd v(5);
  v << 0, 1, 5, -1, std::nan("");
  const Colours map = diverging_colours(v, 1);
  CHECK(map.row(0).minCoeff() > 0.95f);
  CHECK(map.row(1) == map.row(2));
  CHECK(map.row(1)[0] > map.row(1)[2]);
  CHECK(map.row(3)[2] > map.row(3)[0]);
  CHECK(map.allFinite());
  const Colours folds = fold_colours(v, 2);
  CHECK(folds.row(0) == folds.row(1));
  CHECK(folds.row(2) != folds.row(0));
  const Eigen::VectorXd ramp = Eigen::VectorXd::LinSpaced(101, -100, 0);
  CHECK(magnitude_quantile({&ramp, &v}, 1) == 100);
  CHECK(magnitude_quantile({&ramp}, 0.5) == 50);
  CHECK(magnitude_quantile({}, 0.5) == 0);
}

TEST_CASE("errors are read, drawn and described; a run without them says so") {
  SampleRun run;
  CHECK(contains(run.page(), "No states were recorded in this run"));
  write_file(run.folder / "errors.csv",
             "method,level,iteration,seconds,iterations,flops,vertices,own_rms,own_hausdorff,own_d_H_fit,"
             "own_energy_gap,reference_rms,reference_hausdorff,reference_d_H_fit,reference_energy_gap\n"
             "newton,0,2,1.5,2,1e8,169,0.5,0.5,9,0.5,,,,\n"
             "newton,1,3,2.5,3,1e9,625,0,0,0,0,,,,\n"
             "pcs,0,3,0.5,3,1e6,169,0.25,0.5,7,0.125,0.3,0.6,8,-0.01\n"
             "pcs,1,9,0.7");  // cut short
  run.results["reference"] = {{"method", "newton"}, {"force_tolerance", 1e-5}};
  for (Json& level : run.results["methods"]["newton"]["levels"]) level["from_initial_state"] = true;
  CHECK(contains(run.page(),
                 "The reference is <b>newton</b>'s finest state, solved on to a force residual of 1.00e-5."));
  run.results["reference"] = {{"file", "fine & far.ply"}, {"mesh", "reference.ply"}};
  CHECK(contains(run.page(), "The reference is the file <code>fine &amp; far.ply</code>."));
  run.results["reference"] = {{"method", "newton"}, {"force_tolerance", 1e-5}};
  const RunData data = read_run(run.folder);
  REQUIRE(data.errors.size() == 3);
  CHECK(data.errors[0].method == "pcs");
  CHECK(data.errors[0].rows[0].cost[2].value() == 1e6);
  CHECK_FALSE(data.errors[0].rows[0].error[1].of("silhouette_mismatch"));  // the file has no such column
  CHECK(data.errors[0].rows[0].error[1].of("energy_gap").value() == -0.01);
  CHECK(!data.errors[2].rows[0].error[1].of("rms"));
  CHECK(Json::parse(chart_data(data))["measures"][0] ==
        Json{{"name", "rms"}, {"label", "distance, RMS [diagonal]"}});
  const Json drawn = Json::parse(chart_data(data))["errors"];
  REQUIRE(drawn.size() == 2);
  CHECK(drawn[1]["level"] == 1);  // the direct method's last state does not build on level 0
  CHECK(drawn[0]["own"]["rms"] == Json{0.25});
  CHECK(drawn[0]["seconds"] == Json{0.5});
  CHECK(drawn[1]["reference"]["rms"] == Json{nullptr});
}

TEST_CASE("every method has a verdict beside the others that converged") {
  RunData run;
  for (const char* name : {"pcs", "newton", "stuck"}) {
    MethodRecord& m = run.methods.emplace_back();
    m.name = name;
    m.status = m.name == "stuck" ? "stalled" : "converged";
    for (int l = 0; l < 2; ++l) {
      LevelRecord& level = m.levels.emplace_back();
      level.level = l;
      level.seconds = m.name == "pcs" ? 2 : 6;
      level.from_initial_state = m.name == "newton";
      level.energy_released = m.name == "pcs" ? 2 + l : 1 + 1.5 * l;
    }
  }
  CHECK(method_verdict(run, run.methods[0]) == "fastest; released the most energy; best preview");
  CHECK(method_verdict(run, run.methods[1]) == "1.50× the fastest's time; released 16.7&nbsp;% less energy");
  CHECK(method_verdict(run, run.methods[2]) == "did not converge; its figures are of where it stopped");
  run.force_tolerance = 0.001;
  CHECK(contains(outcome_sentence(run), "2 of 3 methods converged (force residual below 0.001); <b>pcs</b>"));

  run.methods[2].status = "converged_to_rounding";
  CHECK(method_verdict(run, run.methods[2]) == "3.00× the fastest's time; released 16.7&nbsp;% less energy");
  CHECK(contains(outcome_sentence(run),
                 "3 of 3 methods converged (force residual below 0.001, or as low as rounding allows)"));
}

TEST_CASE("the viewer has every state, and recorded snapshots that fit their mesh") {
  SampleRun run;
  const auto whole_page = [&] {
    run.page();
    return read_file(run.folder / "report.html");
  };
  const std::string page = whole_page();
  CHECK(contains(page, "id=\"viewer-m0l0\""));
  CHECK(contains(page, "id=\"viewer-m1l1-stretch\""));
  CHECK_FALSE(contains(page, "id=\"viewer-m0l0f0\""));

  fs::create_directories(run.folder / "snapshots");
  Json& level = run.results["methods"]["pcs"]["levels"][0];
  level["snapshots"] = {
      {"file", "snapshots/pcs_l0.bin"}, {"iterations", {1, 2, 3}}, {"seconds", {0.1, 0.2, 0.3}}};
  write_file(run.folder / "snapshots/pcs_l0.bin", std::string(3 * 169 * 12, '\0'));
  CHECK(contains(whole_page(), "id=\"viewer-m0l0f1\""));
  write_file(run.folder / "snapshots/pcs_l0.bin", std::string(100, '\0'));
  const std::string without = whole_page();
  CHECK_FALSE(contains(without, "id=\"viewer-m0l0f1\""));
  CHECK(contains(without, "id=\"viewer-m0l0\""));
  CHECK(contains(without, "snapshots/pcs_l0.bin: holds 100 bytes, not 3 snapshots of 169 vertices"));
}

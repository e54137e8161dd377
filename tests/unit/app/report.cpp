#include "core/app/report/report.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "core/app/report/pictures.h"
#include "core/app/report/run_table.h"
#include "core/kernel/files/file.h"
#include "core/kernel/threads/parallel.h"
#include "core/numerics/hierarchy/midpoint.h"
#include "core/numerics/mesh_files/base64.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"
#include "tests/support/declared_metrics.h"
#include "tests/support/page_data.h"

using namespace drape;
namespace fs = std::filesystem;

namespace {

Positions rippled(const Positions& rest, double waves) {
  Positions x = rest;
  x.col(2) = 0.08 * (waves * rest.col(0).array()).sin();
  return x;
}

constexpr int small_pictures = 300;  // pixels wide, in a ninth of the default's time

/// A run of two methods on two levels, in a folder of its own that goes with it.
struct SampleRun {
  Scratch scratch;
  const fs::path& folder = scratch.path;
  Json results{{"experiment", "sample"}, {"complete", true}, {"metrics", json_of(sample_metrics())}};

  SampleRun() {
    for (const char* name : {"levels", "fields", "rest"}) fs::create_directories(folder / name);
    const Level coarse = Level::of(0, grid({1, 1}, 13, 13, Diagonals::one_way));
    const TriangleMesh rest[] = {coarse.rest, refined_rest(coarse, midpoint_weights(coarse))};
    for (int l = 0; l < 2; ++l) write_mesh(folder / "rest" / ("l" + std::to_string(l) + ".ply"), rest[l]);
    std::string rows =
        "method,level,step,iteration,seconds,energy,decrement,force_residual,step_length,proxy_energy,step_"
        "size\n";
    for (const std::string method : {"newton", "pcs"}) {
      const double waves[2] = {20, method == "pcs" ? 20.0 : 11.0};
      Json& entry = results["methods"][method];
      entry = {{"status", "converged"}};
      for (int l = 0; l < 2; ++l) {
        const std::string mesh = "levels/" + method + "_l" + std::to_string(l) + ".ply";
        write_mesh(folder / mesh, {rippled(rest[l].vertices, waves[l]), rest[l].triangles});
        entry["levels"].push_back({{"level", l},
                                   {"vertices", rest[l].vertices.rows()},
                                   {"status", "converged"},
                                   {"iterations", 1234},
                                   {"seconds", 6.1},
                                   {"energy_released", method == "pcs" ? 1.7654 : 1.5432},
                                   {"energy_parts_released", {{"membrane", -0.4321}, {"gravity", 2.345}}},
                                   {"mesh", mesh}});
        for (const char* row : {"0,0,1,1,0.1,0.5", "1,0,2,0.5,0.1,0.25", "2,0,3,0.25,0.1,0.125"})
          rows += method + "," + std::to_string(l) + "," + row + ",1,,0.5\n";
      }
      const std::string fields = "fields/" + method + "_l0_l1.ply";
      write_file(folder / fields, ply_bytes(rest[1], {{"H_difference", rest[1].vertices.col(0)}}));
      entry["consistency"].push_back({{"coarse", 0}, {"fine", 1}, {"d_H_fit", 13.57}, {"fields", fields}});
    }
    scratch.write("iterations.csv", rows);
    scratch.write("config.yaml", "cloth: {size: 1 m}\n");
  }

  /// The page, after writing the report.
  std::string page(bool with_pictures = false, std::optional<int> width = small_pictures) const {
    scratch.write("results.json", results.dump());
    write_report(
        folder, [&] { return !with_pictures; }, width);
    return text_of(folder / "report.html");
  }
  Json data(bool with_pictures = false) const { return page_data(page(with_pictures)); }
};

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Standard deviation of the green in the picture's middle.
double contrast(const Image& image) {
  using Bytes = Eigen::Array<unsigned char, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const Bytes> bytes(image.pixels.data(), image.height, 3 * image.width);
  const int h = image.height / 3, w = image.width / 3;
  const Eigen::ArrayXXd green = bytes(Eigen::seqN(h, h), Eigen::seqN(3 * w + 1, w, 3)).cast<double>();
  return std::sqrt((green - green.mean()).square().mean());
}

}  // namespace

TEST_CASE("a report holds the figures of its run") {
  const SampleRun run;
  const std::string page = run.page(true, {});
  const Json data = page_data(page), rows = data["table"]["rows"];
  CHECK(data["kind"] == "run");
  CHECK(data["results"] == Json::parse(run.results.dump()));
  REQUIRE(rows.size() == 2);
  CHECK(rows[0]["method"] == "pcs");  // the progressive method comes first
  CHECK(rows[0]["iterations"] == 2468);
  CHECK(rows[0]["energy_released"] == 1.7654);
  CHECK(data["config"] == "cloth: {size: 1 m}\n");
  CHECK(data["iterations"]["rows"].size() == 12);
  CHECK(contains(page, "<title>sample – drape</title>"));
  for (const char* bad : {"{{", "}}\n", "src=\"http"}) {
    INFO(bad);
    CHECK_FALSE(contains(page.substr(0, page.find("<script>")), bad));
  }
  CHECK(page.size() < 8'000'000);
}

TEST_CASE("a report that is told to stop skips the remaining pictures, with a note") {
  const SampleRun run;
  run.scratch.write("results.json", run.results.dump());
  int asked = 0;
  constexpr int most = 3 * 700;  // a picture of 900×700 asks twice for each of its rows
  set_thread_count(1);           // the thread that draws asks; helpers would take rows from it
  const PictureSet set = draw_pictures(read_run(run.folder), [&] { return ++asked > most; });
  set_thread_count(0);
  CHECK(set.pictures.size() == 1);
  CHECK(asked == most + 1);
  REQUIRE(set.notes.size() == 1);
  CHECK_THAT(set.notes.front(), Catch::Contains("drape report " + run.folder.string()));
}

TEST_CASE("the pictures of a report are drawn, stored and inlined") {
  const SampleRun run;
  const Json pictures = run.data(true)["pictures"];
  const PictureSet set = draw_pictures(read_run(run.folder), {}, small_pictures);
  CHECK(set.notes.empty());
  REQUIRE(set.pictures.size() == 2 * (2 + 1));
  CHECK(set.pictures.at("pcs_l0.png").width == 300);
  CHECK(set.pictures.at("pcs_l0.png").height == 233);
  for (const auto& [name, picture] : set.pictures) {
    INFO(name);
    CHECK(text_of(run.folder / "pictures" / name).substr(1, 3) == "PNG");
    CHECK(contrast(picture) > 5);
  }
  REQUIRE(pictures.size() == 2);  // of each method, its end with the outline of its preview
  CHECK(pictures[0]["method"] == "pcs");
  CHECK(pictures[0]["png"] == base64(text_of(run.folder / "pictures/pcs_l0_on_l1.png")));
  CHECK((pictures[0]["coarse"] == 0 && pictures[0]["fine"] == 1));
  for (const char* other : {"newton_l1.png", "pcs_l0_on_l1.png"})
    CHECK(set.pictures.at("pcs_l1.png").pixels != set.pictures.at(other).pixels);
}

TEST_CASE("a report of a partial run has what there is") {
  SampleRun run;
  Json& newton = run.results["methods"]["newton"];

  SECTION("a method that has just started") {
    run.results["complete"] = false;
    newton = {{"status", "running"}};
    const Json data = run.data(true);
    CHECK(data["table"]["rows"][1]["status"] == "running");
    CHECK(data["table"]["rows"][1]["seconds"] == nullptr);
    CHECK(data["pictures"].size() == 1);
  }
  SECTION("null figures, missing keys and a last line of steps cut off") {
    for (auto& [key, value] : newton["levels"][1].items())
      if (key != "level") value = nullptr;
    newton["levels"][0].erase("energy_parts_released");
    newton["seconds"] = std::nan("");
    run.scratch.write("iterations.csv", text_of(run.folder / "iterations.csv") + "pcs,1,9");
    const Json data = run.data();
    CHECK(data["table"]["rows"][1]["energy_released"] == nullptr);
    CHECK(data["iterations"]["rows"].size() == 12);
  }
  SECTION("no fields, steps, configuration and rest shapes") {
    for (const char* name : {"fields", "rest", "levels", "iterations.csv", "config.yaml"})
      fs::remove_all(run.folder / name);
    const Json data = run.data(true);
    CHECK(data["config"] == "");
    CHECK((data["pictures"].empty() && data["iterations"]["rows"].empty()));
    CHECK(data["view"] == nullptr);
  }
  SECTION("no method yet") {
    run.results = {{"experiment", "early"}, {"methods", Json::object()}};
    CHECK(run.data()["results"] == run.results);
  }
  SECTION("a mesh cut short and one with holes in its numbers") {
    const fs::path cut = run.folder / "levels/newton_l1.ply", holed = run.folder / "levels/pcs_l1.ply";
    fs::resize_file(cut, fs::file_size(cut) / 2);
    TriangleMesh mesh = read_mesh(holed);
    mesh.vertices(5, 1) = std::nan("");
    write_mesh(holed, mesh);
    const std::string notes = run.data(true)["notes"].dump();
    CHECK(contains(notes, "newton_l1.ply"));
    CHECK(contains(notes, "pcs_l1.ply: vertex 5 (counted from 0) has a coordinate that is not finite"));
    const auto pictures = draw_pictures(read_run(run.folder), {}, small_pictures).pictures;
    CHECK_FALSE(pictures.contains("pcs_l1.png"));
    CHECK_FALSE(pictures.contains("pcs_l0_on_l1.png"));
    REQUIRE(pictures.contains("pcs_l0.png"));
    CHECK(contrast(pictures.at("pcs_l0.png")) > 5);
  }
}

TEST_CASE("names in a report cannot break the page or leave its folder, and have pictures of their own") {
  SampleRun run;
  const std::string evil = "../<b>\"x'</script>&";
  run.results["experiment"] = run.results["description"] = evil;
  run.results["methods"][evil] = run.results["methods"]["pcs"];
  run.results["methods"][evil]["status"] = evil;
  run.results["metrics"]["curvature"]["colours"][0]["field"] = evil;
  run.scratch.write("config.yaml", "# " + evil);
  const std::string page = run.page(true);
  CHECK_FALSE(contains(page, "<b>"));
  CHECK(contains(page, "<title>../&lt;b>\"x'&lt;/script>&amp; – drape</title>"));
  CHECK(page_data(page)["results"]["description"] == evil);
  CHECK(fs::exists(run.folder / "pictures" / "..__b__x___script___l0.png"));

  const auto picture_of = [](const std::string& name) {
    MethodRecord method;
    method.name = name;
    return std::pair(state_picture(method, 0), outline_picture(method, 0, 1));
  };
  CHECK(picture_of("a.b").first == "a.b_l0.png");
  std::set<std::string> names;
  for (const char* method : {"a.b", "a_b", "a-b", "方法一", "方法二"})
    names.merge(std::set{picture_of(method).first, picture_of(method).second});
  CHECK(names.size() == 10);
}

TEST_CASE("figures in a table have three digits") {
  const std::pair<double, const char*> cases[] = {{0, "0"},           {403.4, "403"},      {9999, "1.00e4"},
                                                  {1234, "1230"},     {0.02134, "0.0213"}, {0.9996, "1.00"},
                                                  {7.21e5, "7.21e5"}, {-1.2345, "-1.23"},  {4e-4, "4.00e-4"},
                                                  {4e-3, "0.00400"},  {99.96, "100"}};
  for (const auto& [value, text] : cases) CHECK(number_text(value) == text);
  CHECK(number_text({}) == "–");
}

TEST_CASE("errors are in the page, as far as their table goes") {
  const SampleRun run;
  CHECK(run.data()["errors"]["rows"].empty());
  run.scratch.write(
      "errors.csv",
      "method,level,iteration,seconds,iterations,flops,vertices,own_rms,own_hausdorff,own_d_H_fit,"
      "own_energy_gap,reference_rms,reference_hausdorff,reference_d_H_fit,reference_energy_gap\n"
      "newton,0,2,1.5,2,1e8,169,0.5,0.5,9,0.5,,,,\n"
      "pcs,0,3,0.5,3,1e6,169,0.25,0.5,7,0.125,0.3,0.6,8,-0.01\npcs,1,9,0.7");  // cut short
  const Json page = run.data(), errors = page["errors"];
  CHECK(page["measures"][0] ==
        Json{{"name", "rms"}, {"label", "distance, RMS [diagonal]"}, {"use", "ranking"}});
  CHECK(errors["names"][7] == "own_rms");
  REQUIRE(errors["rows"].size() == 2);
  CHECK(errors["rows"][1][7] == 0.25);
  CHECK(errors["rows"][0][11] == nullptr);
}

TEST_CASE("the viewer has every state, and recorded snapshots") {
  SampleRun run;
  fs::create_directories(run.folder / "snapshots");
  run.scratch.write("snapshots/pcs_l0.bin", std::string(3 * 169 * 12, '\0'));
  run.results["methods"]["pcs"]["levels"][0]["snapshots"] = {
      {"file", "snapshots/pcs_l0.bin"}, {"iterations", {1, 2, 3}}, {"seconds", {0.1, 0.2, 0.3}}};
  const std::string page = run.page();
  const Json methods = page_data(page)["view"]["methods"];
  const auto has_block = [&](const std::string& name) {
    return contains(page, "id=\"viewer-" + name + "\"");
  };
  CHECK(has_block("m0l0"));
  CHECK(has_block("m0l0f1"));
  CHECK_FALSE(has_block("m1l0f1"));
  CHECK(has_block(methods[1]["levels"][1]["states"][0]["fields"]["stretch"]));
  CHECK(has_block(methods[0]["levels"][0]["states"].back()["fields"]["H_difference"]));
}

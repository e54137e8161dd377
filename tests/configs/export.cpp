// `drape export` and `drape view`: what they write is read again.

#include <catch2/catch.hpp>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"
#include "tests/support/glb.h"

using namespace drape;
namespace fs = std::filesystem;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;

namespace {

/// A cloth of two levels on a ball, by two methods, run once for all cases.
const fs::path& finished_run() {
  static const Scratch folder;
  static const fs::path path = [] {
    folder.write("e.yaml", experiment_of_tests("contact"));
    drape_ends("run e.yaml -o out -j 1 -q --no-report --method pcs,newton", folder);
    return folder / "out";
  }();
  return path;
}

/// What the command writes into a file of that name.
std::string exported(const std::string& name, const std::string& options = "") {
  const Scratch folder;
  const Ended ended =
      drape_ends("export " + finished_run().string() + " --to " + name + " " + options, folder);
  CHECK(ended.out == "written: " + name + "\n");
  return text_of(folder / name);
}

std::string export_refusal(const std::string& arguments) {
  const Scratch folder;
  const std::string said = refused_by("export " + arguments, folder.path);
  CHECK(fs::is_empty(folder.path));
  return said;
}

/// Width and height [pixels], from the header.
std::pair<int, int> size_of_png(const std::string& bytes) {
  REQUIRE(bytes.size() > 24);
  CHECK(bytes.substr(1, 3) == "PNG");
  const auto number = [&](std::size_t at) {
    int value = 0;
    for (std::size_t k = at; k < at + 4; ++k) value = 256 * value + static_cast<unsigned char>(bytes[k]);
    return value;
  };
  return {number(16), number(20)};
}

/// The name of picture k of film.png.
std::string film_picture(std::size_t k) {
  char name[32];
  std::snprintf(name, sizeof name, "film_%04zu.png", k);
  return name;
}

/// The largest difference of the accessor's vertices, in glTF's axes, and the mesh's [m].
double difference(const Glb& glb, int accessor, const Positions& x) {
  const std::vector<float> floats = glb.floats(accessor);
  REQUIRE(floats.size() == static_cast<std::size_t>(x.size()));
  double most = 0;
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    most = std::max({most, std::abs(floats[3 * i] - x(i, 0)), std::abs(floats[3 * i + 1] - x(i, 2)),
                     std::abs(floats[3 * i + 2] + x(i, 1))});
  return most;
}

}  // namespace

TEST_CASE("a .glb has every level of a method as a scene, with the obstacle, and opens on the finest") {
  const Glb glb(exported("out.glb"));
  REQUIRE(glb.json.at("scenes").size() == 2);
  CHECK(glb.json.at("scene") == 1);
  for (int level = 0; level < 2; ++level) {
    const auto& scene = glb.json["scenes"][level];
    INFO(scene);
    CHECK(scene.at("name") == "level " + std::to_string(level));
    REQUIRE(scene.at("nodes").size() == 2);
    const auto& stone = glb.json.at("nodes").at(scene["nodes"][0].get<int>());
    const auto& cloth = glb.json["nodes"].at(scene["nodes"][1].get<int>());
    CHECK(stone.at("name") == "ball");
    CHECK(cloth.at("name") == "contact level " + std::to_string(level));
    for (const auto& node : {stone, cloth})
      CHECK(glb.json.at("meshes").at(node.at("mesh").get<int>()).at("name") == node.at("name"));
    const auto& primitive = glb.json.at("meshes").at(cloth.at("mesh").get<int>()).at("primitives").at(0);
    const std::string name = "l" + std::to_string(level) + ".ply";
    const TriangleMesh state = read_mesh(finished_run() / ("levels/pcs_" + name)),
                       rest = read_mesh(finished_run() / ("rest/" + name));
    CHECK(difference(glb, primitive["attributes"]["POSITION"], state.vertices) < 1e-6);
    CHECK(glb.indices(primitive["indices"]).size() == static_cast<std::size_t>(state.triangles.size()));
    const std::vector<float> uv = glb.floats(primitive["attributes"]["TEXCOORD_0"]);
    const std::vector<float> normals = glb.floats(primitive["attributes"]["NORMAL"]);
    for (Eigen::Index i = 0; i < rest.vertices.rows(); ++i) {
      CHECK(uv[2 * i] == Approx(rest.vertices(i, 0) / 0.4).margin(1e-6));
      CHECK(1 - uv[2 * i + 1] == Approx(rest.vertices(i, 1) / 0.4).margin(1e-6));
      CHECK(std::hypot(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]) == Approx(1).epsilon(1e-5));
    }
    const auto& ball = glb.json["meshes"].at(stone.at("mesh").get<int>()).at("primitives").at(0);
    CHECK(difference(glb, ball["attributes"]["POSITION"],
                     read_mesh(finished_run() / "obstacles/0.ply").vertices) < 1e-6);
  }
  const Glb one(exported("one.glb", "--level 0 --method newton"));
  REQUIRE(one.json["scenes"].size() == 1);
  CHECK(one.json["nodes"][1]["name"] == "contact level 0");
  CHECK(difference(one, one.json["meshes"][1]["primitives"][0]["attributes"]["POSITION"],
                   read_mesh(finished_run() / "levels/newton_l0.ply").vertices) < 1e-6);
}

TEST_CASE("with --frames a .glb has the recorded snapshots of one level as an animation") {
  const nlohmann::json results = json_in(finished_run() / "results.json");
  for (const std::string options : {"--frames", "--frames --level 0"}) {
    INFO(options);
    const int level = options == "--frames" ? 1 : 0;
    const std::size_t recorded = results["methods"]["pcs"]["levels"][level]["snapshots"]["iterations"].size();
    REQUIRE(recorded > 2);
    const Glb glb(exported("out.glb", options));
    REQUIRE(glb.json["scenes"].size() == 1);
    const auto& mesh = glb.json["meshes"][1];
    CHECK(mesh["name"] == "contact level " + std::to_string(level));
    CHECK(mesh["primitives"][0]["targets"].size() == recorded - 1);
    REQUIRE(glb.json.at("animations").size() == 1);
    CHECK(glb.json["animations"][0]["channels"][0]["target"]["node"] == 1);
    const auto& sampler = glb.json["animations"][0]["samplers"][0];
    CHECK(glb.floats(sampler["input"]).size() == recorded);
    CHECK(glb.floats(sampler["output"]).size() == recorded * (recorded - 1));
  }
}

TEST_CASE("an animation of a level of one step is refused with the levels that have more") {
  const Scratch folder;
  fs::copy(finished_run(), folder / "run", fs::copy_options::recursive);
  nlohmann::json results = json_in(folder / "run/results.json");
  nlohmann::json& level = results["methods"]["pcs"]["levels"][1];
  level["iterations"] = 1;
  const nlohmann::json all = level["snapshots"];
  const auto refusal = [&] {
    folder.write("run/results.json", results.dump());
    return refused_by("export run --to a.glb --frames", folder.path);
  };
  for (const char* list : {"iterations", "seconds"}) level["snapshots"][list] = nlohmann::json::array({0});
  level["snapshots"].erase("checksum");
  const std::string states = text_of(folder / "run" / all["file"].get<std::string>());
  folder.write("run/" + all["file"].get<std::string>(),
               states.substr(0, states.size() / all["seconds"].size()));
  CHECK(
      refusal() ==
      "error: --frames: level 1 of pcs took no more than one iteration, so it has no state before its last; "
      "choose --level 0\n");
  level["iterations"] = 7;  // of an experiment with snapshots: 1
  CHECK(
      refusal() ==
      "error: --frames: the run has only the last state of level 1; run the experiment with snapshots: 8\n");
  level["snapshots"] = nullptr;
  CHECK(refusal() ==
        "error: --frames: the run has no snapshots of level 1; run the experiment with snapshots: 8\n");
}

TEST_CASE("the other formats have the cloth of the finest level, or of the one that is named") {
  const Scratch folder;
  for (const std::string extension : {".obj", ".ply"})
    for (const int level : {0, 1}) {
      INFO(extension << " of level " << level);
      folder.write("out" + extension, exported("out" + extension, level == 1 ? "" : "--level 0"));
      const TriangleMesh mesh = read_mesh(folder / ("out" + extension)),
                         state =
                             read_mesh(finished_run() / ("levels/pcs_l" + std::to_string(level) + ".ply"));
      CHECK((mesh.vertices == state.vertices));
      CHECK((mesh.triangles == state.triangles));
    }
  for (const std::string name : {"out.vtp", "out.VTP"})
    CHECK((exported(name) == text_of(finished_run() / "levels/pcs_l1.vtp")));
  CHECK((exported("out.GLB") == exported("out.glb")));
}

TEST_CASE("texture coordinates of the cloth's file reach every export, seams included") {
  const Scratch folder;
  // Upright, in the plane y = 0, with a seam in the middle and a mirrored right half.
  const double side = 0.4;
  const auto expected = [&](const TriangleMesh& rest, Eigen::Index t, int k) {
    const auto corner = [&](int i) { return rest.vertices.row(rest.triangles(t, i)); };
    const bool left = (corner(0).x() + corner(1).x() + corner(2).x()) / 3 < side / 2;
    const double x = corner(k).x(), z = corner(k).z();
    return Eigen::RowVector2d((left ? x : side - x) / side, z / side + (left ? 0 : 0.25));
  };
  TriangleMesh cloth = grid({side, side}, 9, 9, Diagonals::one_way);
  cloth.vertices.col(1).swap(cloth.vertices.col(2));
  cloth.uv.resize(cloth.triangles.rows(), 6);
  for (Eigen::Index t = 0; t < cloth.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) cloth.uv.block<1, 2>(t, 2 * k) = expected(cloth, t, k);
  write_mesh(folder / "upright.obj", cloth);
  folder.write("e.yaml",
               "name: banner\ncloth: {shape: file, file: upright.obj}\nlevels: 3\n"
               "pins: [{region: box, lower: [-1, -1, 0.399], upper: [1, 1, 1]}]\n"
               "energies: [neo_hookean, hinge, gravity]\nrefiner: midpoint\n"
               "newton: {force_tolerance: 1}\nmethods: {pcs: {}}\n");
  drape_ends("run e.yaml -o out -j 1 -q --no-report", folder);
  const auto exported_to = [&](const std::string& name) {
    drape_ends("export out --to " + name, folder);
    return folder / name;
  };
  const TriangleMesh rest = read_mesh(folder / "out/rest/l2.ply");
  double most = 0;
  for (const std::string name : {"out.obj", "out.ply"}) {
    const TriangleMesh mesh = read_mesh(exported_to(name));
    CHECK((mesh.vertices == read_mesh(folder / "out/levels/pcs_l2.ply").vertices));
    REQUIRE(mesh.uv.rows() == rest.triangles.rows());
    for (Eigen::Index t = 0; t < mesh.uv.rows(); ++t)
      for (int k = 0; k < 3; ++k)
        most = std::max(most, (mesh.uv.block<1, 2>(t, 2 * k) - expected(rest, t, k)).norm());
  }
  CHECK(most < 2e-6);
  const Glb glb(text_of(exported_to("out.glb")));
  const auto& primitive = glb.json["meshes"][2]["primitives"][0];
  CHECK(glb.json["meshes"][2]["name"] == "banner level 2");
  const std::vector<float> uv = glb.floats(primitive["attributes"]["TEXCOORD_0"]),
                           x = glb.floats(primitive["attributes"]["POSITION"]);
  const std::vector<std::uint32_t> corners = glb.indices(primitive["indices"]);
  const Positions state = read_mesh(folder / "out/levels/pcs_l2.ply").vertices;
  CHECK(x.size() == static_cast<std::size_t>(state.size()) + 3 * 33);  // a seam of 32 edges
  REQUIRE(corners.size() == static_cast<std::size_t>(rest.triangles.size()));
  for (Eigen::Index t = 0; t < rest.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const std::size_t c = corners[3 * t + k];
      const Eigen::RowVector2d here(uv[2 * c], 1 - uv[2 * c + 1]);
      most = std::max(most, (here - expected(rest, t, k)).norm());
      const auto p = state.row(rest.triangles(t, k));
      most = std::max({most, std::abs(x[3 * c] - p.x()), std::abs(x[3 * c + 1] - p.z())});
    }
  CHECK(most < 2e-6);

  // The results folder's experiment reads rest/l0.ply: the same again.
  drape_ends("run out/config.yaml -o again -j 1 -q --no-report", folder);
  for (const std::string name : {"rest/l0.ply", "rest/l2.ply", "levels/pcs_l2.ply"})
    CHECK((text_of(folder / ("again/" + name)) == text_of(folder / ("out/" + name))));
}

TEST_CASE("a .png is the report's picture of a state, at any width") {
  const Scratch folder;
  fs::copy(finished_run(), folder / "run", fs::copy_options::recursive);
  drape_ends("report run --width 300", folder);
  const auto reported = [&](const std::string& name) { return text_of(folder / ("run/pictures/" + name)); };
  CHECK((exported("a.png", "--width 300") == reported("pcs_l1.png")));
  CHECK((exported("a.png", "--width 300 --level 0 --method newton") == reported("newton_l0.png")));
  CHECK((exported("a.png", "--width 300 --outline") == reported("pcs_l0_on_l1.png")));
  CHECK((reported("pcs_l0_on_l1.png") != reported("pcs_l1.png")));
  const std::string small = exported("a.png", "--width 90");
  CHECK((size_of_png(small) == std::pair(90, 70)));
  CHECK((exported("a.png", "--width 90 --view -1,0.5,1") != small));
  CHECK((exported("a.png", "--width 90 --view 0.55,-1,0.68") == small));
}

TEST_CASE("with --frames a .png is a series of every level's snapshots, coarse to fine") {
  const nlohmann::json levels = json_in(finished_run() / "results.json")["methods"]["pcs"]["levels"];
  std::vector<std::size_t> recorded;
  for (const nlohmann::json& level : levels) recorded.push_back(level["snapshots"]["iterations"].size());
  REQUIRE(recorded.size() == 2);
  const auto frames = [](const std::string& options) {
    const Scratch folder;
    const Ended ended = drape_ends(
        "export " + finished_run().string() + " --to film.png --frames --width 90 " + options, folder);
    std::vector<std::string> pictures;
    while (fs::exists(folder / film_picture(pictures.size())))
      pictures.push_back(text_of(folder / film_picture(pictures.size())));
    CHECK_THAT(ended.out, StartsWith("written: film_0000.png to film_00") && EndsWith(".png\n"));
    CHECK(std::distance(fs::directory_iterator(folder.path), {}) == std::ptrdiff_t(pictures.size()));
    return pictures;
  };
  const std::vector<std::string> all = frames("");
  REQUIRE(all.size() == recorded[0] + recorded[1]);
  CHECK((size_of_png(all.back()) == std::pair(90, 70)));
  CHECK((all.front() != all[recorded[0] - 1]));
  CHECK((all.front() != all.back()));
  CHECK(frames("--level 0").size() == recorded[0]);
}

TEST_CASE("a series of pictures leaves none of a longer one behind it") {
  const Scratch folder;
  const std::string film =
      "export " + finished_run().string() + " --to film.png --frames --width 90 --level 0";
  drape_ends(film, folder);
  std::size_t count = 0;
  while (fs::exists(folder / film_picture(count))) ++count;
  REQUIRE(count > 1);
  for (std::size_t k = 0; k < count; ++k) fs::remove(folder / film_picture(k));
  for (const std::size_t k : {count, count + 1, count + 3}) folder.write(film_picture(k), "longer");
  drape_ends(film, folder, 2);
  CHECK_FALSE(fs::exists(folder / film_picture(0)));
  drape_ends(film + " --overwrite", folder);
  CHECK(fs::exists(folder / film_picture(count - 1)));
  for (const std::size_t k : {count, count + 1}) CHECK_FALSE(fs::exists(folder / film_picture(k)));
  CHECK(text_of(folder / film_picture(count + 3)) == "longer");  // no part of a series
}

TEST_CASE("snapshots that are damaged are neither exported nor shown") {
  const Scratch folder;
  fs::copy(finished_run(), folder / "out", fs::copy_options::recursive);
  folder.damage("out/snapshots/pcs_l1.bin");
  for (const std::string name : {"a.glb", "a.png"}) {
    CHECK_THAT(refused_by("export out --frames --to " + name, folder.path),
               EndsWith("snapshots/pcs_l1.bin: is damaged: its checksum does not fit\n"));
  }
  drape_ends("export out --frames --level 0 --to a.glb", folder);
  drape_ends("report out --width 90", folder);
  CHECK_THAT(text_of(folder / "out/report.html"),
             Contains("snapshots/pcs_l1.bin: is damaged: its checksum does not fit"));
}

TEST_CASE("an export that cannot be written is refused before any work, and writes over no other file") {
  const std::string run = finished_run().string();
  const Scratch folder;
  const auto refused_to = [&](const std::string& file) {
    return refused_by("export " + run + " --width 90 --to " + file, folder.path);
  };
  CHECK(refused_to("nowhere/a.png") == "error: nowhere: is no folder; make it, or name another file\n");
  fs::create_directory(folder / "b.png");
  CHECK(refused_to("b.png --overwrite") == "error: b.png: is a folder; name a file\n");
  folder.write("c.png.part", "mine");
  CHECK_THAT(refused_to("c.png"), Contains("c.png.part: exists already"));
  CHECK(text_of(folder / "c.png.part") == "mine");
  fs::create_symlink("missing.png", folder / "d.png");
  CHECK_THAT(refused_to("d.png"), Contains("d.png: exists already"));
}

TEST_CASE("an export replaces no file unless it is asked to") {
  const std::string run = finished_run().string();
  const Scratch folder;
  for (const std::string name : {"a.glb", "a.obj", "a.ply", "a.vtp", "a.png"}) {
    INFO(name);
    const std::string arguments = "export " + run + " --to " + name + (name == "a.png" ? " --width 90" : "");
    folder.write(name, "mine");
    CHECK(refused_by(arguments, folder.path) ==
          "error: " + name + ": exists already; name another file, or replace it with --overwrite\n");
    CHECK(text_of(folder / name) == "mine");
    drape_ends(arguments + " --overwrite", folder);
    CHECK((text_of(folder / name) != "mine"));
  }
  folder.write("film_0003.png", "mine");  // before any picture is drawn
  drape_ends("export " + run + " --to film.png --frames --width 90", folder, 2);
  CHECK_FALSE(fs::exists(folder / "film_0000.png"));
}

TEST_CASE("an export that cannot be is refused, with what there is") {
  const std::string run = finished_run().string();
  CHECK(export_refusal("nowhere --to a.glb") ==
        "error: nowhere: no results.json here; give the folder of a run\n");
  CHECK(export_refusal(run + " --to a.fbx") ==
        "error: --to a.fbx: the formats are .glb (glTF 2.0), .obj, .ply, .vtp and .png (pictures)\n");
  CHECK(export_refusal(run + " --to a.obj --frames") ==
        "error: --frames makes an animation, which .obj cannot hold; take .glb, or .png for numbered "
        "pictures\n");
  for (const std::string option : {"--width 90", "--view 0,0,1", "--outline", "--xray"})
    CHECK(export_refusal(run + " --to a.glb " + option) ==
          "error: --width, --view, --outline and --xray are of pictures; take .png\n");
  CHECK_THAT(export_refusal(run + " --to a.png --width 15"), Contains("must be 16 to 8000 pixels, not 15"));
  for (const std::string direction : {"0,0,0", "1,2", "1,2,x", "1,2,3,4", "1,,2"})
    CHECK_THAT(export_refusal(run + " --to a.png --view " + direction),
               Contains("must be a direction, as in 1,-1,0.5, not " + direction));
  CHECK(export_refusal(run + " --to a.ply --level 2") == "error: --level 2: the levels of pcs are 0, 1\n");
  CHECK(export_refusal(run + " --to a.ply --method cascadic") ==
        "error: --method cascadic: the run's methods are pcs, newton\n");
  CHECK(export_refusal(run) == "error: --to is required; see `drape export --help`\n");
}

TEST_CASE("view writes the page if it is missing or old, and opens it, or prints its address") {
  const Scratch folder;
  fs::copy(finished_run(), folder / "a run", fs::copy_options::recursive);
  fs::remove_all(folder / "a run/levels");  // so that no time goes to pictures
  const fs::path page = folder / "a run/report.html";
  const auto view = [&](const std::string& environment) {
    const Ended ended = drape_with("view 'a run'", folder.path, environment);
    INFO(ended.err);
    CHECK(ended.exit_code == 0);
    CHECK_THAT(ended.out, StartsWith("report: a run/report.html\n"));
    return ended.out;
  };
  REQUIRE_FALSE(fs::exists(page));
  const std::string none = "DISPLAY= WAYLAND_DISPLAY=";
  const std::string said = view(none);
  CHECK_THAT(said, Contains("open it in a browser: file:///") && EndsWith("/a%20run/report.html#in-3d\n"));
  CHECK(text_of(page).ends_with("</html>\n"));

  folder.write("a run/report.html", "mine");  // newer than the results
  view(none);
  CHECK(text_of(page) == "mine");
  fs::last_write_time(folder / "a run/results.json", fs::last_write_time(page) + std::chrono::seconds(5));
  view(none);
  CHECK(text_of(page).ends_with("</html>\n"));

  folder.write("xdg-open", "#!/bin/sh\necho \"$1\" > opened.part && mv opened.part opened\n");
  fs::permissions(folder / "xdg-open", fs::perms::owner_all);
  CHECK(view("DISPLAY=:7 PATH=" + folder.path.string() + ":$PATH") == "report: a run/report.html\n");
  wait_until("the page is opened", [&] { return fs::exists(folder / "opened"); });
  CHECK(fs::path(replaced(text_of(folder / "opened"), "\n", "")) ==
        fs::canonical(folder.path) / "a run/report.html");
  CHECK(refused_by("view nowhere", folder.path, none) ==
        "error: nowhere: neither results.json nor sweep.json here; give the folder of a run or a sweep\n");
}

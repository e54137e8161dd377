// `drape export` and `drape view`: what they write is read again.

#include "core/numerics/mesh_files/io.h"
#include "tests/configs/runs.h"
#include "tests/support/glb.h"

using namespace drape;

namespace {

/// A cloth of two levels on a ball, by two methods, run once for all cases.
const fs::path& finished_run() {
  static const Scratch folder(experiment_of_tests("contact"));
  static const fs::path path = [] {
    run_into("out", folder, "-j 1 --method pcs,newton");
    return folder / "out";
  }();
  return path;
}

/// A folder with a copy of the finished run in `out`.
struct CopiedRun : Scratch {
  CopiedRun() { fs::copy(finished_run(), path / "out", fs::copy_options::recursive); }
};

TriangleMesh mesh_in(const std::string& name) { return read_mesh(finished_run() / name); }

/// What the command writes into a file of that name.
std::string exported(const std::string& name, const std::string& options = "") {
  const Scratch folder;
  const Ended ended =
      drape_ends("export " + finished_run().string() + " --to " + name + " " + options, folder);
  CHECK(ended.out == "written: " + name + "\n");
  return text_of(folder / name);
}

/// Standard error of an export of the finished run that must be refused and write nothing.
std::string export_refusal(const std::string& options, const Scratch& folder = Scratch()) {
  return refused(folder, "export " + finished_run().string() + " --to " + options);
}

/// Whether the picture has this width and height [pixels], from the header.
bool has_size(const std::string& png, int width, int height) {
  const std::string expected = {0, 0, 0, static_cast<char>(width), 0, 0, 0, static_cast<char>(height)};
  return png.substr(1, 3) == "PNG" && png.substr(16, 8) == expected;
}

/// The name of picture k of film.png.
std::string film_picture(std::size_t k) {
  const std::string number = std::to_string(k);
  return "film_" + std::string(4 - number.size(), '0') + number + ".png";
}

/// The largest difference of the accessor's vertices, in glTF's axes, and the mesh's [m].
double difference(const Glb& glb, int accessor, const Positions& x) {
  const std::vector<float> floats = glb.floats(accessor);
  REQUIRE(floats.size() == static_cast<std::size_t>(x.size()));
  const Eigen::Map<const Eigen::Matrix<float, -1, 3, Eigen::RowMajor>> found(floats.data(), x.rows(), 3);
  Positions expected(x.rows(), 3);
  expected << x.col(0), x.col(2), -x.col(1);
  return (found.cast<double>() - expected).cwiseAbs().maxCoeff();
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
    const auto primitive = [&](int node, const std::string& name) {
      const auto& nodes = glb.json.at("nodes").at(scene["nodes"][node].get<int>());
      const auto& mesh = glb.json.at("meshes").at(nodes.at("mesh").get<int>());
      CHECK(nodes.at("name") == name);
      CHECK(mesh.at("name") == name);
      return mesh.at("primitives").at(0);
    };
    const auto ball = primitive(0, "ball"), cloth = primitive(1, "contact level " + std::to_string(level));
    const std::string file = "l" + std::to_string(level) + ".ply";
    const TriangleMesh state = mesh_in("levels/pcs_" + file), rest = mesh_in("rest/" + file);
    CHECK(difference(glb, cloth["attributes"]["POSITION"], state.vertices) < 1e-6);
    CHECK(difference(glb, ball["attributes"]["POSITION"], mesh_in("obstacles/0.ply").vertices) < 1e-6);
    const std::vector<float> uv = glb.floats(cloth["attributes"]["TEXCOORD_0"]);
    for (Eigen::Index i = 0; i < rest.vertices.rows(); ++i) {
      CHECK(uv[2 * i] == Approx(rest.vertices(i, 0) / 0.4).margin(1e-6));
      CHECK(1 - uv[2 * i + 1] == Approx(rest.vertices(i, 1) / 0.4).margin(1e-6));
    }
  }
  const Glb one(exported("one.glb", "--level 0 --method newton"));
  REQUIRE(one.json["scenes"].size() == 1);
  CHECK(one.json["nodes"][1]["name"] == "contact level 0");
  CHECK(difference(one, one.json["meshes"][1]["primitives"][0]["attributes"]["POSITION"],
                   mesh_in("levels/newton_l0.ply").vertices) < 1e-6);
}

TEST_CASE("with --frames a .glb has the recorded snapshots of one level as an animation") {
  const nlohmann::json results = results_in(finished_run());
  for (const int level : {0, 1}) {
    INFO("level " << level);
    const std::size_t recorded = results["methods"]["pcs"]["levels"][level]["snapshots"]["iterations"].size();
    REQUIRE(recorded > 2);
    const Glb glb(exported("out.glb", level == 1 ? "--frames" : "--frames --level 0"));
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

TEST_CASE("an animation of a level without earlier states is refused, with the reason") {
  const Scratch folder(small_experiment());
  run_into("out", folder, "--method pcs --set snapshots=1");
  const auto check_refused = [&](const std::string& why) {
    check_error(refused(folder, "export out --to a.glb --frames"), "--frames: " + why);
  };
  const auto set = [&](const char* key, const nlohmann::ordered_json& value) {
    edit_json(folder / "out/results.json",
              [&](auto& all) { all["methods"]["pcs"]["levels"][1][key] = value; });
  };
  check_refused("the run has only the last state of level 1; run the experiment with snapshots: 8\n");
  set("iterations", 1);
  check_refused("level 1 of pcs took no more than one iteration, so it has no state before its last; ");
  set("snapshots", nullptr);
  check_refused("the run has no snapshots of level 1; run the experiment with snapshots: 8\n");
}

TEST_CASE("the other formats have the cloth of the finest level, or of the one that is named") {
  const Scratch folder;
  for (const std::string name : {"out.obj", "out.ply"})
    for (const int level : {0, 1}) {
      INFO(name << " of level " << level);
      folder.write(name, exported(name, level == 1 ? "" : "--level 0"));
      const TriangleMesh mesh = read_mesh(folder / name),
                         state = mesh_in("levels/pcs_l" + std::to_string(level) + ".ply");
      CHECK((mesh.vertices == state.vertices));
      CHECK((mesh.triangles == state.triangles));
    }
  for (const std::string name : {"out.vtp", "out.VTP"})
    CHECK((exported(name) == text_of(finished_run() / "levels/pcs_l1.vtp")));
  CHECK((exported("out.GLB") == exported("out.glb")));
}

TEST_CASE("with --rest a mesh is the rest shape of the finest level, or of the one that is named") {
  const Scratch folder;
  for (const int level : {0, 1}) {
    folder.write("rest.obj", exported("rest.obj", level == 1 ? "--rest" : "--rest --level 0"));
    const TriangleMesh mesh = read_mesh(folder / "rest.obj"),
                       rest = mesh_in("rest/l" + std::to_string(level) + ".ply");
    CHECK((mesh.vertices == rest.vertices));
    CHECK((mesh.triangles == rest.triangles));
  }
  CHECK(export_refusal("a.obj --rest --level 2") == "error: --level 2: the run's levels go from 0 to 1\n");
}

TEST_CASE("a .png is the report's picture of a state, at any width") {
  const CopiedRun folder;
  drape_ends("report out --width 300", folder);
  const std::pair<std::string, std::string> pictures[] = {
      {"pcs_l1", ""}, {"newton_l0", "--level 0 --method newton"}, {"pcs_l0_on_l1", "--outline"}};
  for (const auto& [name, options] : pictures) {
    INFO(name);
    const std::string reported = text_of(folder / ("out/pictures/" + name + ".png"));
    CHECK((exported("a.png", "--width 300 " + options) == reported));
    CHECK((options == "" || reported != text_of(folder / "out/pictures/pcs_l1.png")));
  }
  const std::string small = exported("a.png", "--width 90");
  CHECK(has_size(small, 90, 70));
  CHECK((exported("a.png", "--width 90 --view -1,0.5,1") != small));
  CHECK((exported("a.png", "--width 90 --view 0.55,-1,0.68") == small));
}

TEST_CASE("with --frames a .png is a series of every level's snapshots, coarse to fine") {
  const std::string film = "export " + finished_run().string() + " --to film.png --frames --width 90 ";
  const nlohmann::json levels = results_in(finished_run())["methods"]["pcs"]["levels"];
  const std::size_t coarse = levels[0]["snapshots"]["iterations"].size(),
                    all = coarse + levels[1]["snapshots"]["iterations"].size();
  const Scratch folder, one_level;
  CHECK_THAT(drape_ends(film, folder).out, StartsWith("written: film_0000.png to ") && EndsWith(".png\n"));
  CHECK(files_in(folder.path).size() == all);
  const auto picture = [&](std::size_t k) { return text_of(folder / film_picture(k)); };
  CHECK(has_size(picture(all - 1), 90, 70));
  CHECK((picture(0) != picture(coarse - 1)));
  CHECK((picture(0) != picture(all - 1)));
  drape_ends(film + "--level 0", one_level);
  CHECK(files_in(one_level.path).size() == coarse);

  // A series leaves none of a longer one behind it, and is refused where any of its pictures is there.
  REQUIRE(coarse > 1);
  for (std::size_t k = 0; k < coarse; ++k) fs::remove(one_level / film_picture(k));
  for (const std::size_t k : {coarse, coarse + 1, coarse + 3}) one_level.write(film_picture(k), "longer");
  refused(one_level, film + "--level 0");
  drape_ends(film + "--level 0 --overwrite", one_level);
  CHECK(fs::exists(one_level / film_picture(coarse - 1)));
  for (const std::size_t k : {coarse, coarse + 1}) CHECK_FALSE(fs::exists(one_level / film_picture(k)));
  CHECK(text_of(one_level / film_picture(coarse + 3)) == "longer");  // no part of a series
}

TEST_CASE("snapshots that are damaged are neither exported nor shown") {
  const CopiedRun folder;
  folder.damage("out/snapshots/pcs_l1.bin");
  const std::string damaged = "snapshots/pcs_l1.bin: is damaged: its checksum does not fit";
  for (const std::string name : {"a.glb", "a.png"})
    CHECK_THAT(refused(folder, "export out --frames --to " + name), EndsWith(damaged + "\n"));
  drape_ends("export out --frames --level 0 --to a.glb", folder);
  drape_ends("report out --width 90", folder);
  CHECK_THAT(text_of(folder / "out/report.html"), Contains(damaged));
}

TEST_CASE("meshes of levels that are damaged are neither exported nor shown") {
  const CopiedRun folder;
  const std::string name = "out/levels/pcs_l1.ply", damaged = "levels/pcs_l1.ply: is damaged: its checksum";
  std::string bytes = text_of(folder / name);
  bytes[bytes.find("end_header\n") + 20] ^= 1;  // of a coordinate: the file is still a PLY
  folder.write(name, bytes);
  REQUIRE(read_mesh(folder / name).vertices.allFinite());
  for (const std::string to : {"a.glb", "a.obj", "a.ply", "a.vtp", "a.png"}) {
    INFO(to);
    CHECK_THAT(refused(folder, "export out --to " + to), Contains(damaged));
  }
  drape_ends("export out --level 0 --to a.obj", folder);
  CHECK_THAT(drape_ends("report out --width 90", folder).err, StartsWith("warning: out/" + damaged));
  CHECK_THAT(text_of(folder / "out/report.html"), Contains(damaged));
  CHECK_FALSE(fs::exists(folder / "out/pictures/pcs_l1.png"));
}

TEST_CASE("fields that are damaged are not shown") {
  const CopiedRun folder;
  folder.damage("out/fields/pcs_l0_l1.ply");
  drape_ends("report out --width 90", folder);
  CHECK_THAT(text_of(folder / "out/report.html"), Contains("fields/pcs_l0_l1.ply: is damaged: its checksum"));
}

TEST_CASE("a name in results.json that leads out of its folder is refused") {
  const CopiedRun folder;
  fs::copy_file(folder / "out/levels/pcs_l1.ply", folder / "mine.ply");
  for (const std::string& name :
       std::vector<std::string>{"../mine.ply", "levels/../../mine.ply", folder / "mine.ply"}) {
    edit_json(folder / "out/results.json", [&](auto& results) {
      auto& level = results["methods"]["pcs"]["levels"][1];
      level["mesh"] = name;
      level.erase("mesh_checksum");
    });
    for (const std::string command :
         {"export out --to a.obj", "export out --to a.png", "report out", "table out"}) {
      INFO(command << " with " << name);
      check_error(refused(folder, command), "out/results.json: \"");
      CHECK_THAT(refused(folder, command), Contains("leads out of the folder"));
    }
  }
}

TEST_CASE("an export is refused before any work where its file cannot be written, or is there") {
  const Scratch folder;
  CHECK(export_refusal("nowhere/a.png", folder) ==
        "error: nowhere: is no folder; make it, or name another file\n");
  fs::create_directory(folder / "b.png");
  CHECK(export_refusal("b.png --overwrite", folder) == "error: b.png: is a folder; name a file\n");
  folder.write("c.png.part", "mine");
  drape_ends("export " + finished_run().string() + " --width 90 --to c.png", folder);
  CHECK(text_of(folder / "c.png.part") == "mine");
  fs::create_symlink("missing.png", folder / "d.png");
  check_error(export_refusal("d.png", folder), "d.png: exists already");
  for (const std::string name : {"a.glb", "a.obj", "a.ply", "a.vtp", "a.png"}) {
    INFO(name);
    folder.write(name, "mine");
    check_error(export_refusal(name, folder), name + ": exists already; name another file, or ");
    drape_ends("export " + finished_run().string() + " --overwrite --to " + name +
                   (name == "a.png" ? " --width 90" : ""),
               folder);
    CHECK((text_of(folder / name) != "mine"));
  }
  folder.write("film_0003.png", "mine");  // before any picture is drawn
  export_refusal("film.png --frames --width 90", folder);
}

TEST_CASE("an export of a level or a method that the run has not is refused, with what there is") {
  check_error(export_refusal("a.ply --level 2"), "--level 2: the levels of pcs are 0, 1\n");
  check_error(export_refusal("a.ply --method cascadic"),
              "--method cascadic: the run's methods are pcs, newton\n");
}

TEST_CASE("view writes the page if it is missing or old, and opens it, or prints its address") {
  const Scratch folder;
  fs::copy(finished_run(), folder / "a run", fs::copy_options::recursive);
  fs::remove_all(folder / "a run/levels");  // so that no time goes to pictures
  const fs::path page = folder / "a run/report.html";
  const std::string none = "DISPLAY= WAYLAND_DISPLAY=";
  const auto view = [&](const std::string& environment) {
    const Ended ended = drape_with("view 'a run'", folder.path, environment);
    CHECK(ended.exit_code == 0);
    CHECK_THAT(ended.out, StartsWith("report: a run/report.html\n"));
    return ended.out;
  };
  REQUIRE_FALSE(fs::exists(page));
  CHECK_THAT(view(none), Contains("in a browser: file:///") && EndsWith("/a%20run/report.html#in-3d\n"));
  CHECK(text_of(page).ends_with("</html>\n"));

  folder.write("a run/report.html", "mine");  // newer than the results
  view(none);
  CHECK(text_of(page) == "mine");
  fs::last_write_time(folder / "a run/results.json", fs::last_write_time(page) + std::chrono::seconds(5));
  for (const std::string command : {"view 'a run'", "report 'a run'"}) {
    check_error(refused(folder, command, none),
                "a run/report.html: is there already, and no report of drape; move it");
    CHECK(text_of(page) == "mine");
  }
  folder.write("a run/report.html", "<title>old – drape</title>");
  fs::last_write_time(folder / "a run/results.json", fs::last_write_time(page) + std::chrono::seconds(5));
  view(none);
  CHECK(text_of(page).ends_with("</html>\n"));

  folder.write("xdg-open", "#!/bin/sh\necho \"$1\" > opened.part && mv opened.part opened\n");
  fs::permissions(folder / "xdg-open", fs::perms::owner_all);
  CHECK(view("DISPLAY=:7 PATH=" + folder.path.string() + ":$PATH") == "report: a run/report.html\n");
  wait_until("the page is opened", [&] { return fs::exists(folder / "opened"); });
  CHECK(text_of(folder / "opened") == (fs::canonical(folder.path) / "a run/report.html").string() + "\n");
  check_error(refused(folder, "view nowhere", none), "nowhere: neither results.json nor sweep.json here; ");
}

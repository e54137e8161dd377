// OBJ files of sewn cloth as garment tools write them: they drape, or are refused in a sentence.

#include <cmath>
#include <regex>

#include "core/numerics/mesh/flat_pieces.h"
#include "core/numerics/mesh/seams.h"
#include "core/numerics/mesh_files/io.h"
#include "tests/configs/runs.h"
#include "tests/support/glb.h"
#include "tests/support/refusal.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// How a tool writes a cushion of two squares of 0.2 m.
struct Writing {
  bool doubled = false;  ///< the back has vertices of its own along the seam
  double jitter = 0;     ///< [m], of these
  bool quads = false;
  double uv_unit = 1;    ///< units of the texture coordinates for a metre
  double v_stretch = 1;  ///< further factor on v
  double unit = 1;       ///< units of the coordinates for a metre
  bool y_up = false;
  std::string keyword = {};  ///< "g" or "usemtl" before each square
  bool one_side = false;     ///< the back's faces run as the front's
  bool mirrored = false;     ///< the back shares the front's texture coordinates
  bool loose = false;        ///< a vertex of no face
};

constexpr int n = 5;
constexpr double side = 0.2;

std::string obj_of(const Writing& w) {
  std::string vertices, uv, faces;
  int count = 0;
  std::vector<int> front(n * n), back(n * n);
  const auto add_vertex = [&](int i, int j, double z, double shift) {
    const double x = side * i / (n - 1) + shift, y = side * j / (n - 1);
    const Eigen::Vector3d p = w.unit * (w.y_up ? Eigen::Vector3d(x, z, -y) : Eigen::Vector3d(x, y, z));
    vertices +=
        "v " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
    return ++count;
  };
  for (int half = 0; half < 2; ++half)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const bool border = i == 0 || j == 0 || i == n - 1 || j == n - 1;
        const double z = 0.03 * std::sin(M_PI * i / (n - 1)) * std::sin(M_PI * j / (n - 1));
        std::vector<int>& own = half == 0 ? front : back;
        own[j * n + i] = half == 1 && border && !w.doubled
                             ? front[j * n + i]
                             : add_vertex(i, j, half == 0 ? z : -z, half == 1 && border ? w.jitter : 0);
        const double along = side * i / (n - 1), u = half == 1 && !w.mirrored ? 2.5 * side - along : along;
        uv += "vt " + std::to_string(w.uv_unit * u) + " " +
              std::to_string(w.uv_unit * w.v_stretch * side * j / (n - 1)) + "\n";
      }
  for (int half = 0; half < 2; ++half) {
    if (!w.keyword.empty()) faces += w.keyword + (half == 0 ? " front\n" : " back\n");
    for (int j = 0; j + 1 < n; ++j)
      for (int i = 0; i + 1 < n; ++i) {
        std::vector<int> corners = {j * n + i, j * n + i + 1, (j + 1) * n + i + 1, (j + 1) * n + i};
        if (half == 1 && !w.one_side) std::ranges::reverse(corners);
        const auto face = [&](std::initializer_list<int> which) {
          faces += "f";
          for (const int k : which)
            faces += " " + std::to_string((half == 0 ? front : back)[corners[k]]) + "/" +
                     std::to_string(half * n * n + corners[k] + 1);
          faces += "\n";
        };
        if (w.quads)
          face({0, 1, 2, 3});
        else
          face({0, 1, 2}), face({0, 2, 3});
      }
  }
  if (w.loose) add_vertex(0, 0, 0.5, 0);
  return "# a cushion\n" + vertices + uv + faces;
}

std::string sewn_experiment(const std::string& keys, const std::string& pins = "{region: seam}") {
  return "name: sewn\nlevels: 2\ncloth: {shape: file, file: cushion.obj, rest: uv, " + keys +
         "}\nmaterial: {density: 300, thickness: 5e-4, membrane_modulus: 2e5, bending_modulus: 2e6}\npins: "
         "[" +
         pins + "]\nenergies: [stvk, hinge, gravity]\nmethods: {pcs: {}}\n";
}

/// The cushion of that file, draped.
Solved draped(const std::string& obj, const std::string& keys, const std::string& pins = "{region: seam}") {
  const Scratch folder(sewn_experiment(keys, pins));
  folder.write("cushion.obj", obj);
  return solved(experiment_in(folder / "e.yaml"));
}

std::string refused_cushion(const std::string& obj, const std::string& keys,
                            const std::string& pins = "{region: seam}") {
  return refusal_of([&] { draped(obj, keys, pins); });
}

}  // namespace

TEST_CASE("OBJ files of sewn cloth drape as garment tools write them") {
  Writing doubled{.doubled = true}, apart{.doubled = true, .jitter = 1e-6}, quads{.quads = true},
      mm{.uv_unit = 1000}, normalised{.uv_unit = 2.5}, up{.unit = 100, .y_up = true, .keyword = "g"},
      materials{.keyword = "usemtl"}, mirrored{.mirrored = true};
  const Solved plain = draped(obj_of({}), "uv_unit: m");
  for (const auto& [writing, keys] : {std::pair(doubled, "uv_unit: m, join: 1e-7"),
                                      {apart, "uv_unit: m, join: 1e-5"},
                                      {quads, "uv_unit: m"},
                                      {mm, "uv_unit: mm"},
                                      {normalised, "uv_unit: normalised"},
                                      {up, "uv_unit: m, unit: cm, up: y"},
                                      {materials, "uv_unit: m"},
                                      {mirrored, "uv_unit: m"}}) {
    const Solved s = draped(obj_of(writing), keys);
    INFO(keys);
    REQUIRE(s.levels.back().outcome == Outcome::converged);
    const Level& coarsest = s.scene->hierarchy.levels[0];
    CHECK(coarsest.vertex_count() == 2 * n * n - 4 * (n - 1));
    CHECK(flat_pieces(coarsest.rest, coarsest.topology) ==
          flat_pieces(plain.scene->hierarchy.levels[0].rest, plain.scene->hierarchy.levels[0].topology));
    // The length of normalised coordinates comes from a cushion that is inflated.
    const double same = writing.uv_unit == 2.5 ? 0.1 : 1e-9;
    CHECK(s.level().vertex_area.sum() == Approx(2 * side * side).epsilon(same));
  }
  // The seams are refined as seams.
  for (const Level& level : plain.scene->hierarchy.levels) {
    int seams = 0;
    for (int e = 0; e < level.topology.edges.rows(); ++e) seams += is_seam(level.rest, level.topology, e);
    CHECK(seams == 4 * (n - 1) << level.index);
  }
}

TEST_CASE("Pins and handles select pieces by the names of groups or materials, seams and borders of them") {
  for (const char* keyword : {"g", "usemtl"}) {
    const Writing named{.keyword = keyword};
    for (const auto& [pin, count] : {std::pair("{region: piece, piece: back}", n * n),
                                     {"{region: seam}", 4 * (n - 1)},
                                     {"{region: seam, piece: front}", 4 * (n - 1)}}) {
      const Solved s = draped(obj_of(named), "uv_unit: m", pin);
      CHECK(s.scene->models[0]->dirichlet().size() == static_cast<std::size_t>(count));
    }
    const std::string faulty = refused_cushion(obj_of(named), "uv_unit: m", "{region: piece, piece: bakc}");
    CHECK_THAT(faulty, Catch::Contains("the cloth has no piece \"bakc\"; it has front, back"));
  }
  CHECK_THAT(refused_cushion(obj_of({}), "uv_unit: m", "{region: border}"),
             Catch::Contains("selects no vertex"));
}

TEST_CASE("OBJ files that are no sewn cloth are refused in a sentence") {
  CHECK_THAT(
      refused_cushion(obj_of({.uv_unit = 1000}), "join: 0"),
      Catch::Contains("\"rest: uv\" needs \"uv_unit\", the unit of the texture coordinates; by the areas in "
                      "space one is ") &&
          Catch::Contains("\"uv_unit: mm\"?"));
  CHECK_THAT(refused_cushion(obj_of({.v_stretch = 3}), "uv_unit: normalised"),
             Catch::Contains("the aspect is lost"));
  CHECK_THAT(refused_cushion(obj_of({.one_side = true}), "uv_unit: m"),
             Catch::Contains("run in the same direction in both triangles"));
  CHECK_THAT(refused_cushion(obj_of({.loose = true}), "uv_unit: m"),
             Catch::Contains("belongs to no triangle"));
  const std::string cushion = obj_of({});
  CHECK_THAT(refused_cushion(
                 cushion + "v 0.1 0 0.4\nf 1/1 2/2 " + std::to_string(2 * n * n - 4 * (n - 1) + 1) + "/7\n",
                 "uv_unit: m"),
             Catch::Contains("1 edge has more than two triangles: (0, 1) in triangles"));
  // A triangle without area in the plane, and an inner vertex that lies beyond its neighbours there.
  std::string flat = cushion, over = cushion;
  const auto set_uv = [](std::string& obj, int number, const std::string& line) {
    std::size_t at = 0;
    for (int k = 0; k <= number; ++k) at = obj.find("vt ", at + 1);
    obj.replace(at, obj.find('\n', at) - at, line);
  };
  set_uv(flat, 1, "vt 0 0");
  CHECK_THAT(refused_cushion(flat, "uv_unit: m"), Catch::Contains("no area in texture coordinates"));
  CHECK_THAT(
      refused_cushion(std::regex_replace(cushion, std::regex("vt .*"), "vt 0 0"), "uv_unit: normalised"),
      Catch::Contains("the texture coordinates enclose no area; export the texture coordinates in a unit"));
  CHECK_THAT(
      refused_cushion(std::regex_replace(cushion, std::regex("vt ([^ ]*) (.*)"), "vt $1e15 $2e15"),
                      "uv_unit: m"),
      Catch::Contains("m across by their texture coordinates, and 1e-09 to 1e+09 m can be computed with"));
  set_uv(over, n + 1, "vt 0.12 0.05");
  CHECK_THAT(refused_cushion(over, "uv_unit: m"), Catch::Contains("turned over in texture coordinates"));
  CHECK_THAT(refused_cushion(cushion, "uv_unit: m}\nrefiner: loop\nstart: {perturbation: 0"),
             Catch::Contains("write \"refiner: midpoint\""));
}

TEST_CASE("A sewn run can be run again from its own config, and goes out as its file came") {
  const Writing writing{
      .doubled = true, .jitter = 1e-6, .uv_unit = 1000, .unit = 100, .y_up = true, .keyword = "g"};
  const Scratch folder(
      sewn_experiment("uv_unit: mm, join: 1e-5, unit: cm, up: y", "{region: seam, piece: back}"));
  folder.write("cushion.obj", obj_of(writing));
  CHECK_THAT(
      drape_ends("check e.yaml", folder).out,
      Contains("16 vertices of the cloth's file were joined to others") &&
          Contains("cloth: 2 flat pieces, 0.8 m of seams; 1 unit of the texture coordinates is 0.001 m"));
  run_into("out", folder, "-j 1");
  drape_ends("run out/config.yaml --quiet --no-report --measure -j 1 --out again", folder);
  check_same_files(folder / "out", folder / "again",
                   {"config.yaml", "rest/l0.ply", "levels/pcs_l0.ply", "levels/pcs_l1.ply"});

  const TriangleMesh own = read_mesh(folder / "cushion.obj"),
                     state = read_mesh(folder / "out/levels/pcs_l0.ply");
  drape_ends("export out --to back.obj --level 0 --as-read", folder);
  const TriangleMesh back = read_mesh(folder / "back.obj");
  REQUIRE(back.vertices.rows() == own.vertices.rows());
  CHECK(back.triangles == own.triangles);
  CHECK(back.uv == own.uv);
  CHECK(back.piece_names == own.piece_names);
  Positions front = back.vertices.topRows(n * n);
  FileCoordinates{"cm", "y"}.convert(front);
  CHECK(front.isApprox(state.vertices.topRows(n * n), 1e-12));

  drape_ends("export out --to placed.obj --rest --level 0 --as-read", folder);
  const TriangleMesh placed = read_mesh(folder / "placed.obj");
  CHECK(placed.vertices.isApprox(own.vertices, 1e-4));  // but for the vertices that were joined
  CHECK(placed.triangles == own.triangles);
  CHECK(placed.uv == own.uv);
  drape_ends("export out --to placed.ply --rest --level 0 --uv-unit m", folder);
  CHECK(read_mesh(folder / "placed.ply").uv.isApprox(1e-3 * own.uv, 1e-12));

  for (const auto& [unit, factor] : {std::pair("mm", 1.), {"m", 1e-3}, {"inch", 1 / 25.4}}) {
    drape_ends("export out --to uv.obj --overwrite --level 0 --uv-unit " + std::string(unit), folder);
    CHECK(read_mesh(folder / "uv.obj").uv.isApprox(factor * own.uv, 1e-12));
  }
  drape_ends("export out --to uv.ply --level 1 --uv-unit normalised", folder);
  CHECK(read_mesh(folder / "uv.ply").uv.minCoeff() == 0);
  CHECK(read_mesh(folder / "uv.ply").uv.maxCoeff() == Approx(1));
  CHECK(read_mesh(folder / "uv.ply").sewing->uv_length == Approx(2.5 * side));
  CHECK_THAT(refused(folder, "export out --to uv.glb --uv-unit m"),
             Contains("--uv-unit is of a .obj or .ply"));
  CHECK_THAT(refused(folder, "export out --to b.obj --uv-unit foot"),
             Contains("must be mm, cm, m, inch or "));

  drape_ends("export out --to fine.ply", folder);
  const TriangleMesh fine = read_mesh(folder / "fine.ply");
  CHECK(fine.uv.leftCols(1).maxCoeff() <= 1000 * 2.5 * side + 1e-9);
  CHECK(fine.piece.size() == static_cast<std::size_t>(4 * own.triangles.rows()));
  drape_ends("export out --to all.glb --level 1", folder);
  const Glb glb(text_of(folder / "all.glb"));
  const nlohmann::json mesh = glb.json["meshes"][0];
  REQUIRE(mesh["primitives"].size() == 2);
  CHECK(glb.json["materials"][mesh["primitives"][1]["material"].get<int>()]["name"] == "back");
  CHECK(mesh["extras"]["uv_length"].get<double>() == Approx(2.5 * side));
}

TEST_CASE("A mesh that was made anew within a file's outline does not go out as the file came") {
  const Scratch folder(
      "name: anew\nlevels: 1\ncloth: {shape: file, file: square.obj, edge_length: 0.3}\n"
      "pins: [{region: border}]\nenergies: [stvk, gravity]\nmethods: {newton: {}}\n");
  folder.write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
  run_into("out", folder, "-j 1 --method newton");
  CHECK_THAT(refused(folder, "export out --to back.obj --as-read"),
             Contains("or the run meshed them anew, by \"edge_length\" or \"vertices\""));
}

TEST_CASE("A wrong unit of texture coordinates is named, and no edge is called tiny for it") {
  const Scratch folder(sewn_experiment("uv_unit: mm"));
  folder.write("cushion.obj", obj_of({}));
  CHECK_THAT(drape_ends("check e.yaml", folder).err,
             Contains("check \"uv_unit\"") && !Contains("has an edge of"));
}

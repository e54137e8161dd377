#include <catch2/catch.hpp>

#include "core/app/scene/scene_summary.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/meshes.h"
#include "tests/support/solve.h"

using namespace drape;
using Catch::Contains;

namespace {

/// A scene with the README's material, and these keys at the end.
std::string scene_yaml(const std::string& cloth, const std::string& more = "") {
  return "name: scene\ncloth: {" + cloth +
         "}\nlevels: 1\nmaterial: {density: 472.6, thickness: 3.18e-4, membrane_modulus: 8e4, "
         "bending_modulus: "
         "8e4, poisson_ratio: 0.243}\nenergies: [neo_hookean, hinge, gravity]\ncontact: [ipc, shapes]\n"
         "methods: {newton: {}}\n" +
         more;
}

const std::string metre = "shape: square, side: 1, vertices: 400";

/// For meshes whose edges are far below d̂: they have millions of pairs.
std::string without_self_contact(const std::string& scene) {
  return replaced(scene, "[ipc, shapes]", "[shapes]");
}

/// A scene of a square metre with another text in place of one.
std::string edited_scene(const std::string& from, const std::string& to) {
  return replaced(scene_yaml(metre), from, to);
}

std::string ball_below(double radius, double below) {
  return "obstacles: [{name: ball, shape: sphere, radius: " + ConfigNode::of(radius).scalar +
         ", translate: [0.5, 0.5, " + ConfigNode::of(-below - radius).scalar + "]}]\n";
}

std::string warnings_of(const std::string& yaml) {
  const Solved s = scene_from(yaml);
  std::string all;
  for (const ConfigError& warning : plausibility_warnings(s.experiment, *s.scene, summary_of(*s.scene)))
    all += std::to_string(warning.where.line) + ": " + warning.message + "\n";
  return all;
}

/// Each scene has a warning with this text, or none where the text is empty.
void check_warnings(const std::vector<std::pair<std::string, std::string>>& scenes) {
  for (const auto& [yaml, warning] : scenes) {
    INFO(yaml);
    const std::string warnings = warnings_of(yaml);
    if (warning.empty())
      CHECK(warnings == "");
    else
      CHECK_THAT(warnings, Contains(warning));
  }
}

std::string summary_text(const std::string& yaml) { return text_of(summary_of(*scene_from(yaml).scene)); }

}  // namespace

TEST_CASE("Numbers have significant digits, and no exponent up to thousands") {
  const std::tuple<double, int, std::string> numbers[] = {{0.0123, 2, "0.012"}, {9.96, 2, "10"},
                                                          {99.7, 2, "100"},     {1234, 2, "1200"},
                                                          {-0.5, 2, "-0.5"},    {0, 2, "0"}};
  for (const auto& [number, digits, text] : numbers) CHECK(rounded_text(number, digits) == text);
}

TEST_CASE("The summary has what a person would notice, and leaves out what a scene does not have") {
  CHECK(summary_text(scene_yaml("shape: square, side: 1, columns: 21, rows: 21", ball_below(0.3, 0.02))) ==
        "1 × 1 m, 1 part, edges 50–71 mm, 0.15 kg, bending length 7.7 mm (0.15 edges), d̂ 1 mm (0.02 edges), "
        "starts 20 mm above ball: sphere");
  CHECK(summary_text("name: bare\ncloth: {shape: rectangle, size: [0.3, 0.2], columns: 4, rows: 3}\nlevels: "
                     "2\nrefiner: midpoint\nenergies: [neo_hookean]\nmethods: {newton: {}}\n") ==
        "0.3 × 0.2 m, 1 part, edges 50–71 mm on level 1, 9 g");
}

TEST_CASE("The bending length is that of the scene's bending energies") {
  const std::string scene = scene_yaml("shape: square, side: 1, columns: 21, rows: 21"),
                    half_of_hinge = ", per: hinge, energy: \"1.5*k*length^2/area*bend^2\"}";
  const std::pair<std::string, std::string> energies[] = {
      {"midedge_bending", "5.4 mm (0.11 edges)"},
      {"quadratic_bending", "7.7 mm (0.15 edges)"},
      {"{type: formula, name: one" + half_of_hinge + ", {type: formula, name: other" + half_of_hinge,
       "7.7 mm (0.15 edges)"}};
  for (const auto& [bending, length] : energies)
    CHECK_THAT(summary_text(replaced(scene, "hinge", bending)), Contains(", bending length " + length));
}

TEST_CASE("The summary names the nearest obstacle, of either contact model, and where the cloth is") {
  // No vertex of the sheet is below the lid, and none of the table below the sheet.
  const std::string lid =
                        "{name: lid, meshed_shape: box, size: [0.1, 0.1, 0.2], translate: [0.6, 0.6, 0.15]}",
                    table = "{name: table, meshed_shape: box, size: [3, 3, 1], translate: [0.5, 0.5, -0.55]}",
                    floor = "{name: floor, shape: half_space, translate: [50, 50, -0.2]}",
                    post = "{name: post, shape: capsule, radius: 0.1, height: 2, translate: [1.4, 0.5, 0]}";
  const std::pair<std::string, std::string> starts[] = {
      {lid + ", " + floor, "50 mm below lid"},
      {table, "50 mm above table"},
      {floor + ", " + post, "0.2 m above floor: half_space"},
      {post, "0.3 m beside post: capsule"}};
  for (const auto& [obstacles, where] : starts)
    CHECK_THAT(summary_text(scene_yaml("shape: square, side: 1, columns: 5, rows: 5",
                                       "obstacles: [" + obstacles + "]\n")),
               Catch::EndsWith("starts " + where));
}

TEST_CASE("A size that no fabric has gets a warning with what is usual and a remedy, before a run") {
  const auto sized = [](const std::string& cloth) { return scene_yaml(cloth + ", vertices: 900"); };
  const std::string unit = "lengths are in metres; if its lengths are in ",
                    smaller = "choose a smaller size\n";
  check_warnings({
      {sized("shape: square, side: 1000"),
       "2: the cloth is 1000 × 1000 m; fabric is usually between 0.05 and 10 m wide, and " + unit +
           "millimetres, divide every length by 1000\n"},
      {sized("shape: rectangle, size: [120, 80]"), unit + "centimetres, divide every length by 100\n"},
      {sized("shape: square, side: 60"),
       unit + "centimetres, divide every length by 100; if in inches, multiply every length by 0.0254\n"},
      {sized("shape: square, side: 10000"), "lengths are in metres; " + smaller},
      {sized("shape: polygon, loops: [{points: [0, 0, 120, 0, 120, 80, 0, 80]}]"),
       unit + "centimetres, write \"unit: cm\"\n"},
      {sized("shape: polygon, unit: cm, loops: [{points: [0, 0, 9e3, 0, 9e3, 8e3, 0, 8e3]}]"), smaller},
      {sized("shape: polygon, unit: inch, loops: [{points: [0, 0, 2200, 0, 2200, 900, 0, 900]}]"),
       unit + "millimetres, write \"unit: mm\"\n"},
      {without_self_contact(sized("shape: square, side: 1e-3")), "2: the cloth is 1 × 1 mm"},
      {scene_yaml(metre, "start: {scale: [0.1, 0.1, 0.1]}\n"),
       "the start has 0.1 times the lengths of the rest shape"},
      {scene_yaml(metre, ball_below(85, 0.02)),  // in centimetres
       "the obstacle ball: sphere is 170 × 170 × 170 m and the cloth 1 × 1 m"},
  });
}

TEST_CASE("What no fabric or scene has gets a warning that says what is usual, before a run") {
  const Scratch folder;
  TriangleMesh tray = unit_box();  // whose lid, triangles 2 and 3, is left out
  tray.triangles.middleRows(2, 8) = tray.triangles.bottomRows(8).eval();
  tray.triangles.conservativeResize(10, 3);
  write_mesh(folder / "tray.ply", tray);
  const std::string thickness = "thickness: 3.18e-4", bending = "bending_modulus: 8e4";
  check_warnings({
      {scene_yaml(metre, ball_below(0.3, 0.02)), ""},
      {scene_yaml(metre, "obstacles: [{name: crate, meshed_shape: box, size: [3, 3, 3]}]\n"),
       "the cloth starts inside the obstacle crate"},
      {scene_yaml(metre,
                  "obstacles: [{name: tray, scale: 3, mesh: " + (folder / "tray.ply").string() + "}]\n"),
       ""},
      {edited_scene("neo_hookean, ", ""), "no energy resists stretching"},
      {edited_scene(thickness, "thickness: 0.318"),  // in millimetres
       "4: a square metre of the cloth has 150 kg (density × thickness); fabric usually has 0.02 to 2 kg"},
      {edited_scene(thickness, "thickness: 2e-6"), "has 0.00095 kg"},
      {edited_scene("density: 472.6, thickness: 3.18e-4", "density: 0.4726, thickness: 0.318"),
       "4: the cloth is 0.32 m thick; fabric is usually 0.1 to 3 mm; \"thickness\" is in metres"},
      {edited_scene(bending, "bending_modulus: 0"), ""},
      {edited_scene(bending, "bending_modulus: 8e6"), ""},
      {edited_scene(bending, "bending_modulus: 8e12"), "4: weight bends this cloth over a length of "},
      {without_self_contact(replaced(scene_yaml("shape: square, side: 0.02, vertices: 10000"), bending,
                                     "bending_modulus: 8e10")),
       "of level 0; 2 to 20 are usual"},
      {scene_yaml("shape: square, side: 30, vertices: 25"),
       "2: the bending length of 7.7 mm is 0.001 edges of level 0"},
      {scene_yaml("shape: polygon, edge_length: 0.11, loops: [{points: [0, 0, 1, 0, 1, 1, 0, 1]}]"),
       "so no fold of the cloth can form; 2 to 20 are usual; take more vertices or levels, or check "
       "\"bending_modulus\" (in Pa) and \"thickness\" (in metres, to the third power); \"edge_length\" in "
       "cloth "
       "meshes flat pieces anew\n"},
      {scene_yaml("shape: polygon, edge_length: 0.06, loops: [{points: [0, 0, 1, 0, 1, 1, 0, 1]}]"), ""},
      {edited_scene("[ipc, shapes]", "[{type: ipc, dhat: 0.1}]"),
       "contact distance dhat of 0.1 m is longer than most edges of level 0 (53 mm)"},
  });
}

TEST_CASE("A triangle that is too low for solvers gets a warning") {
  TriangleMesh mesh = grid({0.4, 0.4}, 9, 9, Diagonals::one_way);
  const Scratch folder;
  for (const double height : {2e-6, 1e-9}) {
    mesh.vertices(10, 1) = height;
    write_mesh(folder / "low.ply", mesh);
    const std::string warnings =
        warnings_of(scene_yaml("shape: file, file: " + (folder / "low.ply").string()));
    CHECK((warnings.find("is lower than a millionth of its longest edge") != warnings.npos) ==
          (height < 1e-7));
  }
}

TEST_CASE("An edge that is tiny beside the others gets a warning") {
  const auto warnings = [](const std::string& corner) {
    return warnings_of(
        scene_yaml("shape: polygon, edge_length: 0.06, loops: [{points: [0, 0, 1, 0, 1, 1, 0, "
                   "1]}, {points: [" +
                   corner + ", 0.3, 0.3, 0.3, 0.3, 0.6]}]"));
  };
  CHECK(warnings("1e-4") == "");
  CHECK_THAT(warnings("1e-6"), Contains(" mm at (") && Contains(", and most have "));
}

TEST_CASE("Measured stiffness that the energies of a scene do not read gets a warning") {
  const auto measured = [&](const std::string& keys, const std::string& energies) {
    return warnings_of(
        replaced(edited_scene("0.243}", "0.243, " + keys + "}"), "neo_hookean, hinge", energies));
  };
  const std::string all =
      "warp_stiffness: 30, weft_stiffness: 20, shear_stiffness: 2, warp_bending: 1e-6, weft_bending: 2e-6, "
      "bias_bending: 1e-6, bending_hysteresis: 1e-4";
  const std::string none = "4: no energy of this scene reads ", does = "; midedge_bending does\n";
  CHECK(measured(all, "woven, midedge_bending") == "");
  CHECK(measured("warp_stiffness: 30, warp_bending: 2e-6", "neo_hookean, hinge") == "");
  CHECK(measured("bending_hysteresis: 1e-4", "neo_hookean, hinge") == none + "\"bending_hysteresis\"" + does);
  CHECK(measured(all, "stvk, quadratic_bending") == none + "\"shear_stiffness\"; woven does\n" + none +
                                                        "\"bias_bending\", \"bending_hysteresis\"" + does);
  CHECK(measured(
            "warp_stiffness: 30",
            "{type: woven, warp_tension: [0.02, 3, 0.08, 200], weft_tension: [0.02, 3, 0.08, 200]}, hinge") ==
        none + "\"warp_stiffness\"\n");
  // Those of a fabric, of which the user has written none.
  const auto fabric = [&](const std::string& name, const std::string& energies) {
    const std::string said =
        warnings_of("name: scene\ncloth: {" + metre + "}\nlevels: 1\nmaterial: {fabric: " + name +
                    "}\nenergies: [" + energies + ", gravity]\nmethods: {newton: {}}\n");
    return said == "" ? said : replaced(said, "4: fabric \"" + name + "\": ", "");
  };
  const std::string mean = " only the mean of its bending along warp and weft, not ",
                    reader = "; midedge_bending reads each\n";
  CHECK(fabric("pink-ribbon-brown", "woven, midedge_bending") == "");
  CHECK(fabric("cotton", "stvk, hinge") == "");
  CHECK(fabric("pink-ribbon-brown", "woven, hinge") == "hinge reads" + mean + "\"bias_bending\"" + reader);
  CHECK(fabric("pink-ribbon-brown", "stvk, midedge_bending") ==
        "stvk reads only the mean of its stiffness along warp and weft, not \"shear_stiffness\"; woven reads "
        "each\n");
  CHECK(fabric("cotton-broad", "stvk, hinge, quadratic_bending") ==
        "the energies of this scene read" + mean + "\"bending_hysteresis\"" + reader);
  CHECK(fabric("cotton-broad", "stvk") ==
        "no energy of this scene reads its \"warp_bending\", \"bending_hysteresis\"" + reader);
}

TEST_CASE("Border vertices at one place are named, as long as they are not welded") {
  const Scratch folder;
  const std::string file = (folder / "both.obj").string();
  const auto warnings = [&](const TriangleMesh& mesh, const std::string& levels = "levels: 1") {
    write_mesh(file, mesh);
    return warnings_of(replaced(replaced(scene_yaml("shape: file, file: " + file), "[ipc, shapes]", "[]"),
                                "levels: 1", levels));
  };
  // Two sheets side by side; the second one begins where the first one ends.
  const TriangleMesh sheet = grid({0.2, 0.2}, 4, 4, Diagonals::one_way);
  TriangleMesh both = both_of(sheet, sheet, {0.2, 1e-8, 0});
  CHECK_THAT(warnings(both),
             Contains("2: 4 border vertices lie on another one, as ") &&
                 Contains("(counted from 0) at (0.2, 0, 0): the cloth is not joined there; if "
                          "it should be, weld them in the file"));
  both.vertices.bottomRows(16).col(1).array() += 5e-6;  // near for the file's edges, far for a fine level's
  for (const char* levels : {"levels: 1", "levels: 4"})
    CHECK_THAT(warnings(both, levels), Contains("the cloth is not joined there"));
  for (const double gap : {1e-5, 1e-4, 4.9e-4}) {
    CAPTURE(gap);
    CHECK_THAT(warnings(both_of(sheet, sheet, {0.2 + gap, 0, 0})),
               Contains("2: 4 border vertices lie within 0.5 mm of another one, as ") &&
                   Contains("the cloth is not joined there; if it should be, add \"join: 0.0005\" to cloth"));
  }
  both.vertices.bottomRows(16).col(0).array() += 1e-3;
  CHECK(warnings(both) == "");
  // A border of edges that are as short has no such seam.
  const TriangleMesh fine = grid({0.2, 0.0004}, 400, 2, Diagonals::one_way);
  CHECK_THAT(warnings(fine), !Contains("is not joined there"));
}

TEST_CASE("check warns of an experiment and finds it valid all the same") {
  const std::string large = replaced(small_experiment(), "side: 1,", "side: 1000,");
  const Scratch folder(replaced(large, "point: [1, 0, 0]", "point: [1000, 0, 0]"));
  const Ended check = drape_ends("check e.yaml", folder);
  CHECK_THAT(check.err, Catch::StartsWith("warning: e.yaml:2:8: the cloth is 1000 × 1000 m; "));
  CHECK_THAT(check.out, Contains("\nRead: 1000 × 1000 m, 1 part, edges 100–140 m on level 1, "));
}

TEST_CASE(
    "A start that is far from every obstacle gets a warning, as one high above an obstacle on its side") {
  const auto body = [](const std::string& size, const std::string& middle) {
    return scene_yaml(metre, "obstacles: [{name: body, meshed_shape: box, size: [" + size +
                                 "], translate: [0.5, 0.5, " + middle + "]}]\n");
  };
  const std::string near = ", {shape: half_space, translate: [0, 0, -0.9]}]", far = ball_below(0.3, 1.2);
  const std::string moves =
      "schedule: {steps: 9, keys: [{parameter: obstacles.ball.translate, times: [0, 1], "
      "values: [[0.5, 0.5, -1.5], [0.5, 0.5, -0.4]]}]}\n";
  check_warnings({
      {scene_yaml(metre, far),
       "the cloth starts 1.2 m from the nearest obstacle, ball: sphere, farther than it is long (1 m); "},
      {scene_yaml(metre, ball_below(0.3, 0.8)), ""},
      {scene_yaml(metre, replaced(far, "]}]", "]}" + near)), ""},
      {scene_yaml(metre, far + moves), ""},
      {body("0.5, 1.7, 0.3", "-0.85"),
       "the obstacle body is 1.7 m long and 0.3 m high, and the cloth starts 0.7 m above it: does it lie on "
       "its side?"},
      {body("0.5, 1.7, 0.3", "-0.17"), ""},
      {body("0.5, 0.3, 1.7", "-0.87"), ""},
      {body("1, 1.7, 0.01", "-0.85"), ""},  // a table's top
  });
}

TEST_CASE("A pin nearest to a point far from the cloth gets a warning") {
  const std::string cloth = "shape: square, side: 1, columns: 11, rows: 11",
                    far = " away from it, at (1, 1, 0) of the rest shape; points of ";
  check_warnings({
      {scene_yaml(cloth, "pins: [{point: [0, 1, 0]}, {point: [1.04, 0.96, 0]}]\n"), ""},
      {scene_yaml(cloth, "pins:\n  - {point: [0, 1, 0]}\n  - {point: [5, 5, 0]}\n"),
       "10: the vertex nearest to \"point\" is 5.7 m" + far + "pins"},
      {scene_yaml(cloth, "handles: [{point: [1, 1, 0.5]}]\n"), "0.5 m" + far + "handles"},
  });
}

TEST_CASE("A cloth beside its obstacle is told of, and warned of where nothing else holds it") {
  const auto moved = [](const std::string& to, const std::string& more = "") {
    return scene_yaml(metre, ball_below(0.3, 0.02) + "start: {translate: [" + to + ", 0, 0]}\n" + more);
  };
  CHECK_THAT(summary_text(moved("0")), Catch::EndsWith("starts 20 mm above ball: sphere"));
  // 8 of the 20 columns of the moved cloth, and 12 of the rows, are over the box of 0.6 m.
  CHECK_THAT(summary_text(moved("0.25")),
             Catch::Matches(".* above ball: sphere, [23][0-9] % of the cloth over its "
                            "bounding box, its centre 0.25 m beside the middle of that"));
  const std::string warning =
      "the cloth's centre is over no obstacle, but 0.5 m beside that of ball: sphere: it will ";
  check_warnings({{moved("0.25"), ""},
                  {moved("0.5"), warning},
                  {scene_yaml(metre, "obstacles: [{shape: half_space, translate: [90, 0, -0.2]}]\n"), ""},
                  {moved("0.5", "pins: [{region: nearest, point: [0, 0, 0]}]\n"), ""},
                  {replaced(moved("0.5"), "]}]", "]}, {shape: half_space, translate: [0, 0, -2]}]"), ""}});
}

#include <catch2/catch.hpp>

#include "core/app/scene/scene_summary.h"
#include "core/numerics/collision_detection/intersections.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"
#include "tests/support/meshes.h"
#include "tests/support/solve.h"

using namespace drape;
using Catch::Contains;

namespace {

/// The README's square and ball, with these lines in place of its own.
std::string scene_yaml(const std::string& cloth, const std::string& more = "", double thickness = 3.18e-4,
                       const std::string& contact = "[ipc, shapes]") {
  return "name: scene\ncloth: " + cloth +
         "\nlevels: 1\nmaterial: {density: 472.6, thickness: " + ConfigNode::of(thickness).scalar +
         ", membrane_modulus: 8e4, bending_modulus: 8e4, poisson_ratio: 0.243}\n"
         "energies: [neo_hookean, hinge, gravity]\ncontact: " +
         contact + "\nmethods: {newton: {}}\n" + more;
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

/// The triangles whose centroids are below this height.
Triangles faces_below(const TriangleMesh& mesh, double height) {
  std::vector<int> kept;
  for (int t = 0; t < mesh.triangles.rows(); ++t)
    if (mesh.vertices(mesh.triangles.row(t), 2).mean() < height) kept.push_back(t);
  return mesh.triangles(kept, Eigen::all);
}

std::string summary_text(const std::string& yaml) { return text_of(summary_of(*scene_from(yaml).scene)); }

}  // namespace

TEST_CASE("Numbers have significant digits, and no exponent up to thousands") {
  CHECK(rounded_text(0.0123, 2) == "0.012");
  CHECK(rounded_text(9.96, 2) == "10");
  CHECK(rounded_text(99.7, 2) == "100");
  CHECK(rounded_text(1234, 2) == "1200");
  CHECK(rounded_text(1000, 3) == "1000");
  CHECK(rounded_text(-0.5, 2) == "-0.5");
  CHECK(rounded_text(0, 2) == "0");
  CHECK(length_text(0.0312) == "31 mm");
  CHECK(length_text(0.25) == "0.25 m");
  CHECK(length_text(1500) == "1500 m");
  CHECK(size_text({0.62, 0.7, 0}) == "0.62 × 0.7 m");
  CHECK(size_text({0.062, 0.07, 0.0015}) == "62 × 70 × 1.5 mm");
}

TEST_CASE("The summary has what a person would notice, and leaves out what a scene does not have") {
  CHECK(summary_text(scene_yaml("{shape: square, side: 1, columns: 21, rows: 21}", ball_below(0.3, 0.02))) ==
        "1 × 1 m, 1 part, edges 50–71 mm, 0.15 kg, bending length 5.4 mm (0.11 edges), d̂ 1 mm (0.02 edges), "
        "starts 20 mm above ball: sphere");
  CHECK(summary_text("name: bare\ncloth: {shape: rectangle, size: [0.3, 0.2], columns: 4, rows: 3}\nlevels: "
                     "2\nrefiner: midpoint\nenergies: [neo_hookean]\nmethods: {newton: {}}\n") ==
        "0.3 × 0.2 m, 1 part, edges 50–71 mm on level 1, 9 g");
}

TEST_CASE("The summary names the nearest obstacle, of either contact model, and where the cloth is") {
  const auto starts = [](const std::string& obstacles) {
    const std::string text = summary_text(
        scene_yaml("{shape: square, side: 1, columns: 5, rows: 5}", "obstacles: [" + obstacles + "]\n"));
    return text.substr(text.find("starts"));
  };
  const std::string box =
                        "{name: lid, meshed_shape: box, size: [0.2, 0.2, 0.2], translate: [0.5, 0.5, 0.15]}",
                    floor = "{name: floor, shape: half_space, translate: [50, 50, -0.2]}",
                    post = "{name: post, shape: capsule, radius: 0.1, height: 2, translate: [1.4, 0.5, 0]}";
  CHECK(starts(box + ", " + floor) == "starts 50 mm below lid");
  CHECK(starts(floor + ", " + post) == "starts 0.2 m above floor: half_space");
  CHECK(starts(post) == "starts 0.3 m beside post: capsule");
}

TEST_CASE("The connection of two meshes is between the nearest points of a vertex and a triangle") {
  TriangleMesh sheet = grid({1, 1}, 2, 2, Diagonals::one_way), box = unit_box();
  box.vertices.rowwise() += Eigen::RowVector3d(0.3, 0.3, -0.6);
  CHECK(shortest_connection(sheet, box).isApprox(Eigen::Vector3d(0, 0, 0.1), 1e-12));
  CHECK(shortest_connection(box, sheet).isApprox(Eigen::Vector3d(0, 0, -0.1), 1e-12));
}

TEST_CASE("What no fabric has gets a warning that says what is usual, before a run") {
  const std::string square = "{shape: square, side: 1, vertices: 400}";
  CHECK(warnings_of(scene_yaml(square, ball_below(0.3, 0.02))) == "");
  // A cloth in millimetres.
  CHECK_THAT(
      warnings_of(scene_yaml("{shape: square, side: 1000, vertices: 900}")),
      Contains("2: the cloth is 1000 × 1000 m; fabric is usually between 0.05 and 10 m wide, and lengths "
               "are in metres; if its lengths are in millimetres, divide every length by 1000\n"));
  const std::string around = "obstacles: [{name: crate, meshed_shape: box, size: [3, 3, 3]}]\n";
  CHECK_THAT(warnings_of(scene_yaml(square, around)), Contains("the cloth starts inside the obstacle crate"));
  const Scratch folder;
  TriangleMesh tray = unit_box();  // without its lid
  tray.triangles = faces_below(tray, 0.4);
  write_mesh(folder / "tray.ply", tray);
  CHECK(warnings_of(scene_yaml(square, "obstacles: [{name: tray, scale: 3, mesh: " +
                                           (folder / "tray.ply").string() + "}]\n")) == "");
  CHECK_THAT(warnings_of(replaced(scene_yaml(square), "neo_hookean, ", "")),
             Contains("no energy resists stretching"));
  // In centimetres, or in one of two units, or in none.
  const auto remedy = [](const std::string& cloth) {
    const std::string text = warnings_of(scene_yaml("{" + cloth + ", vertices: 900}")),
                      before = "lengths are in metres; ";
    const std::size_t from = text.find(before) + before.size();
    return text.substr(from, text.find('\n', from) - from);
  };
  CHECK(remedy("shape: rectangle, size: [120, 80]") ==
        "if its lengths are in centimetres, divide every length by 100");
  CHECK(remedy("shape: square, side: 60") ==
        "if its lengths are in centimetres, divide every length by 100; if in inches, multiply every length "
        "by 0.0254");
  CHECK(remedy("shape: square, side: 10000") == "choose a smaller size");
  CHECK(remedy("shape: polygon, loops: [{points: [0, 0, 120, 0, 120, 80, 0, 80]}]") ==
        "if its lengths are in centimetres, write \"unit: cm\"");
  CHECK(remedy("shape: polygon, unit: cm, loops: [{points: [0, 0, 9e3, 0, 9e3, 8e3, 0, 8e3]}]") ==
        "choose a smaller size");
  CHECK(remedy("shape: polygon, unit: inch, loops: [{points: [0, 0, 2200, 0, 2200, 900, 0, 900]}]") ==
        "if its lengths are in millimetres, write \"unit: mm\"");
  CHECK_THAT(warnings_of(scene_yaml("{shape: square, side: 1e-3, vertices: 900}")),
             Contains("2: the cloth is 1 × 1 mm"));
  // A thickness in millimetres, and half of one.
  CHECK_THAT(
      warnings_of(scene_yaml(square, "", 0.318)),
      Contains("4: a square metre of the cloth has 150 kg") && Contains("fabric usually has 0.02 to 2 kg"));
  CHECK_THAT(warnings_of(scene_yaml(square, "", 2e-6)), Contains("has 0.00095 kg"));
  // Bending.
  const auto bending = [&](const std::string& modulus, const std::string& cloth) {
    return warnings_of(replaced(scene_yaml(cloth), "bending_modulus: 8e4", "bending_modulus: " + modulus));
  };
  CHECK(bending("0", square) == "");
  CHECK(bending("8e6", square) == "");
  CHECK_THAT(bending("8e12", square), Contains("4: weight bends this cloth over a length of "));
  CHECK_THAT(bending("8e10", "{shape: square, side: 0.02, vertices: 10000}"),
             Contains("of level 0; 2 to 20 are usual"));
  CHECK_THAT(warnings_of(scene_yaml("{shape: square, side: 30, vertices: 25}")),
             Contains("2: the bending length of 5.4 mm is 0.00072 edges of level 0"));
  // Measured stiffness that the energies do not read.
  const auto measured = [&](const std::string& keys, const std::string& energies) {
    return warnings_of(replaced(replaced(scene_yaml(square), "0.243}", "0.243, " + keys + "}"),
                                "neo_hookean, hinge", energies));
  };
  const std::string all =
      "warp_stiffness: 30, weft_stiffness: 20, shear_stiffness: 2, warp_bending: 1e-6, weft_bending: 2e-6, "
      "bias_bending: 1e-6, bending_hysteresis: 1e-4";
  CHECK(measured(all, "woven, midedge_bending") == "");
  CHECK(measured("warp_stiffness: 30, warp_bending: 2e-6", "neo_hookean, hinge") == "");
  CHECK(measured("bending_hysteresis: 1e-4", "neo_hookean, hinge") ==
        "4: no energy of this scene reads \"bending_hysteresis\"; midedge_bending does\n");
  CHECK(measured(all, "stvk, quadratic_bending") ==
        "4: no energy of this scene reads \"shear_stiffness\"; woven does\n"
        "4: no energy of this scene reads \"bias_bending\", \"bending_hysteresis\"; midedge_bending does\n");
  CHECK(measured(
            "warp_stiffness: 30",
            "{type: woven, warp_tension: [0.02, 3, 0.08, 200], weft_tension: [0.02, 3, 0.08, 200]}, hinge") ==
        "4: no energy of this scene reads \"warp_stiffness\"\n");
  // Those of a fabric, of which the user has written none.
  const auto fabric = [&](const std::string& name, const std::string& energies) {
    return warnings_of("name: scene\ncloth: " + square + "\nlevels: 1\nmaterial: {fabric: " + name +
                       "}\nenergies: [" + energies + ", gravity]\nmethods: {newton: {}}\n");
  };
  CHECK(fabric("pink-ribbon-brown", "stvk, midedge_bending") == "");
  CHECK(fabric("pink-ribbon-brown", "stvk, hinge") ==
        "4: fabric \"pink-ribbon-brown\": hinge reads only the mean of its bending along warp and weft, not "
        "\"bias_bending\"; midedge_bending reads each\n");
  CHECK(fabric("cotton-broad", "stvk, hinge, quadratic_bending") ==
        "4: fabric \"cotton-broad\": the energies of this scene read only the mean of its bending along warp "
        "and weft, not \"bending_hysteresis\"; midedge_bending reads each\n");
  CHECK(fabric("cotton-broad", "stvk") ==
        "4: fabric \"cotton-broad\": no energy of this scene reads its \"warp_bending\", "
        "\"bending_hysteresis\"; midedge_bending reads each\n");
  CHECK(fabric("cotton", "stvk, hinge") == "");
  // d̂ above an edge.
  CHECK_THAT(warnings_of(scene_yaml(square, "", 3.18e-4, "[{type: ipc, dhat: 0.1}]")),
             Contains("contact distance dhat of 0.1 m is longer than most edges of level 0 (53 mm)"));
  // A start that is not the cloth's.
  CHECK_THAT(warnings_of(scene_yaml(square, "start: {scale: [0.1, 0.1, 0.1]}\n")),
             Contains("the start has 0.1 times the lengths of the rest shape") && Contains("1 is usual"));
  // An obstacle in centimetres.
  CHECK_THAT(warnings_of(scene_yaml(square, ball_below(85, 0.02))),
             Contains("the obstacle ball: sphere is 170 × 170 × 170 m and the cloth 1 × 1 m"));
}

TEST_CASE("Border vertices at one place are named, as long as they are not welded") {
  const Scratch folder;
  // Two sheets side by side; the second one begins where the first one ends.
  const TriangleMesh sheet = grid({0.3, 0.3}, 4, 4, Diagonals::one_way);
  TriangleMesh both = both_of(sheet, sheet, {0.3, 1e-8, 0});
  write_mesh(folder / "both.obj", both);
  const std::string cloth = "{shape: file, file: " + (folder / "both.obj").string() + "}";
  CHECK_THAT(warnings_of(scene_yaml(cloth, "", 3.18e-4, "[]")),
             Contains("2: 4 border vertices lie on another one, as ") &&
                 Contains("(counted from 0) at (0.3, 0, 0): the cloth is not joined there; if it should be, "
                          "weld them in the file"));
  both.vertices.bottomRows(16).col(1).array() += 5e-6;  // near for the file's edges, far for a fine level's
  write_mesh(folder / "both.obj", both);
  for (const char* levels : {"levels: 1", "levels: 4"})
    CHECK_THAT(warnings_of(replaced(scene_yaml(cloth, "", 3.18e-4, "[]"), "levels: 1", levels)),
               Contains("the cloth is not joined there"));
  both.vertices.bottomRows(16).col(0).array() += 1e-3;
  write_mesh(folder / "both.obj", both);
  CHECK(warnings_of(scene_yaml(cloth, "", 3.18e-4, "[]")) == "");
}

TEST_CASE("check warns of an experiment and finds it valid all the same") {
  const std::string large = replaced(small_experiment(), "side: 1,", "side: 1000,");
  const Scratch folder(replaced(large, "point: [1, 0, 0]", "point: [1000, 0, 0]"));
  const Ended check = drape_ends("check e.yaml", folder);
  CHECK_THAT(check.err, Catch::StartsWith("warning: e.yaml:2:8: the cloth is 1000 × 1000 m; "));
  CHECK_THAT(check.out, Contains("\nRead: 1000 × 1000 m, 1 part, edges 100–140 m on level 1, "));
}

TEST_CASE("A pin nearest to a point far from the cloth gets a warning") {
  const std::string cloth = "{shape: square, side: 1, columns: 11, rows: 11}";
  CHECK(warnings_of(scene_yaml(cloth, "pins: [{point: [0, 1, 0]}, {point: [1.04, 0.96, 0]}]\n")).empty());
  const std::string far = " away from it, at (1, 1, 0) of the rest shape; points of ";
  CHECK_THAT(warnings_of(scene_yaml(cloth, "pins:\n  - {point: [0, 1, 0]}\n  - {point: [5, 5, 0]}\n")),
             Contains("10: the vertex nearest to \"point\" is 5.7 m" + far + "pins"));
  CHECK_THAT(warnings_of(scene_yaml(cloth, "handles: [{point: [1, 1, 0.5]}]\n")),
             Contains("0.5 m" + far + "handles"));
}

// Sewing patterns by the command: the project's own, pins by label, and the faults of others, each in a
// sentence.

#include "tests/configs/runs.h"

namespace {

const std::string of_pattern =
    "name: sewn\nlevels: 2\ncloth: {shape: pattern, file: p.yaml, edge_length: 0.04}\nenergies: [stvk, "
    "hinge]\nmethods: {pcs: {}}\n";

/// Two squares of 20 cm that are sewn along three sides, on lines of their own: 4 for the front, 9 for the
/// back.
struct Bag {
  std::string front = "{0: [0, 0], 1: [20, 0], 2: [20, 20], 3: [0, 20]}";
  std::string front_edges =
      "{bottom: [0, 1], right: [1, 2], top: {endpoints: [2, 3], label: rim}, left: [3, 0]}";
  std::string stitches =
      "{left: [front.left, back.left], bottom: [front.bottom, back.bottom], right: [front.right, "
      "back.right]}";
};

std::string pattern(const Bag& bag) {
  return "properties: {units_in_meter: 100}\npattern:\n  panels:\n    front:\n      translation: [0, 0, 5]\n "
         "     vertices: " +
         bag.front + "\n      edges: " + bag.front_edges +
         "\n    back:\n      vertices: [[0, 0], [0, 20], [20, 20], [20, 0]]\n      edges: {left: [0, 1], "
         "top: [1, 2], right: [2, "
         "3], bottom: [3, 0]}\n  stitches: " +
         bag.stitches + "\n";
}

/// What a check of this pattern says, which must be refused; "FILE" stands for the pattern's file.
std::string refused_pattern(const std::string& text) {
  const Scratch folder(of_pattern);
  folder.write("p.yaml", text);
  const std::string said = refused(folder, "check e.yaml");
  CHECK(std::count(said.begin(), said.end(), '\n') == 1);
  return said;
}

}  // namespace

TEST_CASE("drape check reads every pattern of the project, and says pieces, seams and vertices") {
  for (const auto& [name, pieces] :
       {std::pair("tshirt", 6), {"shirt", 10}, {"skirt", 4}, {"trousers", 4}, {"bag", 4}}) {
    const Scratch folder(of_pattern);
    const fs::path file = folders::source() / "configs/garments" / (std::string(name) + ".yaml");
    const std::string said = shown_by("check e.yaml --set cloth.file=" + file.string(), folder.path);
    CAPTURE(name, said);
    CHECK_THAT(said, Contains("valid. Vertices by level: ") && Contains("1 part") &&
                         Contains("cloth: " + std::to_string(pieces) + " flat pieces, ") &&
                         Contains(" m of seams"));
  }
}

TEST_CASE("a pattern in JSON is the one in YAML, whatever else its file has") {
  const Scratch folder(of_pattern);
  folder.write("p.yaml", pattern({}));
  folder.write(
      "p.json",
      "{\"pattern\": {\"panels\": {\"front\": {\"translation\": [0, 0, 5], \"rotation\": [0, 0, 0], "
      "\"vertices\": [[0, 0], "
      "[20, 0], [20, 20], [0, 20]], \"label\": \"body\", \"edges\": [{\"endpoints\": [0, 1]}, "
      "{\"endpoints\": [1, 2]}, "
      "{\"endpoints\": [2, 3], \"label\": \"rim\"}, {\"endpoints\": [3, 0]}]}, \"back\": {\"translation\": "
      "[0, 0, 0], "
      "\"rotation\": [0, 0, 0], \"vertices\": [[0, 0], [0, 20], [20, 20], [20, 0]], \"edges\": "
      "[{\"endpoints\": [0, 1]}, "
      "{\"endpoints\": [1, 2]}, {\"endpoints\": [2, 3]}, {\"endpoints\": [3, 0]}]}}, \"stitches\": "
      "[[{\"panel\": \"front\", "
      "\"edge\": 3}, {\"panel\": \"back\", \"edge\": 0}], [{\"panel\": \"front\", \"edge\": 0}, {\"panel\": "
      "\"back\", \"edge\": "
      "3}], [{\"panel\": \"front\", \"edge\": 1}, {\"panel\": \"back\", \"edge\": 2}]], \"panel_order\": "
      "[\"front\", "
      "\"back\"]}, \"parameters\": {}, \"parameter_order\": [], \"properties\": {\"curvature_coords\": "
      "\"relative\", "
      "\"normalize_panel_translation\": false, \"units_in_meter\": 100, \"normalized_edge_loops\": true}}\n");
  const std::string run = "--quiet --no-report --measure -j 1 --set newton.force_tolerance=1e9 ";
  drape_ends("run e.yaml --out a " + run, folder);
  drape_ends("run e.yaml --set cloth.file=p.json --out b " + run, folder);
  check_same_files(folder / "a", folder / "b", {"rest/l0.ply", "rest/l1.ply"});
}

TEST_CASE("pins select the edges of a label on every level, and the run's own config keeps them") {
  const Scratch folder(of_pattern + "pins: [{region: label, label: rim}]\n");
  folder.write("p.yaml", pattern({}));
  run_into("out", folder, "-j 1");
  const std::string config = text_of(folder / "out/config.yaml");
  CHECK_THAT(config, Contains("label_edges: [") && Contains("label: rim"));
  drape_ends("run out/config.yaml --quiet --no-report --measure -j 1 --out again", folder);
  check_same_files(folder / "out", folder / "again",
                   {"rest/l0.ply", "levels/pcs_l0.ply", "levels/pcs_l1.ply"});
  check_error(refused(folder, "check e.yaml --set pins.0.label=waist"),
              "e.yaml:6:8: no edge of the cloth has the label \"waist\"; the pattern has rim");
}

TEST_CASE("patterns that cannot be sewn are refused with file, line, panel and edge") {
  const auto said = [](auto Bag::*part, const std::string& text) {
    Bag bag;
    bag.*part = text;
    return refused_pattern(pattern(bag));
  };
  // An edge and a panel that are not there.
  check_error(said(&Bag::stitches, "{left: [front.lfet, back.left]}"),
              "p.yaml:11:21: seam left: panel front has no edge \"lfet\"; did you mean \"left\"?");
  check_error(said(&Bag::stitches, "[[{panel: front, edge: 4}, {panel: back, edge: 0}]]"),
              "p.yaml:11:36: seam 0: panel front has no edge 4; it has bottom, right, top, left");
  check_error(said(&Bag::stitches, "{left: [fornt.left, back.left]}"),
              "p.yaml:11:21: seam left: there is no panel \"fornt\"; did you mean \"front\"?");
  check_error(said(&Bag::stitches, "{left: [front.left]}"), "p.yaml:11:14: seam left needs two sides");
  check_error(said(&Bag::stitches, "left"), "p.yaml:11:13: seam must be a list or a map, not \"left\"");
  // Loops that do not close, that cross themselves, that are empty.
  check_error(said(&Bag::front_edges, "{bottom: [0, 1], right: [1, 2], left: [3, 0]}"),
              "p.yaml:7:46: panel front: edge left begins at vertex 3, but the one before ends at 2: the "
              "edges do not close");
  check_error(said(&Bag::front_edges, "{bottom: [0, 1], right: [1, 2], top: [2, 3]}"),
              "p.yaml:7:46: panel front: edge top ends at vertex 3, but its loop began at 0: the edges do "
              "not close a loop");
  check_error(
      said(&Bag::front, "{0: [0, 0], 1: [20, 0], 2: [0, 20], 3: [20, 20]}"),
      "p.yaml:7:84: panel front: edges right and left cross or touch; an outline must not meet itself");
  check_error(said(&Bag::front, "[]"),
              "p.yaml:6:17: panel front: it is empty: it has 0 vertices, and needs three");
  check_error(said(&Bag::front_edges, "[]"), "p.yaml:7:14: panel front: it is empty: it has no edges");
  check_error(
      said(&Bag::front_edges, "{bottom: [0, 4]}"),
      "p.yaml:7:27: panel front: edge bottom ends at vertex 4, which is not there; it has 0, 1, 2, 3");
  check_error(said(&Bag::front_edges, "{bottom: [0, 1], bottom: [1, 2]}"),
              "p.yaml:7:31: panel front: bottom is given twice; rename one");
  check_error(said(&Bag::front_edges, "[{endpoints: [0, 1], name: hem}, {endpoints: [1, 2], name: hem}]"),
              "p.yaml:7:47: panel front: edge hem is given twice; rename one");
  check_error(said(&Bag::front, "[[1e400, 0], [20, 0], [20, 20]]"),
              "p.yaml:6:18: panel front: a vertex is [x, y], two numbers of at most 1e+09, not [1e400, 0]");
  check_error(said(&Bag::stitches, "{a: [front.left, back.left], a: [front.right, back.right]}"),
              "p.yaml:11:42: seam a is given twice; rename one");
  // Stitched twice, lengths that differ, one side, curves of no known kind.
  check_error(said(&Bag::stitches, "{left: [front.left, back.left], again: [front.left, back.top]}"),
              "p.yaml:11:45: edge left of panel front is in seam again and in seam left; an edge is sewn to "
              "one other");
  check_error(said(&Bag::front, "{0: [0, 0], 1: [20, 0], 2: [20, 20], 3: [0, 130]}"),
              "p.yaml:11:14: the sides of seam left are 130 and 20 long in the file's unit, which differ by "
              "84.6 % of "
              "the longer one; an ease of at most 80 % is usual: draw them alike, or write \"ease\"");
  check_error(
      said(&Bag::stitches, "{left: [front.left, back.left], right: [front.right, back.right, right_wrong]}"),
      "p.yaml:11:45: seam right gives the cloth one side, as a Möbius band has");
  check_error(
      said(&Bag::front_edges, "{bottom: {endpoints: [0, 1], curvature: {type: spiral, params: [1]}}}"),
      "p.yaml:7:61: \"type\" must be \"quadratic\", \"cubic\" or \"circle\", not \"spiral\"");
  check_error(
      said(&Bag::front_edges, "{bottom: {endpoints: [0, 1], curvature: {type: circle, params: [9, 0, 1]}}}"),
      "p.yaml:7:77: panel front: edge bottom: no circle of that radius has both of its ends; at least 10");
  check_error(refused_pattern("properties: {units_in_meter: 100}\npattern: {panels: {}}\n"),
              "p.yaml:2:19: the pattern has no panels");
  check_error(refused_pattern("properties: {up: z}\npattern: {panels: {}}\n"),
              "p.yaml:1:13: \"units_in_meter\" in properties is required and missing");
}

TEST_CASE("panels whose loops enclose no area or whose edges have no length are refused by name") {
  const auto said = [](const std::string& vertices, const std::string& edges) {
    return refused_pattern("properties: {units_in_meter: 100}\npattern:\n  panels:\n    front: {vertices: [" +
                           vertices + "], edges: [" + edges + "]}\n");
  };
  const std::string in = "p.yaml:4:12: panel front: ";
  const std::string none = " encloses no area: its points at this \"edge_length\" lie on one line";
  for (const auto& [vertices, edges] :
       Refusals{{"[0, 0], [5, 0], [10, 0]", "[0, 1], [1, 2], [2, 0]"},
                {"[0, 0], [10, 30], [5, 15], [7, 21]", "[0, 1], [1, 3], [3, 2], [2, 0]"},
                {"[0, 0], [20, 0], [20, 20]", "[0, 1], [1, 0]"},
                {"[0, 0], [1, 0], [20, 20]", "[0, 1], [1, 0]"},
                {"[0, 0], [20, 0], [20, 20]", "{endpoints: [0, 1], curvature: [0.5, 0]}, [1, 0]"},
                {"[0, 0], [20, 0], [20, 20]",
                 "{endpoints: [0, 1], curvature: {type: cubic, params: [[0.3, 0], [0.6, 0]]}}, [1, 0]"}})
    check_error(said(vertices, edges), in + "the outline" + none);
  const std::string square = "[0, 0], [20, 0], [20, 20], [0, 20], ",
                    outline = "[0, 1], [1, 2], [2, 3], [3, 0], ";
  check_error(said(square + "[5, 5], [9, 5], [7, 5]", outline + "[4, 5], [5, 6], [6, 4]"),
              in + "hole 1" + none);
  check_error(said(square + "[50, 50], [90, 50], [90, 90]", outline + "[4, 5], [5, 6], [6, 4]"),
              "p.yaml:4:131: panel front: the hole that begins with edge 4 lies outside the outline");
  for (const std::string near : {"[20, 1e-12]", "[20, 1e-320]"})
    CHECK_THAT(said("[0, 0], [20, 0], " + near, "[0, 1], [1, 2], [2, 0]"),
               Contains(": panel front: edge 1 is ") && Contains(" m long, of at least 1e-09 and at most "));
  CHECK_THAT(said("[0, 0], [1e9, 0], [0, 1e9]", "[0, 1], [1, 2], [2, 0]"),
             Contains(": panel front: edge 0 is 1e+07 m long, of at least 1e-09 and at most 1e+06"));
}

TEST_CASE(
    "what is no pattern, what a panel has not, and what seams cannot fold are refused with what there is") {
  const Scratch folder(of_pattern);
  for (const auto& [file, fault] :
       Refusals{{"skirt.dxf", "is a DXF drawing, which does not say what is sewn to what; "},
                {"a.SVG", "is an SVG drawing, which does not say what is sewn to what; "},
                {"b.val", "is a Valentina pattern, which does not say what is sewn to "},
                {"c.obj", "is a mesh, and no pattern; read it by \"shape: file\""}}) {
    folder.write(file, "0\nSECTION\n");
    check_error(refused(folder, "check e.yaml --set cloth.file=" + file), file + ": " + fault);
  }
  check_error(refused(folder, "check e.yaml --set cloth.file=none.dxf"), "none.dxf: no such file");
  const std::string triangle = "vertices: {a: [0, 0], b: [20, 0], c: [20, 20]}, edges: ";
  const auto said = [](const std::string& panel) {
    return refused_pattern("properties: {units_in_meter: 100}\npattern:\n  panels:\n    front: {" + panel +
                           "}\n");
  };
  for (const std::string key : {"fabric", "buttons", "pleats", "mirror"})
    check_error(said(key + ": 3, " + triangle + "{x: [a, b], y: [b, c], z: [c, a]}"),
                "p.yaml:4:13: panel front: there is no \"" + key + "\"; ");
  CHECK_THAT(
      said(triangle + "{x: [a, b], z: [c, a], y: [b, c]}"),
      Contains("the edges do not close a loop; their order in the map counts, each begins where the one "
               "before ends: a list keeps it where a program sorts keys"));
  CHECK_THAT(
      said(triangle + "[[a, b], [c, a], [b, c]]"),
      Contains("the edges do not close a loop; their order counts, each begins where the one before ends\n"));
  check_error(refused_pattern(
                  "properties: {units_in_meter: 100}\npattern:\n  panels:\n    front: {vertices: {a: [0, "
                  "0], b: [60, 0], c: [60, 40], d: [35, 40], e: [30, 40], f: [25, 40], g: [0, 40]}, edges: "
                  "{hem: [a, b], right: [b, c], t1: [c, d], t2: [d, e], t3: [e, f], t4: [f, g], left: [g, "
                  "a]}}\n  stitches: {tuck: [front.t2, front.t3]}\n"),
              "p.yaml:5:14: seam tuck sews the neighbouring edges t2 and t3 of panel front to each other, "
              "which would "
              "fold a tuck; there are no tucks and pleats: gather the edge by the \"ease\" of a seam");
}

TEST_CASE("a seam gathers its longer side, up to five to one, and says so beyond three tenths") {
  const Scratch folder(of_pattern);
  const auto checked = [&](const std::string& width, const std::string& more = "") {
    folder.write(
        "p.yaml",
        "properties: {units_in_meter: 100}\npattern:\n  panels:\n    band: {translation: [0, 0, 10], "
        "vertices: {a: [0, 0], b: [20, 0], c: [20, 6], d: [0, 6]}, edges: {bottom: [a, b], right: [b, "
        "c], top: [c, d], left: [d, a]}}\n    ruffle: {vertices: {a: [0, 0], b: [" +
            width + ", 0], c: [" + width +
            ", -9], d: [0, -9]}, edges: {top: [b, a], left: [a, d], hem: [d, c], right: [c, b]}}\n  "
            "stitches: {gather: [ruffle.top, band.bottom]}\n");
    return drape_with("check e.yaml --set levels=1 --set cloth.edge_length=0.02 " + more, folder.path);
  };
  CHECK_THAT(checked("28").out, !Contains("gathers"));
  const std::string remark = "cloth: seam gather gathers a length of 60 to 20, in the file's unit";
  const Ended ended = checked("60");
  CHECK(ended.exit_code == 0);
  CHECK_THAT(ended.out + ended.err, Contains(remark));
  CHECK_THAT(checked("60", "--set cloth.ease=0.5").err,
             Contains("differ by 66.7 % of the longer one; an ease of at most 50 % is declared"));
  CHECK(checked("130", "--set cloth.ease=0.9").exit_code == 0);
  CHECK(checked("130").exit_code == 2);
  CHECK(checked("130", "--set cloth.edge_length=0.6").exit_code == 0);  // within two edges of the mesh
}

TEST_CASE("a seam that gathers a panel in its plane says to place the other one out of it") {
  const Scratch folder(of_pattern + "contact: {type: ipc, dhat: 0.001}\n");
  const auto gathered = [&](const std::string& forwards) {
    folder.write(
        "p.yaml",
        "properties: {units_in_meter: 100}\npattern:\n  panels:\n    band: {translation: [0, 38, " +
            forwards +
            "], vertices: {a: [-20, 0], b: [20, 0], c: [20, 6], d: [-20, 6]}, edges: {bottom: [a, b], "
            "right: [b, c], top: [c, d], left: [d, a]}}\n    ruffle: {vertices: {a: [-50, 0], b: [50, "
            "0], c: [50, 38], d: [-50, 38]}, edges: {bottom: [a, b], right: [b, c], top: [c, d], "
            "left: [d, a]}}\n  stitches: {gather: {sides: [ruffle.top, band.bottom], ease: 0.7}}\n");
    return drape_with("check e.yaml --set levels=1 --set cloth.edge_length=0.02", folder.path);
  };
  CHECK_THAT(
      gathered("0").err,
      EndsWith(
          "; where a seam gathers a panel in the plane of the other, the panel folds over itself: place the "
          "shorter one out of that plane, as a band in front of the cloth, by \"translation\"\n"));
  CHECK(gathered("10").exit_code == 0);
}

TEST_CASE("a panel's name may have blanks, and what a file of meshes could not hold is refused") {
  const auto named = [](const std::string& left, const std::string& right) {
    return "properties: {units_in_meter: 1}\npattern:\n  panels:\n    \"" + left +
           "\": {vertices: [[0, 0], [1, 0], [1, 1], [0, 1]], edges: [[0, 1], [1, 2], [2, 3], [3, 0]]}\n    "
           "\"" +
           right +
           "\": {vertices: [[0, 0], [1, 0], [1, 1], [0, 1]], edges: [[0, 1], [1, 2], [2, 3], [3, 0]],"
           " translation: [1, 0, 0]}\n  stitches: [[\"" +
           left + ".1\", \"" + right + ".3\"]]\n";
  };
  for (const std::string name : {"a\\nend_header", "a\\e[2J", "", " a"})
    CHECK_THAT(refused_pattern(named(name, "b")), Contains(": a panel's name needs letters"));
  const Scratch folder(of_pattern);
  folder.write("p.yaml", named("front left", "back"));
  drape_ends("run e.yaml -o out -q --set cloth.edge_length=0.3 --set levels=1", folder);
  drape_ends("export out --to a.obj", folder);
  CHECK_THAT(text_of(folder / "a.obj"), Contains("\ng front_left\n") && Contains("\ng back\n"));
}

TEST_CASE("a pattern is meshed to a length of edges, or to about a number of vertices, within bounds") {
  const Scratch folder(of_pattern);
  folder.write("p.yaml", pattern({}));
  CHECK_THAT(shown_by("check e.yaml --set cloth.edge_length=null --set cloth.vertices=500 --set levels=1",
                      folder.path),
             Catch::Matches("[^]*Vertices by level: 4[0-9][0-9]\n[^]*"));
  check_error(refused(folder, "check e.yaml --set cloth.edge_length=1e-6"),
              "e.yaml:3:8: \"edge_length\" of 1e-06 m would give about 9.2e+10 vertices within 0.08 m²; a "
              "coarsest level has at most 1e+07: take 9.71e-05 m or more, if the unit is right");
  folder.write("p.yaml", replaced(pattern({}), "units_in_meter: 100", "units_in_meter: 0.1"));
  CHECK_THAT(drape_ends("check e.yaml --set cloth.edge_length=40", folder).err,
             Contains("the cloth is 200 × ") && Contains("check \"units_in_meter\" in the pattern's file"));
}

// What the command says to bad input: the exact lines. Nothing may be written in any of these cases.

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <map>

#include "core/app/view/live_server.h"
#include "tests/support/command.h"
#include "tests/support/live_client.h"

namespace fs = std::filesystem;

namespace {

std::map<std::string, std::string> files_in(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    files[entry.path().string()] = entry.is_regular_file() ? text_of(entry.path()) : "";
  return files;
}

/// Standard error of a command that must be refused and leave the folder as it was.
std::string refused(const Scratch& folder, const std::string& arguments) {
  const auto before = files_in(folder.path);
  const std::string said = refused_by(arguments, folder.path);
  CHECK((files_in(folder.path) == before));
  return said;
}

/// The same of `drape run e.yaml`, where e.yaml is this text.
std::string said_of(const std::string& experiment, const std::string& arguments = "") {
  const Scratch folder(experiment);
  return refused(folder, "run e.yaml --out out " + arguments);
}

std::string said_of_edit(const std::string& from, const std::string& to) {
  return said_of(replaced(small_experiment(), from, to));
}

/// A text of the experiment, what stands there instead, and the refusal after "error: e.yaml:".
struct Edit {
  std::string from, to, refusal;
};

void check_refused(const std::vector<Edit>& edits) {
  for (const Edit& edit : edits)
    CHECK(said_of_edit(edit.from, edit.to) == "error: e.yaml:" + edit.refusal + "\n");
}

const std::string top_keys =
    "name, description, cloth, levels, material, start, pins, handles, schedule, energies, "
    "refiner, contact, obstacles, friction, newton, "
    "methods, metrics, reference, snapshots, check_intersections";

}  // namespace

TEST_CASE("the base file of these cases is valid: each case has exactly one fault") {
  const Scratch folder(small_experiment());
  CHECK_THAT(shown_by("check e.yaml", folder.path),
             Catch::Matches("e\\.yaml: valid\\. Vertices by level: 36, 121\n"
                            "Memory to solve them, at most about: 0\\.1 GB, 0\\.1 GB; this machine has "
                            "[0-9.]+ GB\n"
                            "Read: 1 × 1 m, 1 part, edges 0\\.1–0\\.14 m on level 1, .*\n"));
}

TEST_CASE("a config that is missing, a folder, empty or no YAML") {
  const Scratch folder;
  CHECK(refused(folder, "run e.yaml --out out") == "error: e.yaml: no such file\n");
  CHECK(refused(folder, "check e.yaml") == "error: e.yaml: no such file\n");
  CHECK(refused(folder, "run . --out out") == "error: .: is a folder, not a file\n");
  CHECK(said_of("") == "error: e.yaml: is empty; a config is a map of keys and values\n");
  CHECK(said_of("- name\n") == "error: e.yaml:1:1: a config must begin with a map of keys and values\n");
  CHECK(said_of_edit("[0.9, 0.9, 1]", "[0.9, 0.9, 1") ==
        "error: e.yaml:4:48: not valid YAML: illegal flow end\n");
}

TEST_CASE("a config that is not a regular file is refused without blocking") {
  const Scratch folder;
  REQUIRE(mkfifo((folder / "pipe.yaml").c_str(), 0600) == 0);
  for (const std::string command :
       {"check pipe.yaml", "run pipe.yaml --out out", "sweep pipe.yaml --out out"})
    CHECK(refused_by(command, folder.path) ==
          "error: pipe.yaml: is a pipe or a device; give a file on a disk\n");
  CHECK(refused(folder, "check /dev/zero") ==
        "error: /dev/zero: is a pipe or a device; give a file on a disk\n");
  folder.write("e.yaml", small_experiment());
  fs::resize_file(folder / "e.yaml", 100000000);
  CHECK(refused_by("check e.yaml", folder.path) ==
        "error: e.yaml: is larger than 8 MB, the most that is read of it\n");
  fs::remove(folder / "e.yaml");
  fs::create_directory(folder / "out");
  for (const std::string name : {"results.json", "sweep.json"}) {
    REQUIRE(mkfifo((folder / ("out/" + name)).c_str(), 0600) == 0);
    for (const std::string command : {"report out", "table out", "compare out out", "run --resume out"}) {
      const Ended ended = drape_with(command, folder.path);
      CAPTURE(command, ended.err);
      CHECK(ended.exit_code == 2);
    }
    fs::remove(folder / ("out/" + name));
  }
}

TEST_CASE("a start or a reference that is no regular file, or is not finite") {
  const Scratch folder(small_experiment());
  REQUIRE(mkfifo((folder / "pipe.ply").c_str(), 0600) == 0);
  for (const std::string key : {"start", "reference"}) {
    const std::string said = drape_with("check e.yaml --set '" + key + "={file: pipe.ply}'", folder.path).err;
    CHECK_THAT(said, Catch::Contains("pipe.ply: is a pipe or a device"));
  }
  drape_ends("run e.yaml --out out --quiet --no-report --levels 1 --method pcs", folder);
  const std::string rest = text_of(folder / "out/rest/l0.ply");
  const std::size_t third_vertex = rest.find("end_header\n") + 11 + 3 * 24;
  const auto said_with = [&](double coordinate) {
    std::string start = rest;
    std::memcpy(start.data() + third_vertex, &coordinate, sizeof coordinate);
    folder.write("start.ply", start);
    return drape_with("check e.yaml --set start.file=start.ply", folder.path).err;
  };
  CHECK(said_with(std::nan("")) ==
        "error: e.yaml:4:8: start.ply: vertex 3 (counted from 0) has a coordinate that is not finite\n");
  CHECK(said_with(1e11) ==
        "error: e.yaml:4:8: start.ply: 1 vertex has too large a coordinate: 3 with 1e+11 m (counted from 0); "
        "at most 1e+09 m can be computed with: is the file in metres?\n");
  CHECK(said_with(0.1) == "");
  CHECK_THAT(
      drape_with("check e.yaml --set cloth.side=0.1 --set 'start.translate=[9e8, 0, 0]'", folder.path).err,
      Catch::Contains("the start of level 0: the mesh is 0.127 m across and 9e+08 m from the "
                      "origin, where rounding moves vertices by 2e-07 m; move it nearer\n"));
}

TEST_CASE("output is short for any number and length of errors") {
  std::string text = small_experiment();
  for (int k = 0; k < 20000; ++k) text += "key_" + std::to_string(k) + ": 1\n";
  const std::string said = said_of(text);
  CHECK(said.size() < 20000);
  CHECK_THAT(said, Catch::EndsWith("error: and 19960 more\n"));
  const std::string word(1000000, 'x');
  for (const std::string& edited :
       {replaced(small_experiment(), "levels: 2", "levels: " + word),
        replaced(small_experiment(), "levels: 2", word + ": 2"),
        replaced(small_experiment(), "hinge,", word + ","),
        replaced(small_experiment(), "shape: square", "shape: " + word),
        replaced(small_experiment(), "name: small", "name: /" + word),
        replaced(small_experiment(), "cascadic: {}", "'/" + word + "': {type: pcs}"),
        replaced(small_experiment(), "levels: 2", "refiner: {type: loop, " + word + ": 1}"),
        replaced(small_experiment(), "shape: square", "shape: file, file: " + word + ".obj")})
    CHECK(said_of(edited).size() < 3000);
}

TEST_CASE("terminal control characters are printed escaped") {
  CHECK(said_of_edit("levels: 2", "levels: \"\\e[2J\\x07\"") ==
        "error: e.yaml:3:9: \"levels\" must be an integer, not the text \"\\x1b[2J\\x07\"\n");
  CHECK(said_of_edit("levels: 2", "\"\\e[2J\\n\": 2")
            .starts_with("error: e.yaml:3:1: unknown key \"\\x1b[2J\\n\"; known"));
  const Scratch folder;
  const std::string red = "$(printf '\\033[31m')";
  CHECK(refused(folder, "run " + red) == "error: \\x1b[31m: no such file\n");
  CHECK(refused(folder, red).starts_with("error: there is no command \"\\x1b[31m\""));
  CHECK(refused(folder, "list " + red).starts_with("error: there is no kind \"\\x1b[31m\""));
  CHECK(refused(folder, "describe " + red).starts_with("error: no plugin is called \"\\x1b[31m\""));
  CHECK(refused(folder, "run e.yaml --threads " + red)
            .starts_with("error: --threads: must be an integer of at least 1, not \\x1b[31m"));
}

TEST_CASE("errors of the file system are sentences") {
  const std::string name(300, 'x');
  const Scratch folder;
  for (const std::string command : {"check ", "report ", "table ", "run --resume ", "sweep "}) {
    const Ended ended = drape_with(command + name, folder.path);
    CAPTURE(command, ended.err);
    CHECK(ended.exit_code == 2);
    CHECK(ended.err.find("filesystem error") == std::string::npos);
    CHECK(ended.err.find("File name too long") != std::string::npos);
  }
}

TEST_CASE("each fault of a key, a value or a plugin is named where it stands") {
  const std::string own =
      "; a plugin of your own is given by --plugin or found by DRAPE_PLUGIN_PATH; one registered in Python "
      "is known to that program alone";
  const std::string energies =
      "known: constant_load, formula, gravity, hinge, midedge_bending, neo_hookean, pressure, "
      "quadratic_bending, strain_limit, stvk, woven";
  check_refused({
      {"levels: 2", "wind: 2", "3:1: unknown key \"wind\"; known keys are " + top_keys},
      {"levels: 2", "levels: 2\nlevels: 3", "4:1: repeated key \"levels\"; it is first set at e.yaml:3:1"},
      {"name: small\n", "", "1:1: \"name\" is required and missing"},
      {"columns: 6, rows: 6", "columns: 1, rows: 6", "2:8: grid: at least 2 × 2 vertices are needed"},
      {"name: small", "name: a/b",
       "1:7: name \"a/b\" names files: write it with letters, digits, \"_\", \"-\" and \".\", not beginning "
       "with \".\""},
      {"hinge,", "springs,", "8:25: unknown energy \"springs\"; " + energies + own},
      {"levels: 2", "refiner: butterfly", "3:10: unknown refiner \"butterfly\"; known: loop, midpoint" + own},
      {"levels: 2", "contact: [ipc, glue]", "3:16: unknown contact \"glue\"; known: ipc, shapes" + own},
      {"levels: 2", "metrics: [stretch, energy, stretch]",
       "3:28: \"metrics\" lists stretch twice, whose values have one place in the results"},
      {"levels: 2", "metrics: [{type: shine}]",
       "3:18: unknown metric \"shine\"; known: curvature_consistency, distance, drape_coefficient, energy, "
       "energy_above_end, residuals, silhouette, stretch" +
           own},
      {"  cascadic: {}", "  psc: {depth: 2}",
       "12:8: unknown solver \"psc\"; did you mean \"pcs\"? known: cascadic, newton, pcs" + own},
  });
}

TEST_CASE("energies, methods and their names") {
  check_refused({
      {"[neo_hookean, hinge, gravity]", "[]",
       "8:11: \"energies\" must name at least one energy, as in \"energies: [neo_hookean, hinge, gravity]\""},
      {"[neo_hookean, hinge, gravity]", "",
       "8:1: \"energies\" must be a list of plugins of kind energy, not empty"},
      {"  cascadic: {}", "  pcs: {}", "12:8: method \"pcs\" is given twice; rename one of them"},
      {"  cascadic: {}", "  a,b: {type: newton}",
       "12:8: method \"a,b\" names files: write it with letters, digits, \"_\", \"-\" and \".\", not "
       "beginning with \".\""},
      {"reference: newton", "reference: nwton",
       "14:12: \"reference\" must be one of the methods, or lowest, not \"nwton\""},
      {"  newton: {}\nreference: newton", "  lowest: {type: newton}\nreference: lowest",
       "14:12: \"reference\" takes the word lowest for the lowest state of all methods; give the method of "
       "that name another"},
      {"reference: newton", "reference: {force_tolerance: 1e-5}",
       "14:12: \"reference\" needs the method whose finest state is solved further, as in {method: pcs, "
       "force_tolerance: 1e-5}"},
      {"reference: newton", "reference: {method: newton, file: a.ply}",
       "14:12: \"reference\" takes either a method or a file, not both"},
      {"reference: newton", "reference: {file: nothing.ply}",
       "14:12: \"reference\": cannot read nothing.ply: No such file or directory"},
      {"reference: newton", "reference: {file: .}",
       "14:12: \"reference\": . holds no reference.ply; name a mesh, as in ./levels/newton_l3.ply, or run "
       "that experiment with a reference of its own"},
  });
  CHECK(said_of(small_experiment(), "--set 'methods={}'") ==
        "error: --set methods: \"methods\" must be a map of at least one method, as in \"methods: {pcs: {}, "
        "newton: {}}\"\n");
}

TEST_CASE("pins that select no vertex, or one that does not exist") {
  const std::string corner = "{region: nearest, point: [1, 0, 0]}";
  check_refused({
      {corner, "{region: ball, point: [5, 5, 5]}",
       "7:5: pin 1 (ball) selects no vertex of the coarsest level; widen its region; the rest shape, in "
       "which it counts, "
       "spans (0, 0, 0) to (1, 1, 0) m"},
      {corner, "{region: vertices}",
       "7:5: pin 1 (vertices) selects no vertex of the coarsest level; list some under \"vertices\""},
      {corner, "{region: vertices, vertices: [0, 36]}",
       "7:5: pin 1 (vertices) names vertex 36, but those of the coarsest level go from 0 to 35"},
  });
  // Loop moves the rest positions of a round border, on finer levels away from a small region.
  CHECK(said_of("name: disc\ncloth: {shape: disc, radius: 0.2, vertices: 40}\nlevels: 3\npins:\n"
                "  - {region: ball, point: [-0.2, 0, 0], radius: 0.002}\n"
                "energies: [neo_hookean, hinge, gravity]\nmethods: {newton: {}}\n") ==
        "error: e.yaml:5:5: pin 0 (ball) selects vertices of the coarsest level, but none of level 1, whose "
        "rest positions the refiner moves; widen its region, or select by \"nearest\" or \"vertices\"\n");
}

TEST_CASE("all errors of a config are listed in file order, those of --set last") {
  std::string text = small_experiment();
  text = replaced(text, "shape: square", "shape: sqare");
  text = replaced(text, "levels: 2", "levels: 2.5");
  text = replaced(text, "[0.9, 0.9, 1]", "[0.9, 0.9]");
  text = replaced(text, "region: nearest, point: [1", "region: nearst, point: [1");
  text = replaced(text, "cascadic: {}", "cascadic: {prolongation: linear}");
  CHECK(said_of(text, "--set newton.max_steps=few") ==
        "error: e.yaml:2:16: \"shape\" must be \"square\", \"rectangle\", \"disc\", \"polygon\" or \"file\", "
        "not \"sqare\"; did you mean \"square\"?\n"
        "error: e.yaml:3:9: \"levels\" must be an integer, not 2.5\n"
        "error: e.yaml:4:16: \"scale\" must be a list of 3 numbers, not of 2\n"
        "error: e.yaml:7:14: \"region\" must be \"nearest\", \"ball\", \"box\", \"border\" or \"vertices\", "
        "not \"nearst\"; did you mean \"nearest\"?\n"
        "error: e.yaml:12:28: \"prolongation\" must be \"midpoint\" or \"refiner\", not \"linear\"\n"
        "error: --set newton.max_steps: \"max_steps\" must be an integer, not \"few\"\n");
}

TEST_CASE("errors of keys, of mesh files and of obstacles are listed together, each where it stands") {
  const std::string text = replaced(
      replaced(small_experiment(), "shape: square, side: 1, columns: 6, rows: 6", "shape: file, file: a.obj"),
      "levels: 2",
      "contact: [ipc, shapes]\nobstacles:\n  - {name: b, mesh: b.obj}\n  - "
      "{name: c, mesh: c.obj}\n  - {name: d, shape: half_space, normal: [0, "
      "0, 0]}\nlevels: 2");
  const std::string of_files =
      "error: e.yaml:2:8: cannot read a.obj: No such file or directory\n"
      "error: e.yaml:5:5: ipc: obstacle \"b\": cannot read b.obj: No such file or directory\n"
      "error: e.yaml:6:5: ipc: obstacle \"c\": cannot read c.obj: No such file or directory\n"
      "error: e.yaml:7:5: shapes: d: half_space needs a \"normal\" that is not zero\n";
  CHECK(said_of(text) == of_files);
  CHECK(said_of(replaced(text, "levels: 2", "levelz: 2")) ==
        of_files + "error: e.yaml:8:1: unknown key \"levelz\"; did you mean \"levels\"?\n");
  CHECK(said_of(replaced(replaced(small_experiment(), "shape: square, side: 1, columns: 6, rows: 6",
                                  "shape: file, file: a.obj"),
                         "scale: [", "file: s.ply, scale: [")) ==
        "error: e.yaml:2:8: cannot read a.obj: No such file or directory\n"
        "error: e.yaml:4:8: cannot read s.ply: No such file or directory\n");
}

TEST_CASE("what the contact models share stands outside them, and each obstacle has a model that takes it") {
  const std::string shared = " belongs at the top of the experiment, once for all contact models";
  const std::string none = ": no contact model of this experiment takes ";
  const std::string keys = " must be a map with \"mesh\", \"meshed_shape\", \"animation\" or \"shape\"";
  const auto obstacles = [](const std::string& contact, const std::string& list) {
    return "contact: " + contact + "\nobstacles: [" + list + "]";
  };
  check_refused({
      {"levels: 2", "contact: {type: ipc, friction: 0.1}", "3:22: \"friction\" in ipc" + shared},
      {"levels: 2", "contact: {type: ipc, obstacles: [{file: a.ply}]}",
       "3:22: \"obstacles\" in ipc" + shared},
      {"levels: 2",
       obstacles("shapes", "{name: ball, shape: sphere}") +
           "\nschedule: {keys: [{parameter: contact.shapes.ball.centre, times: [0, 1], values: [[0, 0, 0], "
           "[0, 0, 1]]}]}",
       "5:31: unknown key \"ball\" in shapes; known keys are type, dhat, stiffness, "
       "friction_smoothing_distance, min_gap_fraction"},
      {"levels: 2", obstacles("ipc", "{name: ball, shape: sphere}"),
       "4:13: obstacles[0] (ball)" + none + "\"shape\"; add shapes to \"contact\""},
      {"levels: 2", obstacles("ipc", "{name: ball, shape: sphere, meshed_shape: box}"),
       "4:13: obstacles[0] (ball) has both \"meshed_shape\" and \"shape\"; keep one"},
      {"levels: 2", obstacles("[]", "{name: ball, shape: sphere}"),
       "4:13: obstacles[0] (ball)" + none + "\"shape\"; add shapes to \"contact\""},
      {"levels: 2", obstacles("shapes", "{shape: sphere}, {meshed_shape: box}"),
       "4:30: obstacles[1]" + none + "\"meshed_shape\"; add ipc to \"contact\""},
      {"levels: 2", obstacles("[ipc, shapes]", "{name: ball, radius: 1}"),
       "4:13: obstacles[0] (ball)" + keys},
      {"levels: 2", obstacles("[ipc, shapes]", "ball"), "4:13: obstacles[0]" + keys},
  });
}

TEST_CASE("an option that does not fit") {
  const std::string small = small_experiment(), see = "; see `drape run --help`";
  const std::vector<std::pair<std::string, std::string>> refusals = {
      {"--set levelz=3", "--set levelz: unknown key \"levelz\"; did you mean \"levels\"?"},
      {"--set levels", "--set levels: write it as key=value, as in --set newton.step_size=0.1"},
      {"--set =3", "--set =3: write it as key=value, as in --set newton.step_size=0.1"},
      {"--set 'levels=[1'", "--set levels:1:1: not valid YAML: end of sequence flow not found"},
      {"--method pcs,fast", "--method fast: the experiment's methods are pcs, cascadic, newton"},
      {"--levels 0", "--levels: must be an integer of at least 1, not 0" + see},
      {"--levels 02", "--levels: must be an integer of at least 1, not 02" + see},
      {"--levels 11", "--levels: \"levels\" must be at most 10, not 11"},
      {"--levels 99999999999", "--levels: must be an integer of at most 2147483647, not 99999999999" + see},
      {"--threads two", "--threads: must be an integer of at least 1, not two" + see},
      {"--view --port 65536", "--port: must be a port, 0 to 65535, not 65536" + see},
      {"--port 8000", "--port requires --view" + see},
      {"--view-keep", "--view-keep requires --view" + see},
      {"--fast 1 -x", "there is no option --fast" + see},
      {"second third", "The following arguments were not expected: second third" + see},
  };
  for (const auto& [arguments, refusal] : refusals)
    CHECK(said_of(small, arguments) == "error: " + refusal + "\n");
}

TEST_CASE("a live view whose port is taken is refused") {
  const drape::LiveServer taken(0, {});
  const std::string port = std::to_string(LiveAddress(taken.url()).port);
  CHECK(said_of(small_experiment(), "--view --port " + port) ==
        "error: --port " + port + ": cannot listen on 127.0.0.1:" + port +
            " (Address already in use); name another port, or leave --port out for one that is free\n");
}

TEST_CASE("keys that the shape or the region does not read, and empty items, are refused") {
  const std::vector<std::pair<std::string, std::string>> refusals = {
      {"cloth: {file: skirt.obj}", "5:15: \"file\" in cloth needs \"shape: file\"; here \"shape\" is square"},
      {"cloth: {shape: disc, triangulation: criss_cross}",
       "5:37: \"triangulation\" in cloth needs \"shape: square or shape: rectangle\"; here \"shape\" is "
       "disc"},
      {"cloth: {vertices: 400, columns: 9, rows: 9}",
       "5:19: \"vertices\" in cloth is not read beside \"columns\" and \"rows\"; leave it out, or set them "
       "to 0"},
      {"cloth: {vertices: 400, triangulation: equilateral, rows: 9}",
       "5:19: \"vertices\" in cloth is not read beside \"columns\" and \"rows\"; leave it out, or set them "
       "to 0"},
      {"cloth: {triangulation: random, rows: 9}",
       "5:38: \"rows\" in cloth is not read with \"triangulation: random\"; \"vertices\" counts them"},
      {"cloth: {shape: disc, seed: 2}",
       "5:28: \"seed\" in cloth is not read by this cloth; it is that of \"triangulation: random\" or of a "
       "polygon"},
      {"contact: shapes\nobstacles: [{shape: half_space, rotate: [10, 0, 0]}]",
       "6:41: \"rotate\" in obstacles needs \"shape: sphere or shape: box or shape: capsule or shape: "
       "cylinder\"; here \"shape\" is half_space"},
      {"contact: ipc\nobstacles: [{mesh: ball.ply, radius: 0.3}]",
       "6:38: \"radius\" in obstacles needs \"meshed_shape: sphere\"; here \"meshed_shape\" is not given"},
      {"cloth: {shape: circle, size: [1, 1]}",
       "5:16: \"shape\" must be \"square\", \"rectangle\", \"disc\", \"polygon\" or \"file\", not "
       "\"circle\""},
      {"pins: [{region: border, point: [1, 0, 0]}]",
       "5:32: \"point\" in pins needs \"region: nearest or region: ball\"; here \"region\" is border"},
      {"schedule: {steps: 40}",
       "5:11: \"schedule\" has no \"keys\", so that nothing would change; give it some, or leave it out"},
      {"pins: [{region: border, centre: [1, 0, 0]}]",
       "5:33: \"centre\" is that of \"rotate\", which is not given; leave it out"},
      {"pins: [{region: border, follow: {vertices: [7]}}]",
       "5:33: \"vertices\" in follow are those of its \"obstacle\", which is not given"},
      {"pins: [~]", "5:8: an item of \"pins\" is empty; remove it"},
  };
  for (const auto& [written, refusal] : refusals)
    CHECK(said_of("name: e\nlevels: 1\nenergies: [gravity]\nmethods: {newton: {}}\n" + written + "\n") ==
          "error: e.yaml:" + refusal + "\n");
}

TEST_CASE("two keys of a schedule may not set one parameter") {
  const auto said = [](const std::string& first, const std::string& second) {
    return said_of(replaced(small_experiment(), "gravity]", "{type: gravity, acceleration: [0, 0, -9.81]}]") +
                   "schedule: {keys: [\n  {parameter: " + first + ", times: [0, 1], values: " +
                   (first.ends_with("acceleration") ? "[[0, 0, -1], [0, 0, -2]]" : "[-1, -2]") +
                   "},\n  {parameter: " + second + ", times: [0, 1], values: [-3, -4]}]}\n");
  };
  const std::string z = "energies.gravity.acceleration.2";
  for (const std::string first : {"energies.2.acceleration.2", "energies.gravity.acceleration"})
    CHECK(said(first, z) ==
          "error: e.yaml:17:3: key \"" + z + "\" sets what key \"" + first + "\" sets; remove one of them\n");
}

TEST_CASE("an option for what a schedule sets would have no effect") {
  const std::string schedule =
      "--set 'schedule={keys: [{parameter: friction, times: [0, 1], values: [0.1, 0.2]}]}' ";
  const std::string acceleration =
      "--set 'schedule={keys: [{parameter: energies.gravity.acceleration, times: [0, 1], values: [[0, 0, "
      "-5], "
      "[0, 0, -9]]}]}' ";
  const std::string weighted =
      replaced(small_experiment(), "gravity]", "{type: gravity, acceleration: [0, 0, -9]}]");
  for (const char* option : {"energies.2.acceleration=[0,0,-1]", "energies.gravity.acceleration.2=-1"})
    CHECK_THAT(said_of(weighted, acceleration + "--set " + option), Catch::Contains("has no effect"));
  CHECK_THAT(said_of(small_experiment(), acceleration + "--set energies.gravity.acceleration.2=-1"),
             Catch::Contains("has no effect"));
  CHECK_THAT(
      said_of(small_experiment(), schedule + "--set friction=0.5"),
      Catch::Contains("--set friction: has no effect, since a schedule sets it; set the schedule's values, "
                      "as in --set schedule.keys.0.values=…"));
}

TEST_CASE("a results folder that cannot be used") {
  const Scratch folder(small_experiment());
  folder.write("file", "text");
  CHECK(refused(folder, "run e.yaml --out file") ==
        "error: file: cannot make the results folder (Not a directory); name another with --out\n");
  CHECK(refused(folder, "run e.yaml --out file/below") ==
        "error: file/below: cannot make the results folder (Not a directory); name another with --out\n");
  CHECK(refused(folder, "run e.yaml --out /proc/drape") ==
        "error: /proc/drape: cannot make the results folder (No such file or directory); name another with "
        "--out\n");
  CHECK(refused(folder, "run e.yaml --out /proc") ==
        "error: /proc: cannot write to the results folder; name another with --out\n");
  fs::create_symlink("gone", folder / "link");
  CHECK(
      refused(folder, "run e.yaml --out link") ==  // which is left there
      "error: link: is a link to gone, which does not exist; make that folder, or name another with --out\n");
}

TEST_CASE("earlier results stay without --overwrite, which removes only a run's own files") {
  const bool with_results = GENERATE(true, false);
  CAPTURE(with_results);
  const Scratch folder(small_experiment());
  const std::string run = "run e.yaml --out out --quiet --no-report --levels 1 --method ";
  drape_ends(run + "pcs", folder);
  fs::create_directories(folder / "out/pictures/mine");
  const std::vector<std::string> own = {"notes.txt",         "pictures/mine.png", "pictures/mine/pcs_l0.png",
                                        "levels/pcs_l0.obj", "fields/pcs_l0.ply", "rest/level0.ply",
                                        "obstacles/my0.ply", "checkpoint/mine"};
  for (const std::string& name : own) folder.write("out/" + name, "mine");
  for (const char* of_the_run : {"pictures/pcs_l0_on_l1.png", "fields/pcs_l0_l1.ply", "errors.csv.part"})
    folder.write(std::string("out/") + of_the_run, "");
  if (!with_results) fs::remove(folder / "out/results.json");
  CHECK(refused(folder, run + "newton") ==
        "error: out: holds the results of another run; name another folder with --out, or replace them with "
        "--overwrite\n");
  REQUIRE(fs::exists(folder / "out/levels/pcs_l0.ply"));
  drape_ends(run + "newton --overwrite", folder);
  for (const char* removed :
       {"levels/pcs_l0.ply", "levels/pcs_l0.vtp", "levels/pcs.pvd", "snapshots/pcs_l0.bin",
        "pictures/pcs_l0_on_l1.png", "fields/pcs_l0_l1.ply", "errors.csv.part"}) {
    INFO(removed);
    CHECK(!fs::exists(folder / "out" / removed));
  }
  CHECK(fs::exists(folder / "out/levels/newton_l0.ply"));
  for (const std::string& name : own) {
    INFO(name);
    CHECK(text_of(folder / ("out/" + name)) == "mine");
  }
}

TEST_CASE("a folder is a run's only with results or a lock of drape's own") {
  const Scratch folder(small_experiment());
  fs::create_directory(folder / "mine");
  folder.write("mine/config.yaml", "mine");
  folder.write("mine/writable.part", "mine too");
  for (const bool with_results : {false, true}) {
    if (with_results) folder.write("mine/results.json", "{\"accuracy\": 0.9}");
    for (const std::string overwrite : {"", " --overwrite"})
      CHECK(refused(folder, "run e.yaml --out mine" + overwrite) ==
            "error: mine/config.yaml: is there already, and not from a run; name another results folder with "
            "--out\n");
  }
  CHECK(refused(folder, "run --resume mine") ==
        "error: mine: holds no run; give the results folder of one\n");

  fs::create_directory(folder / "sweep");
  folder.write("sweep/sweep.json", "{}");
  CHECK(refused(folder, "run e.yaml --out sweep") ==
        "error: sweep: is a sweep's folder; name another results folder with --out\n");
}

TEST_CASE("--overwrite removes no file that the new run reads") {
  const Scratch folder(small_experiment());
  const std::string options = " --quiet --no-report --levels 1 --method pcs --out out";
  drape_ends("run e.yaml" + options, folder);
  const std::string mesh = (folder / "out/levels/pcs_l0.ply").string();
  CHECK(refused(folder, "run e.yaml --set contact=[ipc] --set 'obstacles=[{mesh: " + mesh +
                            ", translate: [0, 0, -9]}]' --overwrite" + options) ==
        "error: " + mesh +
            ": is read by this experiment, and --overwrite would remove it; copy it, or name another "
            "results folder with --out\n");
}

TEST_CASE("a file where a run has a folder, or a folder where it has a file, is refused and not removed") {
  for (const std::string name : {"pictures", "iterations.csv/mine"}) {
    const Scratch folder(small_experiment());
    fs::create_directories(folder / "out/checkpoint");
    folder.write("out/checkpoint/lock", "");
    fs::create_directories((folder / ("out/" + name)).parent_path());
    folder.write("out/" + name, "mine");
    INFO(name);
    CHECK(refused(folder, "run e.yaml --out out --overwrite") ==
          "error: out/" + name.substr(0, name.find('/')) +
              ": is not what a run has by this name; move it, or name another results folder with --out\n");
  }
}

TEST_CASE("a run that was killed before its first write blocks no other run") {
  for (int made = 1; made <= 3; ++made) {  // what it makes, in its order
    const Scratch folder(small_experiment());
    fs::create_directories(folder / "out/checkpoint");
    if (made > 1) folder.write("out/checkpoint/lock", "");
    if (made > 2) fs::create_directory(folder / "out/levels");
    CAPTURE(made);
    drape_ends("run e.yaml --out out --quiet --no-report --levels 1 --method pcs", folder);
  }
}

TEST_CASE("a run may be overwritten by a run of its own config.yaml") {
  const Scratch folder(small_experiment());
  const std::string options = " --quiet --no-report --levels 1 --method pcs --out ";
  drape_ends("run e.yaml" + options + "first", folder);
  drape_ends("run e.yaml --set start.file=first/rest/l0.ply" + options + "out", folder);
  const std::string start = text_of(folder / "out/start.ply"),
                    state = text_of(folder / "out/levels/pcs_l0.ply");
  const Ended again = drape_ends("run out/config.yaml --overwrite" + options + "out", folder);
  CHECK(again.err == "");
  CHECK(text_of(folder / "out/start.ply") == start);
  CHECK(text_of(folder / "out/levels/pcs_l0.ply") == state);
}

TEST_CASE("a plugin path that is no folder") {
  const Scratch folder(small_experiment());
  CHECK(refused_by("run e.yaml --out out", folder.path, "DRAPE_PLUGIN_PATH=nowhere") ==
        "error: DRAPE_PLUGIN_PATH names nowhere, which is not a folder\n");
}

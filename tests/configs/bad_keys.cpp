// What a config's keys and values are refused for, and where. Nothing may be written in any of these cases.

#include "tests/configs/runs.h"

namespace {

/// What stands in the small experiment in place of another text, and how the refusal begins after
/// "error: e.yaml:".
struct Edit {
  std::string to, refusal, from = "levels: 2";
};

void check_refused(const std::vector<Edit>& edits) {
  for (const Edit& edit : edits)
    check_error(said_of(replaced(small_experiment(), edit.from, edit.to)), "e.yaml:" + edit.refusal);
}

}  // namespace

TEST_CASE("each fault of a key, a value or a name is told where it stands") {
  const std::string cascadic = "  cascadic: {}";
  check_refused({
      {"wind: 2", "3:1: unknown key \"wind\"; known keys are name, description, cloth, levels, "},
      {"levels: 2\nlevels: 3", "4:1: repeated key \"levels\"; it is first set at e.yaml:3:1"},
      {"", "1:1: \"name\" is required and missing", "name: small\n"},
      {"columns: 1", "2:8: grid: at least 2 × 2 vertices are needed", "columns: 6"},
      {"name: a/b", "1:7: name \"a/b\" names files: write it with letters, digits, ", "name: small"},
      {"springs,", "8:25: unknown energy \"springs\"; known: constant_load, formula, gravity, ", "hinge,"},
      {"metrics: [stretch, energy, stretch]", "3:28: \"metrics\" lists stretch twice, "},
      {"[]", "8:11: \"energies\" must name at least one energy, as in ", "[neo_hookean, hinge, gravity]"},
      {"  psc: {depth: 2}", "12:8: unknown solver \"psc\"; did you mean \"pcs\"? known: ", cascadic},
      {"  pcs: {}", "12:8: method \"pcs\" is given twice; rename one of them", cascadic},
  });
  check_error(said_of(small_experiment(), "--set 'methods={}'"),
              "--set methods: \"methods\" must be a map of ");
}

TEST_CASE("a reference that there is not, or of two meanings, is refused") {
  const std::pair<std::string, std::string> references[] = {
      {"nwton", " must be one of the methods, or lowest, not \"nwton\""},
      {"{force_tolerance: 1e-5}", " needs the method whose finest state is solved further, "},
      {"{method: newton, file: a.ply}", " takes either a method or a file, not both"},
      {"{file: nothing.ply}", ": cannot read nothing.ply: No such file or directory"},
      {"{file: .}", ": . holds no reference.ply; name a mesh, as in ./levels/newton_l3.ply, "}};
  for (const auto& [reference, refusal] : references)
    check_refused({{"reference: " + reference, "14:12: \"reference\"" + refusal, "reference: newton"}});
  check_refused({{"  lowest: {type: newton}\nreference: lowest",
                  "14:12: \"reference\" takes the word lowest for the lowest state of all methods; ",
                  "  newton: {}\nreference: newton"}});
}

TEST_CASE("pins that select no vertex, or one that does not exist") {
  const std::string corner = "{region: nearest, point: [1, 0, 0]}";
  check_refused({
      {"{region: ball, point: [5, 5, 5]}", "7:5: pin 1 (ball) selects no vertex of the coarsest ", corner},
      {"{region: vertices}", "7:5: pin 1 (vertices) selects no vertex of the coarsest ", corner},
      {"{region: vertices, vertices: [0, 36]}", "7:5: pin 1 (vertices) names vertex 36, but those ", corner},
  });
  // Loop moves the rest positions of a round border, on finer levels away from a small region.
  check_error(said_of("name: disc\ncloth: {shape: disc, radius: 0.2, vertices: 40}\nlevels: 3\npins:\n"
                      "  - {region: ball, point: [-0.2, 0, 0], radius: 0.002}\n"
                      "energies: [neo_hookean, hinge, gravity]\nmethods: {newton: {}}\n"),
              "e.yaml:5:5: pin 0 (ball) selects vertices of the coarsest level, but none of level 1, ");
}

TEST_CASE("all errors of a config are listed in file order, those of --set last") {
  std::string text = small_experiment();
  text = replaced(text, "shape: square", "shape: sqare");
  text = replaced(text, "levels: 2", "levels: 2.5");
  text = replaced(text, "[0.9, 0.9, 1]", "[0.9, 0.9]");
  text = replaced(text, "region: nearest, point: [1", "region: nearst, point: [1");
  text = replaced(text, "cascadic: {}", "cascadic: {prolongation: linear}");
  CHECK(said_of(text, "--set newton.max_steps=few") ==
        "error: e.yaml:2:16: \"shape\" must be \"square\", \"rectangle\", \"disc\", \"polygon\", \"file\" or "
        "\"pattern\", "
        "not \"sqare\"; did you mean \"square\"?\n"
        "error: e.yaml:3:9: \"levels\" must be an integer, not 2.5\n"
        "error: e.yaml:4:16: \"scale\" must be a list of 3 numbers, not of 2\n"
        "error: e.yaml:7:14: \"region\" must be \"nearest\", \"ball\", \"box\", \"border\", \"vertices\", "
        "\"piece\", \"seam\" or \"label\", "
        "not \"nearst\"; did you mean \"nearest\"?\n"
        "error: e.yaml:12:28: \"prolongation\" must be \"midpoint\" or \"refiner\", not \"linear\"\n"
        "error: --set newton.max_steps: \"max_steps\" must be an integer, not \"few\"\n");
}

TEST_CASE("errors of keys, of mesh files and of obstacles are listed together, each where it stands") {
  const std::string of_file =
      replaced(small_experiment(), "shape: square, side: 1, columns: 6, rows: 6", "shape: file, file: a.obj");
  const std::string text =
      replaced(of_file, "levels: 2",
               "contact: [ipc, shapes]\nobstacles:\n  - {name: b, mesh: b.obj}\n  - {name: c, mesh: c.obj}\n"
               "  - {name: d, shape: half_space, normal: [0, 0, 0]}\nlevelz: 2");
  const std::string of_cloth = "error: e.yaml:2:8: cannot read a.obj: No such file or directory\n";
  CHECK(said_of(text) ==
        of_cloth +
            "error: e.yaml:5:5: ipc: obstacle \"b\": cannot read b.obj: No such file or directory\n"
            "error: e.yaml:6:5: ipc: obstacle \"c\": cannot read c.obj: No such file or directory\n"
            "error: e.yaml:7:5: shapes: d: half_space needs a \"normal\" that is not zero\n"
            "error: e.yaml:8:1: unknown key \"levelz\"; did you mean \"levels\"?\n");
  CHECK(said_of(replaced(of_file, "scale: [", "file: s.ply, scale: [")) ==
        of_cloth + "error: e.yaml:4:8: cannot read s.ply: No such file or directory\n");
}

TEST_CASE("what the contact models share stands outside them, and each obstacle has a model that takes it") {
  const std::string none = ": no contact model of this experiment takes ";
  const std::string keys = " must be a map with \"mesh\", \"meshed_shape\", \"animation\" or \"shape\"";
  const std::string key = "contact.shapes.ball.centre, times: [0, 1], values: [[0, 0, 0], [0, 0, 1]]";
  check_refused({
      {"contact: {type: ipc, friction: 0.1}", "3:22: \"friction\" in ipc belongs at the top of the "},
      {"contact: shapes\nobstacles: [{name: ball, shape: sphere}]\nschedule: {keys: [{parameter: " + key +
           "}]}",
       "5:31: unknown key \"ball\" in shapes; known keys are type, dhat, "},
  });
  const std::tuple<std::string, std::string, std::string> obstacles[] = {
      {"ipc", "{name: ball, shape: sphere}", "13: obstacles[0] (ball)" + none + "\"shape\"; add shapes to "},
      {"[]", "{name: ball, shape: sphere}", "13: obstacles[0] (ball)" + none + "\"shape\"; "},
      {"shapes", "{shape: sphere}, {meshed_shape: box}", "30: obstacles[1]" + none + "\"meshed_shape\"; "},
      {"ipc", "{shape: sphere, meshed_shape: box}", "13: obstacles[0] has both \"meshed_shape\" and "},
      {"[ipc, shapes]", "{name: ball, radius: 1}", "13: obstacles[0] (ball)" + keys},
      {"[ipc, shapes]", "ball", "13: obstacles[0]" + keys}};
  for (const auto& [contact, list, refusal] : obstacles)
    check_refused({{"contact: " + contact + "\nobstacles: [" + list + "]", "4:" + refusal}});
}

TEST_CASE("keys that the shape or the region does not read, and empty items, are refused") {
  const std::pair<std::string, std::string> refusals[] = {
      {"cloth: {file: skirt.obj}",
       "5:15: \"file\" in cloth needs \"shape: file or shape: pattern\"; here \"shape\" is square"},
      {"cloth: {vertices: 400, columns: 9, rows: 9}", "5:19: \"vertices\" in cloth is not read beside "},
      {"cloth: {shape: disc, seed: 2}", "5:28: \"seed\" in cloth is not read by this cloth; "},
      {"contact: ipc\nobstacles: [{mesh: ball.ply, radius: 0.3}]", "6:38: \"radius\" in obstacles needs "},
      {"schedule: {steps: 40}", "5:11: \"schedule\" has no \"keys\", so that nothing would change; "},
      {"pins: [{region: border, centre: [1, 0, 0]}]", "5:33: \"centre\" is that of \"rotate\", which "},
      {"pins: [{region: border, follow: {vertices: [7]}}]", "5:33: \"vertices\" in follow are those of its "},
      {"pins: [~]", "5:8: an item of \"pins\" is empty; remove it"}};
  for (const auto& [written, refusal] : refusals)
    check_error(said_of("name: e\nlevels: 1\nenergies: [gravity]\nmethods: {newton: {}}\n" + written + "\n"),
                "e.yaml:" + refusal);
}

TEST_CASE("two keys of a schedule may not set one parameter, and an option for what one sets has no effect") {
  const std::string acceleration = "energies.gravity.acceleration", vectors = "[[0, 0, -1], [0, 0, -2]]",
                    small = small_experiment();
  const std::string weighted = replaced(small, "gravity]", "{type: gravity, acceleration: [0, 0, -9.81]}]");
  const auto key_of = [](const std::string& parameter, const std::string& values) {
    return "{parameter: " + parameter + ", times: [0, 1], values: " + values + "}";
  };
  const auto check_both = [&](const std::string& first, const std::string& values) {
    check_error(said_of(weighted + "schedule: {keys: [\n  " + key_of(first, values) + ",\n  " +
                        key_of(acceleration + ".2", "[-3, -4]") + "]}\n"),
                "e.yaml:17:3: key \"" + acceleration + ".2\" sets what key \"" + first + "\" sets; ");
  };
  check_both("energies.2.acceleration.2", "[-1, -2]");
  check_both(acceleration, vectors);
  const auto check_no_effect = [&](const std::string& text, const std::string& key, const std::string& set) {
    CHECK_THAT(
        said_of(text, "--set 'schedule={keys: [" + key + "]}' --set " + set),
        Contains("--set " + set.substr(0, set.find('=')) + ": has no effect, since a schedule sets it; "));
  };
  check_no_effect(weighted, key_of(acceleration, vectors), "energies.2.acceleration=[0,0,-1]");
  check_no_effect(weighted, key_of(acceleration, vectors), acceleration + ".2=-1");
  check_no_effect(small, key_of(acceleration, vectors), acceleration + ".2=-1");
  check_no_effect(small, key_of("friction", "[0.1, 0.2]"), "friction=0.5");
}

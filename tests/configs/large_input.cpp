// Input that is large in one respect, of which the time to check it must not grow with the square.

#include <numbers>
#include <sstream>

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/configs/large.h"

using namespace drape;

namespace {

/// checked() of a cloth of this file.
Ended checked_mesh(const std::string& name, const std::string& bytes) {
  const Scratch folder("name: large\nlevels: 1\ncloth: {shape: file, file: " + name + "}\n" +
                       rest_of_experiment);
  folder.write(name, bytes);
  return checked(folder);
}

/// The same of a flat square with these sections.
Ended checked_square(const std::string& sections) {
  return checked(
      Scratch("name: large\nlevels: 2\ncloth: {shape: square, side: 1, columns: 50, rows: 50}\n" + sections));
}

std::string ply(const std::string& more_properties, const std::string& more_elements) {
  return "ply\nformat ascii 1.0\n" + more_elements +
         "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n" + more_properties +
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
}

/// A ball around each of the square's first vertices, one a line.
std::string balls(int count, const std::string& more) {
  return repeated(count, [&](int k) {
    std::ostringstream line;
    line << "  - {region: ball, point: [" << k % 50 / 49.0 << ", " << k / 50 % 50 / 49.0
         << ", 0], radius: 1e-4" << more << "}\n";
    return line.str();
  });
}

/// Points around a circle, and triangles that join each two neighbours to the centre; or, upright, each to an
/// axis.
std::string around(int count, bool upright) {
  std::ostringstream off;
  off << "OFF\n" << count + 2 << " " << count << " 0\n0 0 0\n" << (upright ? "0 0 1\n" : "9 9 0\n");
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count;
    off << std::cos(angle) << " " << std::sin(angle) << (upright ? " 0.5\n" : " 0\n");
  }
  for (int k = 0; k < count; ++k)
    off << "3 0 " << (upright ? 1 : 2 + (k + 1) % count) << " " << 2 + k << "\n";
  return off.str();
}

}  // namespace

TEST_CASE("A PLY file of many elements or properties is read in time") {
  const auto element = [](const std::string& count) {
    return [count](int k) { return "element e" + std::to_string(k) + " " + count + "\n"; };
  };
  CHECK(checked_mesh("a.ply", ply("", repeated(80000, element("0")))).exit_code == 0);
  CHECK(checked_mesh("a.ply", ply("", repeated(50000, element("500000")))).exit_code ==
        0);  // each takes no byte
  CHECK(checked_mesh("a.ply", ply("", "comment " + std::string(2'000'000, 'x') + "\n")).exit_code == 0);
  const auto property = [](int k) { return "property float p" + std::to_string(k) + "\n"; };
  CHECK_THAT(checked_mesh("a.ply", ply(repeated(150000, property), "")).err,
             Contains("the file ends where vertex"));
}

TEST_CASE("Many pins and handles are checked in time, each, all together and where all hold all vertices") {
  for (const std::string list : {"pins:\n", "handles:\n"}) {
    CHECK(checked_square(list + balls(5000, "") + rest_of_experiment).exit_code == 0);
    CHECK(checked_square(list + repeated(1500, [](int) { return "  - {region: border}\n"; }) +
                         rest_of_experiment)
              .exit_code == 0);
    const Ended apart =
        checked_square(list + balls(5000, "") + balls(2500, ", translate: [0, 0, 1]") + rest_of_experiment);
    CHECK_THAT(apart.err, Contains("both select vertex") && Contains("2500 (ball, line"));
  }
}

TEST_CASE("A schedule of many keys or times is refused by its bounds; one within them is checked in time") {
  const auto key = [](const std::string& parameter, int times, const std::string& value) {
    const auto list = [&](const std::function<std::string(int)>& item) { return repeated(times, item); };
    return "  - {parameter: " + parameter + ", times: [" +
           list([](int k) { return std::to_string(k) + ", "; }) + "], values: [" +
           list([&](int) { return value + ", "; }) + "]}\n";
  };
  const std::string schedule = "schedule:\n  keys:\n",
                    pins = "pins:\n" + balls(2000, ", translate: [0, 0, 0]");
  const auto keys_of_pins = [&](int count) {
    return repeated(count,
                    [&](int k) { return key("pins." + std::to_string(k) + ".translate", 2, "[0, 0, 0]"); });
  };
  CHECK_THAT(checked_square(pins + rest_of_experiment + schedule + keys_of_pins(2000)).err,
             Contains("\"schedule\" has 2000 keys, of at most 200"));
  CHECK(checked_square(pins + rest_of_experiment + schedule + keys_of_pins(200)).exit_code == 0);
  for (const auto& [parameter, value] : {std::pair("material.density", "500"), {"pins.0.radius", "1e-3"}})
    CHECK_THAT(
        checked_square(pins + rest_of_experiment + schedule + key(parameter, 40000, value)).err,
        Contains("has 40000 times in the keys of material, energies, pins and handles, of at most 1000"));
  CHECK(checked(Scratch("name: large\nlevels: 1\ncloth: {vertices: 40000}\n" + rest_of_experiment + schedule +
                        key("material.density", 1000, "500")))
            .exit_code == 0);
  const auto ball = [](const std::string& contact, const std::string& shape) {
    return "contact: " + contact + "\nobstacles: [{" + shape + ", radius: 0.1, translate: [0, 0, -1]}]\n";
  };
  CHECK(checked_square(ball("shapes", "shape: sphere") + rest_of_experiment + schedule +
                       key("obstacles.0.radius", 40000, "0.1"))
            .exit_code == 0);
  CHECK(checked_square(ball("ipc", "meshed_shape: sphere, subdivisions: 7") + rest_of_experiment + schedule +
                       key("obstacles.0.radius", 2000, "0.1"))
            .exit_code == 0);
}

TEST_CASE("Pins that follow a fine mesh, and regions that hold many vertices, are found in time") {
  const auto pins = [](const std::string& list, int count, const std::string& more) {
    return list + repeated(count, [&](int k) {
             std::ostringstream line;
             line << "  - {region: ball, point: [" << k % 70 / 69.0 << ", " << k / 70 % 70 / 69.0 << ", 0], "
                  << more << "}\n";
             return line.str();
           });
  };
  const std::string name = "name: large\nlevels: 2\n", cloth = "cloth: {shape: square, side: 1, columns: ";
  const Scratch folder(name + cloth +
                       "70, rows: 70}\ncontact: ipc\nobstacles: [{mesh: fine.obj, name: o}]\n" +
                       pins("pins:\n", 4000, "radius: 1e-4, follow: {obstacle: o}") + rest_of_experiment);
  TriangleMesh fine = grid({1, 1}, 300, 300, Diagonals::one_way);
  fine.vertices.col(2).array() -= 0.1;
  write_mesh(folder / "fine.obj", fine);
  CHECK(checked(folder).exit_code == 0);
  for (const std::string list : {"handles:\n", "pins:\n"})
    CHECK(checked(Scratch(name + cloth + "100, rows: 100}\n" + pins(list, 9900, "radius: 0.01") +
                          rest_of_experiment))
              .exit_code == 0);
  CHECK_THAT(checked_square(pins("pins:\n", 10001, "radius: 0.1") + rest_of_experiment).err,
             Contains("there are 10001, of at most 10000"));
  CHECK_THAT(checked_square(pins("handles:\n", 9000, "radius: 1") + rest_of_experiment).err,
             Contains("pins and handles select vertices 10000000 times and more on all levels together"));
}

TEST_CASE("Many obstacles are checked in time, or refused") {
  const auto scene = [](int count, const std::string& contact, const std::string& obstacle) {
    return "contact: " + contact + "\nobstacles:\n" + repeated(count, [&](int k) {
             std::ostringstream line;
             line << "  - {" << obstacle << ", translate: [" << k % 100 / 99.0 << ", " << k / 100 / 99.0
                  << ", -0.5]}\n";
             return line.str();
           });
  };
  for (const auto& [count, shape] : {std::pair(10000, "shape: box, size: [0.01, 0.01, 0.01]"),
                                     {10000, "shape: sphere, radius: 0.002"},
                                     {4000, "shape: cylinder, radius: 0.002, height: 0.01"}})
    CHECK(checked_square(scene(count, "shapes", shape) + rest_of_experiment).exit_code == 0);
  CHECK(checked_square(
            scene(5000, "{type: ipc, self_contact: false}", "meshed_shape: box, size: [0.01, 0.01, 0.01]") +
            rest_of_experiment)
            .exit_code == 0);
  CHECK_THAT(checked_square(scene(20000, "shapes", "shape: sphere, radius: 0.002") + rest_of_experiment).err,
             Contains("\"obstacles\" has 20000 entries, of at most 10000"));
  CHECK_THAT(checked_square(scene(2000, "shapes", "shape: cylinder") + rest_of_experiment).err,
             Contains("the rims of cylinders have") && Contains("of at most 4000000 in all"));
}

TEST_CASE("Outlines of very many points or holes are meshed in time, or refused") {
  const auto polygon = [](int vertices, const std::string& loops) {
    return Scratch("name: large\nlevels: 1\ncloth: {shape: polygon, vertices: " + std::to_string(vertices) +
                   ", loops: [" + loops + "]}\n" + rest_of_experiment);
  };
  const auto side = [](int count) {
    return "{points: [" +
           repeated(count, [&](int k) { return std::to_string(k / double(count)) + ", 0, "; }) +
           "1, 0, 1, 1, 0, 1]}";
  };
  const auto holes = [](int count) {
    return "{points: [0, 0, 1, 0, 1, 1, 0, 1]}" + repeated(count, [](int k) {
             const auto at = [](double x) { return std::to_string(x); };
             const double x = (k % 71 + 0.5) / 72, y = (k / 71 + 0.5) / 72;
             return ", {points: [" + at(x) + ", " + at(y) + ", " + at(x + 0.003) + ", " + at(y) + ", " +
                    at(x) + ", " + at(y + 0.003) + "]}";
           });
  };
  CHECK_THAT(checked(polygon(1000, side(30000))).err,
             Contains("the loops have 30003 points, of at most 10000"));
  CHECK_THAT(checked(polygon(1000, side(9000))).err, Contains("about 1000 vertices are not possible"));
  CHECK_THAT(checked(polygon(20000, holes(5000))).err,
             Contains("the loops have 15004 points, of at most 10000"));
  CHECK_THAT(checked(polygon(20000, holes(3300))).err, Contains("about 20000 vertices are not possible"));
}

TEST_CASE("Long parallel strips are searched for gaps in time, apart and as one cloth") {
  TriangleMesh strips{Positions(80000, 3), Triangles(40000, 3)};
  for (int k = 0; k < 20000; ++k) {
    for (int i = 0; i < 4; ++i) strips.vertices.row(4 * k + i) << 10 * (i % 2), 2e-4 * k + 1e-4 * (i / 2), 0;
    strips.triangles.row(2 * k) << 4 * k, 4 * k + 1, 4 * k + 3;
    strips.triangles.row(2 * k + 1) << 4 * k, 4 * k + 3, 4 * k + 2;
  }
  TriangleMesh joined = strips;  // by a strip across their ends
  joined.vertices.conservativeResize(120000, 3);
  joined.triangles.conservativeResize(40000 + 79998, 3);
  for (int k = 0; k < 40000; ++k) joined.vertices.row(80000 + k) << -0.01, 1e-4 * k, 0;
  for (int k = 0; k < 39999; ++k) {
    joined.triangles.row(40000 + 2 * k) << 2 * k, 2 * k + 2, 80000 + k;
    joined.triangles.row(40000 + 2 * k + 1) << 2 * k + 2, 80001 + k, 80000 + k;
  }
  const Scratch folder("name: large\nlevels: 1\ncloth: {shape: file, file: a.obj}\n" + rest_of_experiment);
  for (const TriangleMesh& mesh : {strips, joined}) {
    write_mesh(folder / "a.obj", mesh);
    CHECK(checked(folder).exit_code == 0);
  }
}

TEST_CASE("Very many energies are refused, many forces of one are checked in time") {
  const std::string list =
      "energies: [neo_hookean" + repeated(2000, [](int) { return ", constant_load"; }) + "]\n";
  CHECK_THAT(checked_square(list + "methods: {newton: {}}\n").err,
             Contains("\"energies\" has 2001 entries, of at most 50"));
  const std::string load = "{point: [0.3, 0.2, 0], force: [0, 0, 1]}, ";
  CHECK(checked(Scratch("name: large\nlevels: 1\ncloth: {vertices: 100000}\nmethods: {newton: {}}\nenergies: "
                        "[neo_hookean, {type: constant_load, points: [" +
                        repeated(20000, [&](int) { return load; }) + "]}]\n"))
            .exit_code == 0);
}

TEST_CASE("Many names that are not there are neither compared nor listed without bound") {
  const std::string letters(180, 'x');
  const auto piece = [](int k) {
    const std::string x = std::to_string(2 * k), end = std::to_string(2 * k + 1);
    return "v " + x + " 0 0\nv " + end + " 0 0\nv " + x + " 1 0\nvt " + x + " 0\nvt " + end + " 0\nvt " + x +
           " 1\ng p" + std::to_string(k) + "\nf -3/-3 -2/-2 -1/-1\n";
  };
  const Scratch pieces(
      "name: large\nlevels: 1\ncloth: {shape: file, file: a.obj, rest: uv, uv_unit: m}\npins:\n" +
      repeated(9000, [](int) { return "  - {region: piece, piece: q}\n"; }) + rest_of_experiment);
  pieces.write("a.obj", repeated(30000, piece));
  CHECK_THAT(checked(pieces).err,
             Contains("has no piece \"q\"; it has p0, p1, ") && Contains("and 29960 more"));
  const Scratch panels("name: large\nlevels: 1\ncloth: {shape: pattern, file: p.yaml}\n" +
                       rest_of_experiment);
  panels.write("p.yaml",
               "properties: {units_in_meter: 1}\npattern:\n  panels:\n" +
                   repeated(3000,
                            [&](int k) {
                              return "    " + letters + std::to_string(k) +
                                     ": {vertices: [[0, 0], [1, 0], [0, 1]], edges: [[0, 1], [1, 2], "
                                     "[2, 0]]}\n";
                            }) +
                   "  stitches:\n" + repeated(1000, [&](int k) {
                     return "    - [y" + letters + std::to_string(k) + ".0, " + letters + "0.1]\n";
                   }));
  CHECK_THAT(checked(panels).err, Contains("there is no panel"));
}

TEST_CASE("A vertex or an edge of very many triangles is refused") {
  const std::string most = " triangles, of at most 5000";
  for (const bool upright : {false, true}) {
    CHECK_THAT(checked_mesh("a.off", around(30000, upright)).err, Contains("vertex 0 has 30000" + most));
    const Scratch folder(
        "name: large\nlevels: 1\ncloth: {vertices: 9}\nstart: {translate: [0, 0, 3]}\ncontact: ipc\n"
        "obstacles: [{mesh: a.off}]\n" +
        rest_of_experiment);
    folder.write("a.off", around(30000, upright));
    CHECK_THAT(checked(folder).err, Contains("vertex 0 has 30000" + most));
  }
}

TEST_CASE("A mesh of very many parts, grain regions or crossing triangles is checked in time, or refused") {
  const auto triangles = [](int count, const std::function<std::string(int)>& corners) {
    return repeated(count, corners) + repeated(count, [](int k) {
             return "g part" + std::to_string(k) + "\nf " + std::to_string(3 * k + 1) + " " +
                    std::to_string(3 * k + 2) + " " + std::to_string(3 * k + 3) + "\n";
           });
  };
  const auto apart = [](int k) {
    std::ostringstream text;
    const double x = k % 300 * 0.01, y = k / 300 * 0.01;
    text << "v " << x << " " << y << " 0\nv " << x + 0.009 << " " << y << " 0\nv " << x << " " << y + 0.009
         << " 0\n";
    return text.str();
  };
  const auto crossing = [](int k, double step = 1e-7, double height = 0.01) {
    std::ostringstream text;
    const double a = k * 1e-3, z = k * step;
    text << "v " << -std::cos(a) << " " << -std::sin(a) << " " << z - height << "\nv " << std::cos(a) << " "
         << std::sin(a) << " " << z - height << "\nv " << height * std::cos(a) << " " << height * std::sin(a)
         << " " << z + height << "\n";
    return text.str();
  };
  CHECK(checked_mesh("a.obj", triangles(60000, apart)).exit_code == 0);
  // The corners in the middle are near every part's long edge.
  checked_mesh("a.obj", triangles(60000, [&](int k) { return crossing(k, 1e-9, 1e-4); }));
  const Scratch folder("name: large\nlevels: 1\ncloth: {shape: file, file: a.obj, join: 0.1}\n" +
                       rest_of_experiment);
  folder.write("a.obj", triangles(40000, apart));
  CHECK_THAT(checked(folder).err, Contains("\"join\" of 0.1 m is larger than many edges"));
  const std::string regions =
      repeated(6000, [](int) { return "{lower: [0, 0, -1], upper: [1, 1, 1], grain: 1}, "; });
  CHECK_THAT(checked(Scratch("name: large\nlevels: 1\ncloth: {shape: square, side: 1, vertices: 20000, "
                             "grain_regions: [" +
                             regions + "]}\n" + rest_of_experiment))
                 .err,
             Contains("\"grain_regions\" has 6000 entries, of at most 1000"));
  const Scratch star("name: large\nlevels: 1\ncloth: {shape: file, file: a.obj}\ncontact: ipc\n" +
                     rest_of_experiment);
  star.write("a.obj", triangles(3141, crossing));
  CHECK_THAT(checked(star).err, Contains(" pairs of the resting cloth's vertices, edges and triangles"));
  const Scratch obstacle(
      "name: large\nlevels: 1\ncloth: {vertices: 6000}\ncontact: ipc\n"
      "start: {translate: [-0.5, -0.5, 0]}\nobstacles: [{mesh: a.obj}]\n" +
      rest_of_experiment);
  obstacle.write("a.obj", triangles(9000, crossing));
  CHECK_THAT(checked(obstacle).err, Contains("pairs of triangles lie across or beside one another"));
}

TEST_CASE("Pins of pieces are found in time") {
  const Scratch folder("name: large\nlevels: 1\ncloth: {shape: file, file: a.obj}\npins: [" +
                       repeated(9000, [](int) { return "{region: piece, piece: small}, "; }) + "]\n" +
                       rest_of_experiment);
  const TriangleMesh fine = grid({1, 1}, 200, 200, Diagonals::one_way);
  std::ostringstream text;
  for (const auto& p : fine.vertices.rowwise()) text << "v " << p << "\n";
  for (Eigen::Index t = 0; t < fine.triangles.rows(); ++t)
    text << (t == 0                           ? "g large\nf "
             : t == fine.triangles.rows() - 1 ? "g small\nf "
                                              : "f ")
         << fine.triangles.row(t).array() + 1 << "\n";
  folder.write("a.obj", text.str());
  CHECK(checked(folder).exit_code == 0);
}

TEST_CASE("A mesh or an experiment that is linked to a file without an end is refused") {
  const Scratch folder("name: large\nlevels: 1\ncloth: {shape: file, file: a.ply}\n" + rest_of_experiment);
  for (const std::string endless : {"/dev/zero", "/proc/self/pagemap"}) {
    fs::create_symlink(endless, folder / "a.ply");
    CHECK_THAT(checked(folder).err, Contains("a.ply: "));
    fs::remove(folder / "a.ply");
  }
}

TEST_CASE("a table of fabrics with many rows and columns takes time by its size") {
  const Scratch folder("name: e\nmaterial: {fabric: {file: wide.csv, row: a}}\n" + rest_of_experiment);
  folder.write("wide.csv", "name,mass,warp_bending" + repeated(400'000, [](int) { return ",c"; }) +
                               "\na,0.3,1e-5" + repeated(200'000, [](int) { return "\nb,0.3,1e-5"; }));
  checked(folder, 10);
}

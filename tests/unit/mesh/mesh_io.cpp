#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <limits>

#include "core/kernel/files/file.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"
#include "tests/support/refusal.h"

using namespace drape;
namespace fs = std::filesystem;

namespace {

/// A folder of one test, which writes files.
struct MeshFolder : Scratch {
  fs::path file(const std::string& name, const std::string& bytes) const {
    write(name, bytes);
    return path / name;
  }
};

bool same_bits(const TriangleMesh& a, const TriangleMesh& b) {
  return a.vertices.rows() == b.vertices.rows() && a.triangles.rows() == b.triangles.rows() &&
         std::memcmp(a.vertices.data(), b.vertices.data(), a.vertices.size() * sizeof(double)) == 0 &&
         a.triangles == b.triangles;
}

/// Awkward numbers: no short decimals, tiny, huge, minus zero, denormal.
TriangleMesh awkward_mesh() {
  TriangleMesh mesh = random_triangulation({1. / 3, 1}, 60, 7);
  mesh.vertices(3, 2) = -0.0;
  mesh.vertices(4, 2) = 1e-300;
  mesh.vertices(5, 2) = -1.7976931348623157e308;
  mesh.vertices(6, 2) = std::numeric_limits<double>::denorm_min();
  return mesh;
}

/// The mesh of most reading tests: a square of two triangles.
void check_square(const TriangleMesh& mesh) {
  const Positions vertices{{0, 0, 0}, {1, 0, 0}, {1, 1.5, 0}, {0, 1, -0.25}};
  const Triangles triangles{{0, 1, 2}, {0, 2, 3}};
  REQUIRE(mesh.vertices.rows() == 4);
  REQUIRE(mesh.triangles.rows() == 2);
  CHECK(mesh.vertices == vertices);
  CHECK(mesh.triangles == triangles);
}

template <class Number>
void append(std::string& bytes, Number number, bool big_endian = false) {
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  if (big_endian) std::reverse(raw, raw + sizeof number);
  bytes.append(raw, sizeof number);
}

}  // namespace

TEST_CASE("PLY and OBJ read back to the same bits", "[io]") {
  const MeshFolder scratch;
  const std::string name = GENERATE("mesh.ply", "mesh.obj", "MESH.PLY");
  const TriangleMesh mesh = awkward_mesh();
  write_mesh(scratch / name, mesh);
  CHECK(same_bits(read_mesh(scratch / name), mesh));
  CHECK_FALSE(fs::exists(scratch / (name + ".part")));
}

TEST_CASE("fields of a PLY read back to the same bits", "[io]") {
  const MeshFolder scratch;
  const TriangleMesh mesh = awkward_mesh();
  VertexFields fields{{"mean_curvature", mesh.vertices.col(0) / 7}, {"rest.z", mesh.vertices.col(2)}};
  fields[0].values[1] = std::numeric_limits<double>::quiet_NaN();
  const fs::path file = scratch.file("m.ply", ply_bytes(mesh, fields));
  CHECK(same_bits(read_mesh(file), mesh));
  const VertexFields back = read_ply_fields(file);
  REQUIRE(back.size() == 2);
  for (int i = 0; i < 2; ++i) {
    CHECK(back[i].name == fields[i].name);
    REQUIRE(back[i].values.size() == 60);
    CHECK(std::memcmp(back[i].values.data(), fields[i].values.data(), 60 * sizeof(double)) == 0);
  }
  CHECK(read_ply_fields(scratch.file("m.ply", ply_bytes(mesh))).empty());
}

TEST_CASE("OBJ and OFF in all their forms", "[io]") {
  const MeshFolder scratch;
  const std::string obj =
      "# a square\r\no cloth\nv 0 0 0\nv +1 0 0 1.0\nvt 0 0\nvn 0 0 1\n  v 1 15e-1 0\nv 0 1 -.25 # last\n";
  const auto [name, text] = GENERATE_COPY(table<std::string, std::string>({
      {"m.obj", obj + "f 1 2 3\nf 1 3 4\n"},
      {"m.obj", obj + "f 1/1 2/1 3/1\nf 1/1/1 3/1/1 4/1/1"},
      {"m.obj", obj + "f 1//1 2//1 3//1\nf -4 -2 -1\n"},
      {"m.obj", obj + "s off\nf 1 2 3 4\n"},
      {"m.obj", "\xEF\xBB\xBFv 0 0 0\nv 1 0 0\nv 1 1.5 0\nv 0 1 -.25\nf 1 2 3 4\n"},  // a byte order mark
      {"m.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1.5 0\n0 1 -0.25\n3 0 1 2\n3 0 2 3\n"},
      {"m.off", "OFF 4 1 5\n\n0 0 0\n1 0 0\n1 1.5 0\n0 1 -0.25\n4 0 1 2 3 255 0 0\n"},
      {"m.off",
       "COFF\n# colours\n4 2 0\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n1 1.5 0 1 0 0 1\n0 1 -0.25 1 0 0 1\n"
       "3 0 1 2\n3 0 2 3"},
  }));
  CAPTURE(text);
  check_square(read_mesh(scratch.file(name, text)));
}

TEST_CASE("PLY as text", "[io]") {
  const MeshFolder scratch;
  const fs::path path = scratch.file(
      "m.ply",
      "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nobj_info none\r\nelement vertex 4\r\nproperty "
      "float x\r\n"
      "property float32 y\r\nproperty list uchar int seen\r\nproperty double z\r\nproperty uchar red\r\n"
      "element face 1\r\nproperty uchar flags\r\nproperty list uint8 uint vertex_index\r\n"
      "element edge 1\r\nproperty int a\r\nend_header\r\n"
      "0 0 0 0 255\r\n1 0 2 7 8 0 254\r\n1 1.5 1 9 0 253\r\n0 1 0 -0.25 252\r\n7 4 0 1 2 3\r\n-1\r\n");
  check_square(read_mesh(path));
  const VertexFields fields = read_ply_fields(path);
  REQUIRE(fields.size() == 1);
  CHECK(fields[0].name == "red");
  CHECK(fields[0].values == Eigen::Vector4d(255, 254, 253, 252));
}

TEST_CASE("PLY in binary of either byte order and mixed types", "[io]") {
  const MeshFolder scratch;
  const bool big = GENERATE(false, true);
  std::string bytes =
      std::string("ply\nformat binary_") + (big ? "big" : "little") +
      "_endian 1.0\nelement vertex 4\nproperty float x\nproperty double y\nproperty short n\n"
      "property float z\nelement face 2\nproperty list ushort uint vertex_indices\nend_header\n";
  const float x[] = {0, 1, 1, 0}, z[] = {0, 0, 0, -0.25};
  const double y[] = {0, 0, 1.5, 1};
  for (int v = 0; v < 4; ++v) {
    append(bytes, x[v], big);
    append(bytes, y[v], big);
    append(bytes, static_cast<std::int16_t>(-300 * v), big);
    append(bytes, z[v], big);
  }
  for (const auto& t : {std::array{0u, 1u, 2u}, {0u, 2u, 3u}}) {
    append(bytes, std::uint16_t{3}, big);
    for (std::uint32_t v : t) append(bytes, v, big);
  }
  const fs::path path = scratch.file("m.ply", bytes);
  check_square(read_mesh(path));
  CHECK(read_ply_fields(path)[0].values == Eigen::Vector4d(0, -300, -600, -900));

  const fs::path cut = scratch.file("cut.ply", bytes.substr(0, bytes.size() - 1));
  CHECK_THROWS_WITH(read_mesh(cut),
                    cut.string() + ": face 1: the file ends (the header declares 4 vertex, 2 face)");
}

TEST_CASE("malformed files are refused with file and line", "[io]") {
  const MeshFolder scratch;
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const std::string with_uv =
      ply.substr(0, ply.find("end_header")) + "property list uchar float texcoord\nend_header\n";
  const std::string counts = " (the header declares 3 vertex, 1 face)";
  const std::string element = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n";
  const auto [name, text, message] = GENERATE_COPY(table<std::string, std::string, std::string>({
      {"a.obj", "v 0 0 0\nv 1 zero 0\n", ":2: 'zero' is not a number"},
      {"a.obj", "v 0 0\n", ":1: a vertex needs three coordinates"},
      {"a.obj", "v 0 0 0\nv 1 0 0\n\nf 1 2 3\n", ":4: face names vertex 3, but 2 vertices precede it"},
      {"a.obj", "v 0 0 0\nv 1 0 0\nf 1 2 -3\n", ":3: face names vertex -3, but 2 vertices precede it"},
      {"a.obj", "v 0 0 0\nf 0 1 1\n", ":2: face names vertex 0, but 1 vertices precede it"},
      {"a.obj", "v 0 0 0\nf 1 1\n", ":2: a face needs at least three vertices"},
      {"a.obj", "v 0 0 0\nvt 0 0\n\nf 1/1 1/2 1/1\n", ":4: face names vt 2, but 1 vt lines precede it"},
      {"a.obj", "v 0 0 0\nf 1/1 1/1 1/1\nvt 0 0\n", ":2: face names vt 1, but 0 vt lines precede it"},
      {"a.obj", "v 0 0 0\nvt 0 0\nf 1/1 1 1/1\n", ":3: a face has a vt at every corner or at none"},
      {"a.obj", "v 0 0 0\nvt\n", ":2: texture coordinates need one to three numbers"},
      {"a.obj", "v 0 0 0\nvt 0 x\n", ":2: 'x' is not a number"},
      {"a.obj", "v 0 0 0\nf 1 a/1 1\n", ":2: 'a' is not an integer"},
      {"a.ply", "", ": is empty"},
      {"a.obj", "# nothing\n", ":1: the file ends without a vertex"},
      {"a.off", "ply\n", ":1: an OFF file begins with OFF, not 'ply'"},
      {"a.off", "OFF BINARY\n", ":1: binary OFF is not read; convert it to text or to PLY"},
      {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n",
       ":4: the file ends before vertex 2 (the header declares 3 vertices, 1 faces)"},
      {"a.off", "OFF\n1 1 0\n0 0 0\n3 0 0 1\n",
       ":4: vertex 1 is not in 0 … 0 (the header declares 1 vertices, 1 faces)"},
      {"a.off", "OFF\n1 1 0\n0 0 0\n3 0 0\n",
       ":4: a face of 3 vertices names fewer (the header declares 1 vertices, 1 faces)"},
      {"a.off", "OFF\n999999999 1 0\n", ":2: the file has no room for 999999999 vertices"},
      {"a.ply", "plyy\n", ":1: a PLY file begins with a line 'ply'"},
      {"a.ply", "ply\nformat ascii 2.0\n",
       ":2: expected 'format ascii|binary_little_endian|binary_big_endian 1.0'"},
      {"a.ply", "ply\nelement vertex 1\nproperty half x\n", ":3: unknown property type 'half'"},
      {"a.ply", "ply\nelement vertex 1\nproperty list float int x\n",
       ":3: the length of a list must be an integer"},
      {"a.ply", "ply\nelement vertex 1\nproperty list int x\n",
       ":3: expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'"},
      {"a.ply", "ply\nproperty int x\n", ":2: a property stands before the first element"},
      {"a.ply", "ply\nelement vertex 99999999\n", ":2: the file has no room for 99999999 elements 'vertex'"},
      {"a.ply", "ply\nformat ascii 1.0\nhello\n", ":3: unknown header line 'hello'"},
      {"a.ply", "ply\nformat ascii 1.0\n", ":2: the header has no end_header"},
      {"a.ply", "ply\nend_header\n", ":2: the header has no format line"},
      {"a.ply", "ply\nformat ascii 1.0\nend_header\n", ":3: the header must have one element 'vertex'"},
      {"a.ply", "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float z\nend_header\n",
       ": vertices have no property 'y'"},
      {"a.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", ":13: face 0: vertex 3 is not in 0 … 2" + counts},
      {"a.ply", ply + "0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n", ":11: 'x' is not a number" + counts},
      {"a.ply", with_uv + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 5 0 0 1 0 1\n",
       ":14: face 0: list 'texcoord' needs two finite numbers for each corner" + counts},
      {"a.ply", with_uv + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 6 0 0 1 0 1 nan\n",
       ":14: face 0: list 'texcoord' needs two finite numbers for each corner" + counts},
      {"a.ply", element + "property float x\n", ":5: property 'x' is declared twice"},
      {"a.ply", element + "property list uchar int x\n", ":5: property 'x' is declared twice"},
      {"a.ply", element + "element vertex 2\n", ":5: element 'vertex' is declared twice"},
      {"a.ply", element + "format ascii 1.0\n", ":5: the format is declared twice"},
      {"a.ply",
       element + "element face 1\nproperty list uchar int vertex_index\nproperty list uchar int "
                 "vertex_indices\nend_header\n",
       ":8: element 'face' must have one list 'vertex_indices'"},
      {"a.ply", element + "element face 1\nproperty int vertex_indices\nend_header\n",
       ":7: element 'face' must have one list 'vertex_indices'"},
      {"a.off", "OFF\n1 0 0 7\n0 0 0\n",
       ":2: the line has more than the numbers of vertices, faces and edges"},
      {"a.off", "OFF\n1 0 0\n0 0 0 junk\n",
       ":3: 'junk' is not a number (the header declares 1 vertices, 0 faces)"},
      {"a.off", "OFF\n1 1 0\n0 0 0\n3 0 0 0 1 1 1 1 1\n",
       ":4: the line has too many values (the header declares 1 vertices, 1 faces)"},
      {"a.obj", "v 0 0 0 junk\n", ":1: 'junk' is not a number"},
      {"a.obj", "v 0 0 0 1 1 1 1 1\n", ":1: the line has too many values"},
      {"a.obj", "v 0 0 0\nhello\n", ":2: no line of an OBJ file begins with 'hello'"},
      {"a.obj", "v 0 0 0\nf 1/x 1 1\n", ":2: 'x' is not an integer"},
      {"a.obj", "v 0 0 0\nf 1/1/1/1 1 1\n", ":2: '1/1' is not an integer"},
      {"a.obj", "v 0 nan 0\n", ":1: 'nan' is not a finite coordinate"},
      {"a.obj", "v 0 -inf 0\n", ":1: '-inf' is not a finite coordinate"},
      {"a.off", "OFF\n1 0 0\n0 0 inf\n",
       ":3: 'inf' is not a finite coordinate (the header declares 1 vertices, 0 faces)"},
      {"a.obj", "v 0 1e999 0\n", ":1: '1e999' is too large or too small for a 64-bit number"},
      {"a.obj", std::string("v 0 1\0 0\n", 9), ":1: '1\\x00' is not a number"},
      {"a.obj", "v 0 \x1b[2J 0\n", ":1: '\\x1b[2J' is not a number"},
      {"a.stl", "solid\nvertex 0 0 0\n", ":2: a vertex stands outside a facet"},
      {"a.stl", "solid\nfacet\nvertex 0 0\n", ":3: a vertex needs three coordinates"},
      {"a.stl", "solid\nfacet\nvertex 0 0 x\n", ":3: 'x' is not a number"},
      {"a.stl", "solid\nfacet\nvertex 0 0 0\nendfacet\n", ":4: a facet needs three vertices"},
      {"a.stl", "solid\nfacet\nvertex 0 0 0\n", ":3: the file ends within a facet"},
      {"a.stl", "solid\nfacet\nfacet\n", ":3: the facet before has no endfacet"},
      {"a.stl", "solid\nhello\n", ":2: no line of an STL file begins with 'hello'"},
      {"a.stl", "solid\nendsolid\n", ":2: the file ends without a facet"},
      {"a.stl", std::string("solid of a binary file\0\0\0", 25),
       ": is no STL file: text begins with 'solid', and a binary file has 84 bytes and 50 for each of the "
       "triangles that it declares; this one has 25 bytes"},
      {"a.stl", "", ": is empty"},
  }));
  const fs::path path = scratch.file(name, text);
  CHECK_THROWS_WITH(read_mesh(path), path.string() + message);
}

TEST_CASE("counts that do not fit the file are told as such", "[io]") {
  const MeshFolder scratch;
  const auto said = [&](const std::string& name, const std::string& text) {
    const std::string refusal = refusal_of([&] { read_mesh(scratch.file(name, text)); });
    return refusal.empty() ? "" : refusal.substr((scratch / name).string().size());
  };
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n",
                    body = "0 0 0\n1 0 0\n0 1.5 0\n1 1 0\n3 0 1 2\n3 2 1 3\n";
  const auto check = [&](const std::string& name, int vertices, int faces, const std::string& fault) {
    const std::string v = std::to_string(vertices), f = std::to_string(faces);
    const bool ply = name == "a.ply";
    const std::string header = ply ? "ply\nformat ascii 1.0\nelement vertex " + v + "\n" + xyz +
                                         "element face " + f +
                                         "\nproperty list uchar int vertex_indices\nend_header\n"
                                   : "OFF\n" + v + " " + f + " 0\n";
    const std::string counts =
        " (the header declares " + v + (ply ? " vertex, " : " vertices, ") + f + (ply ? " face)" : " faces)");
    CHECK(said(name, header + body) == (fault.empty() ? "" : fault + counts));
  };
  check("a.ply", 4, 2, "");
  check("a.ply", 3, 2, ":13: face 0: a face needs at least three vertices");
  check("a.ply", 2, 2, ":12: face 0: a face needs at least three vertices");
  check("a.ply", 5, 2, ":14: vertex 4: its line has more values than the header declares");
  check("a.ply", 4, 1, ":15: the file has data after the elements that its header declares");
  check("a.ply", 4, 3, ":15: the file ends where face 2 is expected");
  check("a.off", 4, 2, "");
  check("a.off", 3, 2, ":6: a face needs at least three vertices");
  check("a.off", 5, 2, ":8: the file ends before face 1");
  check("a.off", 4, 1, ":8: the file has data after its last face");

  // In binary, where no line tells.
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\n" + xyz + "end_header\n";
  CHECK(said("a.ply", header + std::string(12, '\0')) == "");
  CHECK(said("a.ply", header + std::string(12, '\0') + "\r\n") == "");
  CHECK(said("a.ply", header + std::string(13, '\0')) ==
        ": the file has data after the elements that its header declares (the header declares 1 vertex)");
  CHECK(said("a.ply", header + std::string(8, '\0') + std::string("\0\0\xc0\x7f", 4)) ==
        ": vertex 0 (counted from 0) has a coordinate that is not finite");
}

TEST_CASE("a word of a megabyte is shortened in the message", "[io]") {
  const MeshFolder scratch;
  const std::string word(1000000, 'x');
  for (const std::string& text : {"v 0 0 " + word, "f " + word, word, "v 0 0 0\nf 1/" + word + " 1 1"}) {
    const std::string said = refusal_of([&] { read_mesh(scratch.file("a.obj", text)); });
    CHECK((said.size() > 0 && said.size() < 500));
  }
}

TEST_CASE("unknown formats and missing files name what to do", "[io]") {
  CHECK_THROWS_WITH(read_mesh("cloth.3ds"),
                    "cloth.3ds: unknown mesh format '.3ds'; known are .obj, .off, .ply, .stl");
  CHECK_THROWS_WITH(write_mesh("cloth.off", {}),
                    "cloth.off: unknown mesh format '.off'; known are .obj, .ply");
  CHECK_THROWS_WITH(read_mesh("no/such.ply"), "cannot read no/such.ply: No such file or directory");
  CHECK_THROWS_WITH(write_mesh("no/such.ply", {}), "cannot write no/such.ply: No such file or directory");
}

TEST_CASE("a write that fails leaves the old file and no part", "[io]") {
  const MeshFolder scratch;
  fs::create_directories(scratch / "m.ply" / "full");  // a directory cannot be replaced by a file
  CHECK_THROWS_WITH(write_mesh(scratch / "m.ply", awkward_mesh()),
                    "cannot write " + (scratch / "m.ply").string() + ": Is a directory");
  CHECK_FALSE(fs::exists(scratch / "m.ply.part"));
  CHECK(fs::exists(scratch / "m.ply" / "full"));
  if (fs::exists("/dev/full")) {
    fs::create_symlink("/dev/full", scratch / "n.ply.part");
    CHECK_THROWS_WITH(write_mesh(scratch / "n.ply", awkward_mesh()),
                      "cannot write " + (scratch / "n.ply").string() + ": No space left on device");
    CHECK_FALSE(fs::exists(scratch / "n.ply"));
  }
}

TEST_CASE("A file that cannot be flushed to the disk is told, but not one that has no disk", "[io]") {
  CHECK_THROWS_AS(sync_to_disk("/nowhere/at_all"), WriteError);
  CHECK_NOTHROW(sync_to_disk("/dev/null"));
}

namespace {

/// The numbers of a DataArray with this attribute text: base64 of a byte count and the data.
template <class Number>
std::vector<Number> data_array(const std::string& xml, const std::string& attribute) {
  const std::size_t tag = xml.find(attribute);
  REQUIRE(tag != std::string::npos);
  const std::size_t begin = xml.find('>', tag) + 1;
  const std::string text = xml.substr(begin, xml.find('<', begin) - begin);
  REQUIRE(text.size() % 4 == 0);
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    held += 6;
    if (held >= 8) bytes += static_cast<char>(bits >> (held -= 8) & 255);
  }
  std::uint64_t size = 0;
  REQUIRE(bytes.size() >= 8);
  std::memcpy(&size, bytes.data(), 8);
  REQUIRE(size == bytes.size() - 8);
  std::vector<Number> numbers(size / sizeof(Number));
  std::memcpy(numbers.data(), bytes.data() + 8, size);
  return numbers;
}

}  // namespace

TEST_CASE("VTP arrays decode to the mesh and its fields", "[io]") {
  const int rows = GENERATE(2, 3, 4);  // different remainders of the byte counts by three
  const TriangleMesh mesh = grid({1. / 3, 1}, 2, rows, Diagonals::one_way);
  const std::string xml = vtp_text(mesh, {{"a<b&\"", mesh.vertices.col(0)}});
  const auto n = mesh.vertices.rows(), m = mesh.triangles.rows();
  CHECK(xml.find("<Piece NumberOfPoints=\"" + std::to_string(n) + "\" NumberOfPolys=\"" + std::to_string(m) +
                 "\">") != std::string::npos);
  CHECK(xml.find("type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\"") !=
        std::string::npos);
  CHECK(data_array<double>(xml, "Name=\"Points\"") ==
        std::vector<double>(mesh.vertices.data(), mesh.vertices.data() + 3 * n));
  CHECK(data_array<std::int64_t>(xml, "Name=\"connectivity\"") ==
        std::vector<std::int64_t>(mesh.triangles.data(), mesh.triangles.data() + 3 * m));
  const auto offsets = data_array<std::int64_t>(xml, "Name=\"offsets\"");
  REQUIRE(offsets.size() == static_cast<std::size_t>(m));
  for (int t = 0; t < m; ++t) CHECK(offsets[t] == 3 * (t + 1));
  const Eigen::VectorXd column = mesh.vertices.col(0);
  CHECK(data_array<double>(xml, "Name=\"a&lt;b&amp;&quot;\"") ==
        std::vector<double>(column.data(), column.data() + n));
}

TEST_CASE("a ParaView collection lists times and files", "[io]") {
  CHECK(pvd_text({{0, "frames/0.vtp"}, {0.1, "frames/1.vtp"}}) ==
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "<Collection>\n"
        "<DataSet timestep=\"0\" part=\"0\" file=\"frames/0.vtp\"/>\n"
        "<DataSet timestep=\"0.1\" part=\"0\" file=\"frames/1.vtp\"/>\n"
        "</Collection>\n</VTKFile>\n");
}

TEST_CASE("lines may end with CR, and OBJ lines go on behind a backslash", "[io]") {
  const MeshFolder scratch;
  const std::string obj =
      "# a square, C:\\cloth\\\nv 0 0 0\nv 1 0 \\\n 0\nv 1 1.5 0\nv 0 1 -.25\nf 1 2\\\n 3 \\\n4\n";
  const std::string end = GENERATE("\n", "\r", "\r\n");
  const auto with_end = [&](std::string text) {
    for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos; at += end.size())
      text.replace(at, 1, end);
    return text;
  };
  check_square(read_mesh(scratch.file("m.obj", with_end(obj))));
  check_square(read_mesh(scratch.file(
      "m.off", with_end("OFF\n4 2 0\n0 0 0\n1 0 0 # second\n1 1.5 0\n0 1 -0.25\n3 0 1 2\n3 0 2 3\n"))));
  check_square(read_mesh(scratch.file(
      "m.ply",
      with_end("ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
               "float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 "
               "0\n1 1.5 0\n0 1 -0.25\n4 0 1 2 3\n"))));
  const fs::path bad = scratch.file("bad.obj", with_end("v 0 0 0\nv 1 zero 0\n"));
  CHECK_THROWS_WITH(read_mesh(bad), bad.string() + ":2: 'zero' is not a number");
}

TEST_CASE("triangle strips of a PLY turn every second triangle over", "[io]") {
  const MeshFolder scratch;
  const TriangleMesh mesh = read_mesh(scratch.file(
      "m.ply",
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float "
      "z\nelement "
      "tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 "
      "0\n12 0 2 1 3 -1 3 2 4 5 5 4 -1\n"));
  Triangles expected(4, 3);
  expected << 0, 2, 1, 1, 2, 3, 3, 2, 4, 4, 2, 5;
  // (2, 4, 5) is the second of its strip, so turned over; (4, 5, 5) and (5, 5, 4) join.
  CHECK(mesh.triangles == expected);
}

TEST_CASE("STL as text and binary, welded at equal points", "[io]") {
  const MeshFolder scratch;
  const std::string text =
      "solid square\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1.5 0\nendloop\n"
      "endfacet\nfacet normal 0 0 1\nouter loop\nvertex -0 0 0\nvertex 1 1.5 0\nvertex 0 1 -0.25\nendloop\n"
      "endfacet\nendsolid square\n";
  for (const std::string byte_order_mark : {"", "\xEF\xBB\xBF"})
    check_square(read_mesh(scratch.file("m.stl", byte_order_mark + text)));
  const float points[2][9] = {{0, 0, 0, 1, 0, 0, 1, 1.5, 0}, {-0.0f, 0, 0, 1, 1.5, 0, 0, 1, -0.25}};
  std::string binary(80, 's');
  append(binary, std::uint32_t{2});
  for (const auto& triangle : points) {
    binary.append(12, '\0');
    for (const float x : triangle) append(binary, x);
    binary.append(2, '\0');
  }
  check_square(read_mesh(scratch.file("m.stl", binary)));
  const fs::path cut = scratch.file("cut.stl", binary.substr(0, 159));
  CHECK_THROWS_WITH(read_mesh(cut),
                    cut.string() +
                        ": is no STL file: text begins with 'solid', and a binary file has 84 bytes and 50 "
                        "for each of the triangles that it declares; this one has 159 bytes");
}

namespace {

/// A file of one face through the points, in one of the formats.
fs::path face_file(const MeshFolder& scratch, const std::string& format,
                   const std::vector<Eigen::Vector3d>& points) {
  const std::string n = std::to_string(points.size());
  const bool obj = format == "m.obj";
  std::string vertices, face;
  for (std::size_t k = 0; k < points.size(); ++k) {
    vertices += obj ? "v" : "";
    for (const double x : points[k]) vertices += " " + std::to_string(x);
    vertices += "\n";
    face += " " + std::to_string(obj ? k + 1 : k);
  }
  if (obj) return scratch.file(format, vertices + "f" + face + "\n");
  if (format == "m.off") return scratch.file(format, "OFF\n" + n + " 1 0\n" + vertices + n + face + "\n");
  return scratch.file(  // the face before its vertices
      format,
      "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex " + n +
          "\nproperty float x\nproperty float y\nproperty float z\nend_header\n" + n + face + "\n" +
          vertices);
}

}  // namespace

TEST_CASE("a concave face is cut into what it covers in every format, and one that cannot be cut is refused",
          "[io]") {
  const MeshFolder scratch;
  const std::string format = GENERATE("m.obj", "m.off", "m.ply");
  const TriangleMesh mesh = read_mesh(
      face_file(scratch, format, {{0, 1, 0}, {0, 1, 0.4}, {0, 0.4, 0.4}, {0, 0.4, 1}, {0, 0, 1}, {0, 0, 0}}));
  REQUIRE(mesh.triangles.rows() == 4);
  const Positions areas = area_vectors(mesh);
  CHECK(areas.col(0).minCoeff() > 1e-3);
  CHECK(areas.rowwise().norm().sum() / 2 == Approx(0.64));
  CHECK_THAT(refusal_of([&] {
               read_mesh(face_file(scratch, format, {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1.1, 0}}));
             }),
             Catch::Contains("face 0 (counted from 0) crosses or touches itself: its sides 0 and 2"));
}

#include <algorithm>
#include <array>
#include <boost/algorithm/string/case_conv.hpp>
#include <catch2/catch.hpp>
#include <cstdint>
#include <cstring>
#include <limits>

#include "core/kernel/files/file.h"
#include "core/numerics/mesh_files/base64.h"
#include "core/numerics/patterns/generate.h"
#include "tests/unit/mesh/mesh_files.h"

using namespace drape;
namespace fs = std::filesystem;

namespace {

template <class Matrix>
bool same_bits(const Matrix& a, const Matrix& b) {
  return a.rows() == b.rows() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a.data()[0])) == 0;
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

/// The fields of a PLY of these bytes.
VertexFields fields_in(const std::string& bytes) {
  const Scratch folder;
  folder.write("m.ply", bytes);
  return read_ply_fields(folder / "m.ply");
}

/// The file must hold the mesh of most reading tests: a square of two triangles.
void check_square(const std::string& name, const std::string& bytes) {
  CAPTURE(bytes);
  const TriangleMesh mesh = mesh_in(name, bytes);
  const Positions vertices{{0, 0, 0}, {1, 0, 0}, {1, 1.5, 0}, {0, 1, -0.25}};
  REQUIRE(mesh.vertices.rows() == 4);
  REQUIRE(mesh.triangles.rows() == 2);
  CHECK(mesh.vertices == vertices);
  CHECK(mesh.triangles == Triangles{{0, 1, 2}, {0, 2, 3}});
}

template <class Number>
void append(std::string& bytes, Number number, bool big_endian = false) {
  char raw[sizeof number];
  std::memcpy(raw, &number, sizeof number);
  if (big_endian) std::reverse(raw, raw + sizeof number);
  bytes.append(raw, sizeof number);
}

}  // namespace

TEST_CASE("PLY and OBJ read back to the same bits, a PLY's fields too") {
  const TriangleMesh mesh = awkward_mesh();
  const Scratch folder;
  for (const std::string name : {"mesh.obj", "MESH.PLY"}) {
    write_mesh(folder / name, mesh);
    const TriangleMesh back = read_mesh(folder / name);
    CHECK(same_bits(back.vertices, mesh.vertices));
    CHECK(same_bits(back.triangles, mesh.triangles));
    CHECK_FALSE(fs::exists(folder / (name + ".part")));
  }
  VertexFields fields{{"mean_curvature", mesh.vertices.col(0) / 7}, {"rest.z", mesh.vertices.col(2)}};
  fields[0].values[1] = std::numeric_limits<double>::quiet_NaN();
  const VertexFields back = fields_in(ply_bytes(mesh, fields));
  REQUIRE(back.size() == 2);
  for (int i = 0; i < 2; ++i) {
    CHECK(back[i].name == fields[i].name);
    CHECK(same_bits(back[i].values, fields[i].values));
  }
}

TEST_CASE("OBJ and OFF in all their forms") {
  const std::string obj =
      "# a square\r\no cloth\nv 0 0 0\nv +1 0 0 1.0\nvt 0 0\nvn 0 0 1\n  v 1 15e-1 0\nv 0 1 -.25 # last\n";
  for (const std::string faces : {"f 1 2 3\nf 1 3 4\n", "f 1/1 2/1 3/1\nf 1/1/1 3/1/1 4/1/1",
                                  "f 1//1 2//1 3//1\nf -4 -2 -1\n", "s off\nf 1 2 3 4\n"})
    check_square("m.obj", obj + faces);
  check_square("m.obj",
               "\xEF\xBB\xBFv 0 0 0\nv 1 0 0\nv 1 1.5 0\nv 0 1 -.25\nf 1 2 3 4\n");  // byte order mark
  check_square("m.off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1.5 0\n0 1 -0.25\n3 0 1 2\n3 0 2 3\n");
  check_square("m.off", "OFF 4 1 5\n\n0 0 0\n1 0 0\n1 1.5 0\n0 1 -0.25\n4 0 1 2 3 255 0 0\n");
  check_square("m.off",
               "COFF\n# colours\n4 2 0\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n1 1.5 0 1 0 0 1\n"
               "0 1 -0.25 1 0 0 1\n3 0 1 2\n3 0 2 3");
}

TEST_CASE("PLY as text") {
  const std::string text =
      "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nobj_info none\r\nelement vertex 4\r\n"
      "property float x\r\nproperty float32 y\r\nproperty list uchar int seen\r\nproperty double z\r\n"
      "property uchar red\r\nelement face 1\r\nproperty uchar flags\r\n"
      "property list uint8 uint vertex_index\r\nelement edge 1\r\nproperty int a\r\nend_header\r\n"
      "0 0 0 0 255\r\n1 0 2 7 8 0 254\r\n1 1.5 1 9 0 253\r\n0 1 0 -0.25 252\r\n7 4 0 1 2 3\r\n-1\r\n";
  check_square("m.ply", text);
  const VertexFields fields = fields_in(text);
  REQUIRE(fields.size() == 1);
  CHECK(fields[0].name == "red");
  CHECK(fields[0].values == Eigen::Vector4d(255, 254, 253, 252));
}

TEST_CASE("PLY in binary of either byte order and mixed types") {
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
  check_square("m.ply", bytes);
  CHECK(fields_in(bytes)[0].values == Eigen::Vector4d(0, -300, -600, -900));
  CHECK_THROWS_WITH(mesh_in("m.ply", bytes.substr(0, bytes.size() - 1)),
                    "FILE: face 1: the file ends (the header declares 4 vertex, 2 face)");
}

TEST_CASE("unknown formats and missing files name what to do") {
  CHECK_THROWS_WITH(read_mesh("cloth.3ds"),
                    "cloth.3ds: unknown mesh format '.3ds'; known are .obj, .off, .ply, .stl");
  CHECK_THROWS_WITH(write_mesh("cloth.off", {}),
                    "cloth.off: unknown mesh format '.off'; known are .obj, .ply");
  CHECK_THROWS_WITH(read_mesh("no/such.ply"), "cannot read no/such.ply: No such file or directory");
  CHECK_THROWS_WITH(write_mesh("no/such.ply", {}), "cannot write no/such.ply: No such file or directory");
}

TEST_CASE("a write that fails leaves the old file and no part") {
  const Scratch folder;
  fs::create_directories(folder / "m.ply" / "full");  // a directory cannot be replaced by a file
  CHECK_THROWS_WITH(write_mesh(folder / "m.ply", awkward_mesh()),
                    "cannot write " + (folder / "m.ply").string() + ": Is a directory");
  CHECK_FALSE(fs::exists(folder / "m.ply.part"));
  CHECK(fs::exists(folder / "m.ply" / "full"));
}

TEST_CASE("A file that cannot be flushed to the disk is told, but not one that has no disk") {
  CHECK_THROWS_AS(sync_to_disk("/nowhere/at_all"), WriteError);
  CHECK_NOTHROW(sync_to_disk("/dev/null"));
}

TEST_CASE("VTP arrays are base64 of the mesh and its fields") {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;  // whose groups of six bits are 0 to 63
  for (std::uint32_t k = 0; k < 64; k += 4) {
    std::string group;
    append(group, k << 18 | (k + 1) << 12 | (k + 2) << 6 | (k + 3), true);
    bytes += group.substr(1);
  }
  CHECK(base64(bytes) == digits);
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("f") == "Zg==");

  const TriangleMesh mesh = grid({1. / 3, 1}, 2, 3, Diagonals::one_way);
  const std::string xml = vtp_text(mesh, {{"a<b&\"", mesh.vertices.col(0)}});
  CHECK_THAT(xml, Catch::Contains("<Piece NumberOfPoints=\"6\" NumberOfPolys=\"4\">") &&
                      Catch::Contains("type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
                                      "header_type=\"UInt64\""));
  const auto check_array = [&](const std::string& name, const auto& numbers) {
    INFO(name);
    std::string expected;  // their size in bytes, then they
    append(expected, std::uint64_t{numbers.size() * sizeof(numbers[0])});
    for (const auto number : numbers) append(expected, number);
    const std::size_t begin = xml.find('>', xml.find("Name=\"" + name + "\"")) + 1;
    CHECK(xml.substr(begin, xml.find('<', begin) - begin) == base64(expected));
  };
  check_array("Points", std::vector<double>(mesh.vertices.data(), mesh.vertices.data() + 18));
  check_array("connectivity", std::vector<std::int64_t>(mesh.triangles.data(), mesh.triangles.data() + 12));
  check_array("offsets", std::vector<std::int64_t>{3, 6, 9, 12});
  check_array("a&lt;b&amp;&quot;", std::vector<double>{0, 1. / 3, 0, 1. / 3, 0, 1. / 3});
}

TEST_CASE("a ParaView collection lists times and files") {
  const std::string text = pvd_text({{0, "frames/0.vtp"}, {0.1, "frames/1.vtp"}});
  CHECK_THAT(text,
             Catch::StartsWith("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "));
  CHECK_THAT(text, Catch::EndsWith("<Collection>\n"
                                   "<DataSet timestep=\"0\" part=\"0\" file=\"frames/0.vtp\"/>\n"
                                   "<DataSet timestep=\"0.1\" part=\"0\" file=\"frames/1.vtp\"/>\n"
                                   "</Collection>\n</VTKFile>\n"));
}

TEST_CASE("lines may end with CR, and OBJ lines go on behind a backslash") {
  const std::string end = GENERATE("\n", "\r", "\r\n");
  const auto with_end = [&](std::string text) {
    for (std::size_t at = 0; (at = text.find('\n', at)) != text.npos; at += end.size())
      text.replace(at, 1, end);
    return text;
  };
  check_square("m.obj", with_end("# a square, C:\\cloth\\\nv 0 0 0\nv 1 0 \\\n 0\nv 1 1.5 0\nv 0 1 -.25\n"
                                 "f 1 2\\\n 3 \\\n4\n"));
  check_square("m.off",
               with_end("OFF\n4 2 0\n0 0 0\n1 0 0 # second\n1 1.5 0\n0 1 -0.25\n3 0 1 2\n3 0 2 3\n"));
  check_square("m.ply",
               with_end(ply_head(4, faces_head(1)) + "0 0 0\n1 0 0\n1 1.5 0\n0 1 -0.25\n4 0 1 2 3\n"));
  CHECK_THROWS_WITH(mesh_in("m.obj", with_end("v 0 0 0\nv 1 zero 0\n")), "FILE:2: 'zero' is not a number");
}

TEST_CASE("triangle strips of a PLY turn every second triangle over") {
  const TriangleMesh mesh =
      mesh_in("m.ply", ply_head(6, "element tristrips 1\nproperty list int int vertex_indices\n") +
                           "0 0 0\n0 1 0\n1 0 0\n1 1 0\n2 0 0\n2 1 0\n12 0 2 1 3 -1 3 2 4 5 5 4 -1\n");
  // (2, 4, 5) is the second of its strip, so turned over; (4, 5, 5) and (5, 5, 4) join.
  CHECK(mesh.triangles == Triangles{{0, 2, 1}, {1, 2, 3}, {3, 2, 4}, {4, 2, 5}});
}

TEST_CASE("STL as text and binary, welded at equal points") {
  const std::string text =
      "solid square\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1.5 0\nendloop\n"
      "endfacet\nfacet normal 0 0 1\nouter loop\nvertex -0 0 0\nvertex 1 1.5 0\nvertex 0 1 -0.25\nendloop\n"
      "endfacet\nendsolid square\n";
  for (const std::string byte_order_mark : {"", "\xEF\xBB\xBF"})
    for (const std::string& each : {text, boost::to_upper_copy(text)})
      check_square("m.stl", byte_order_mark + each);
  const float points[2][9] = {{0, 0, 0, 1, 0, 0, 1, 1.5, 0}, {-0.0f, 0, 0, 1, 1.5, 0, 0, 1, -0.25}};
  std::string binary(80, 's');
  append(binary, std::uint32_t{2});
  for (const auto& triangle : points) {
    binary.append(12, '\0');
    for (const float x : triangle) append(binary, x);
    binary.append(2, '\0');
  }
  check_square("m.stl", binary);
  CHECK_THROWS_WITH(mesh_in("m.stl", binary.substr(0, 159)), Catch::EndsWith("this one has 159 bytes"));
}

// A malformed mesh file is refused with its line or, where bytes have none, with the element.

#include <catch2/catch.hpp>

#include "tests/support/refusal.h"
#include "tests/unit/mesh/mesh_files.h"

namespace {

/// Each text, in a file of this name, must be refused with what stands beside it.
void check_files_refused(const std::string& name,
                         const std::vector<std::pair<std::string, std::string>>& files) {
  for (const auto& [text, refusal] : files)
    CHECK_THROWS_WITH(mesh_in(name, text), Catch::StartsWith("FILE" + refusal));
}

/// Of four vertices and two faces, unless more or fewer are declared.
const std::string square_body = "0 0 0\n1 0 0\n0 1.5 0\n1 1 0\n3 0 1 2\n3 2 1 3\n";

}  // namespace

TEST_CASE("malformed OBJ files are refused with their line") {
  check_files_refused(
      "a.obj", {{"# nothing\n", ":1: the file ends without a vertex"},
                {"v 0 0 0\nv 1 zero 0\n", ":2: 'zero' is not a number"},
                {"v 0 1e999 0\n", ":1: '1e999' is too large or too small for a 64-bit number"},
                {"v 0 nan 0\n", ":1: 'nan' is not a finite coordinate"},
                {std::string("v 0 1\0 0\n", 9), ":1: '1\\x00' is not a number"},
                {"v 0 0\n", ":1: a vertex needs three coordinates"},
                {"v 0 0 0 junk\n", ":1: 'junk' is not a number"},
                {"v 0 0 0 1 1 1 1 1\n", ":1: the line has too many values"},
                {"v 0 0 0 1\nv 2 0 0 0.5\n", ":2: a vertex has the weight 0.5, which only curves use"},
                {"v 0 0 0 2 1 1 1\n", ":1: a vertex has the weight 2, which only curves use"},
                {"v 0 0 0\nhello\n", ":2: no line of an OBJ file begins with 'hello'"},
                {"v 0 0 0\nv 1 0 0\n\nf 1 2 3\n", ":4: face names vertex 3, but 2 vertices precede it"},
                {"v 0 0 0\nv 1 0 0\nf 1 2 -3\n", ":3: face names vertex -3, but 2 vertices precede it"},
                {"v 0 0 0\nf 0 1 1\n", ":2: face names vertex 0, but 1 vertices precede it"},
                {"v 0 0 0\nf 1 1\n", ":2: a face needs at least three vertices"},
                {"v 0 0 0\nf 1 a/1 1\n", ":2: 'a' is not an integer"},
                {"v 0 0 0\nf 1/1/1/1 1 1\n", ":2: '1/1' is not an integer"},
                {"v 0 0 0\nf 1/1 1/1 1/1\nvt 0 0\n", ":2: face names vt 1, but 0 vt lines precede it"},
                {"v 0 0 0\nvt 0 0\nf 1/1 1 1/1\n", ":3: a face has a vt at every corner or at none"},
                {"v 0 0 0\nvt\n", ":2: texture coordinates need one to three numbers"}});
}

TEST_CASE("malformed OFF files are refused with their line") {
  check_files_refused(
      "a.off", {{"ply\n", ":1: an OFF file begins with OFF, not 'ply'"},
                {"OFF BINARY\n", ":1: binary OFF is not read; convert it to text or to PLY"},
                {"OFF\n999999999 1 0\n", ":2: the file has no room for 999999999 vertices"},
                {"OFF\n1 0 0 7\n", ":2: the line has more than the numbers of vertices, faces and edges"},
                {"OFF\n1 1 0\n0 0 0\n3 0 0 1\n", ":4: vertex 1 is not in 0 … 0"},
                {"OFF\n1 1 0\n0 0 0\n3 0 0\n", ":4: a face of 3 vertices names fewer"},
                {"OFF\n1 1 0\n0 0 0\n3 0 0 0 1 1 1 1 1\n", ":4: the line has too many values"},
                {"OFF\n9 1 0\n" + square_body, ":8: the file ends before vertex 6"},
                {"OFF\n3 2 0\n" + square_body, ":6: a face needs at least three vertices"},
                {"OFF\n5 2 0\n" + square_body, ":8: the file ends before face 1"},
                {"OFF\n4 1 0\n" + square_body,
                 ":8: the file has data after its last face (the header declares 4 vertices, 1 faces)"}});
}

TEST_CASE("malformed PLY files are refused with their line or element") {
  const std::string faces = faces_head(1), points = "0 0 0\n1 0 0\n0 1 0\n", ply = ply_head(3, faces);
  const std::string uv = ply_head(3, faces + "property list uchar float texcoord\n") + points;
  const std::string vertex = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\n";
  const auto declared = [&](int v, int f) { return ply_head(v, faces_head(f)) + square_body; };
  check_files_refused(
      "a.ply", {{"plyy\n", ":1: a PLY file begins with a line 'ply'"},
                {"ply\nformat ascii 2.0\n", ":2: expected 'format ascii|"},
                {"ply\nformat ascii 1.0\n", ":2: the header has no end_header"},
                {"ply\nend_header\n", ":2: the header has no format line"},
                {"ply\nformat ascii 1.0\nend_header\n", ":3: the header must have one element 'vertex'"},
                {"ply\nproperty int x\n", ":2: a property stands before the first element"},
                {"ply\nelement a 99999999\n", ":2: the file has no room for 99999999 elements 'a'"},
                {"ply\nhello\n", ":2: unknown header line 'hello'"},
                {vertex + "property half x\n", ":5: unknown property type 'half'"},
                {vertex + "property list float int x\n", ":5: the length of a list must be an integer"},
                {vertex + "property list int x\n", ":5: expected 'property TYPE NAME' or 'property list"},
                {vertex + "property list uchar int x\n", ":5: property 'x' is declared twice"},
                {vertex + "element vertex 2\n", ":5: element 'vertex' is declared twice"},
                {vertex + "format ascii 1.0\n", ":5: the format is declared twice"},
                {vertex + "property float z\nend_header\n0 0\n", ": vertices have no property 'y'"},
                {vertex + faces + "property list uchar int vertex_index\nend_header\n",
                 ":8: element 'face' must have one list 'vertex_indices'"},
                {vertex + "element face 1\nproperty int vertex_indices\nend_header\n",
                 ":7: element 'face' must have one list 'vertex_indices'"},
                {ply + points + "3 0 1 3\n", ":13: face 0: vertex 3 is not in 0 … 2"},
                {ply + "0 0 0\n1 x 0\n0 1 0\n3 0 1 2\n", ":11: 'x' is not a number"},
                {uv + "3 0 1 2 5 0 0 1 0 1\n", ":14: face 0: list 'texcoord' needs two finite numbers"},
                {uv + "3 0 1 2 6 0 0 1 0 1 nan\n", ":14: face 0: list 'texcoord' needs two finite"},
                {declared(3, 2), ":13: face 0: a face needs at least three vertices"},
                {declared(5, 2), ":14: vertex 4: its line has more values than the header declares"},
                {declared(4, 1), ":15: the file has data after the elements that its header declares"},
                {declared(4, 3),
                 ":15: the file ends where face 2 is expected (the header declares 4 vertex, 3 face)"}});
  const std::string binary =
      replaced(ply_head(1, ""), "ascii", "binary_little_endian") + std::string(8, '\0');
  check_files_refused(
      "a.ply", {{binary + std::string(5, '\0'), ": the file has data after the elements that its header"},
                {binary + std::string("\0\0\xc0\x7f", 4), ": vertex 0 (counted from 0) has a coordinate"}});
  CHECK(mesh_in("a.ply", binary + std::string(4, '\0') + "\r\n").vertices.isZero(0));
}

TEST_CASE("malformed STL files are refused with their line") {
  check_files_refused(
      "a.stl", {{"", ": is empty"},
                {"solid\nvertex 0 0 0\n", ":2: a vertex stands outside a facet"},
                {"solid\nfacet\nvertex 0 0\n", ":3: a vertex needs three coordinates"},
                {"solid\nfacet\nvertex 0 0 0\nendfacet\n", ":4: a facet needs three vertices"},
                {"solid\nfacet\nvertex 0 0 0\n", ":3: the file ends within a facet"},
                {"solid\nfacet\nfacet\n", ":3: the facet before has no endfacet"},
                {"solid\nhello\n", ":2: no line of an STL file begins with 'hello'"},
                {"solid\nendsolid\n", ":2: the file ends without a facet"},
                {std::string("solid of a binary file\0\0\0", 25),
                 ": is no STL file: text begins with 'solid', and a binary file has 84 bytes and 50 for each "
                 "of the triangles that it declares; this one has 25 bytes"}});
}

TEST_CASE("a text in UTF-16 or UTF-32 is refused by its encoding, with a mark at its beginning or without") {
  for (const auto& [name, text] : {std::pair("a.obj", "v 0 0 0\n"),
                                   {"a.off", "OFF\n1 0 0\n"},
                                   {"a.ply", "ply\nformat ascii 1.0\n"},
                                   {"a.stl", "solid\n"}})
    for (const int bytes : {2, 4})
      for (const bool big_endian : {false, true})
        for (const bool mark : {false, true}) {
          if (bytes == 4 && !mark) continue;
          CAPTURE(name, bytes, big_endian, mark);
          std::string wide;
          const auto add = [&](unsigned code) {
            for (int k = 0; k < bytes; ++k)
              wide += static_cast<char>(code >> 8 * (big_endian ? bytes - 1 - k : k) & 0xff);
          };
          if (mark) add(0xfeff);
          for (const char* c = text; *c != '\0'; ++c) add(static_cast<unsigned char>(*c));
          CHECK_THROWS_WITH(mesh_in(name, wide), "FILE: is in UTF-16 or UTF-32; save it as UTF-8");
        }
}

TEST_CASE("a word of a megabyte is shortened in the message") {
  const std::string word(1000000, 'x');
  for (const std::string& text : {"v 0 0 " + word, "f " + word, word, "v 0 0 0\nf 1/" + word + " 1 1"}) {
    const std::string said = refusal_of([&] { mesh_in("a.obj", text); });
    CHECK((said.size() > 0 && said.size() < 500));
  }
}

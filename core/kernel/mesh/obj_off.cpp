// Wavefront OBJ and OFF.
#include <algorithm>
#include <charconv>
#include <iterator>

#include "core/kernel/files/message_text.h"
#include "core/kernel/files/text_reader.h"
#include "core/kernel/mesh/io_formats.h"
#include "core/kernel/mesh/mesh_builder.h"

namespace drape {
namespace {

/// Numbers after those that are read: a weight, a colour, a normal.
void check_further_numbers(const TextReader& reader, std::size_t first_word, std::size_t most) {
  const auto& words = reader.words();
  if (words.size() > first_word + most) reader.fail("the line has too many values");
  for (std::size_t k = first_word; k < words.size(); ++k) reader.number(words[k]);
}

void read_vertex(const TextReader& reader, std::size_t first_word, std::size_t most_further,
                 MeshBuilder& builder) {
  if (reader.words().size() < first_word + 3) reader.fail("a vertex needs three coordinates");
  for (std::size_t k = 0; k < 3; ++k)
    builder.coordinates.push_back(reader.coordinate(reader.words()[first_word + k]));
  check_further_numbers(reader, first_word + 3, most_further);
}

/// Vertex index, from 0, of one corner of an OBJ face: "v", "v/vt", "v//vn" or "v/vt/vn", v from 1 or,
/// negative, counted back from the last vertex so far.
int obj_corner(const TextReader& reader, std::string_view word, int vertex_count) {
  const std::size_t slash = word.find('/');
  const long long v = reader.integer(word.substr(0, slash));
  if (slash != word.npos) {
    const std::string_view further = word.substr(slash + 1);
    const std::size_t second = std::min(further.find('/'), further.size());
    for (const std::string_view index :
         {further.substr(0, second), further.substr(std::min(second + 1, further.size()))})
      if (!index.empty()) reader.integer(index);
  }
  if (v == 0 || v > vertex_count || v < -static_cast<long long>(vertex_count))
    reader.fail("face names vertex " + std::to_string(v) + ", but " + std::to_string(vertex_count) +
                " vertices precede it");
  return static_cast<int>(v > 0 ? v - 1 : vertex_count + v);
}

/// Whether OBJ defines such a keyword, other than those of vertices and faces.
bool is_other_obj_line(std::string_view word) {
  constexpr std::string_view known[] = {
      "vt",    "vn",       "vp",       "vc",     "p",      "l",      "g",          "s",
      "o",     "mg",       "usemtl",   "mtllib", "usemap", "maplib", "shadow_obj", "trace_obj",
      "bevel", "c_interp", "d_interp", "lod",    "cstype", "deg",    "bmat",       "step",
      "curv",  "curv2",    "surf",     "parm",   "trim",   "hole",   "scrv",       "sp",
      "end",   "con",      "ctech",    "stech",  "call",   "csh"};
  return std::find(std::begin(known), std::end(known), word) != std::end(known);
}

}  // namespace

TriangleMesh read_obj(const std::filesystem::path& path, std::string_view bytes) {
  TextReader reader(path, bytes, '#', '\\');
  MeshBuilder builder;
  std::vector<int> face;
  while (reader.next_line()) {
    const auto& words = reader.words();
    if (words[0] == "v") {
      read_vertex(reader, 1, 4, builder);  // a weight, a colour
    } else if (words[0] == "f") {
      face.clear();
      for (std::size_t k = 1; k < words.size(); ++k)
        face.push_back(obj_corner(reader, words[k], builder.vertex_count()));
      if (face.size() < 3) reader.fail("a face needs at least three vertices");
      builder.add_face(face, [&](const std::string& why) { reader.fail(why); });
    } else if (!is_other_obj_line(words[0])) {
      reader.fail("no line of an OBJ file begins with '" + excerpt(words[0]) + "'");
    }
  }
  if (builder.coordinates.empty()) reader.fail("the file ends without a vertex");
  return builder.mesh();
}

TriangleMesh read_off(const std::filesystem::path& path, std::string_view bytes) {
  TextReader reader(path, bytes, '#');
  const std::string_view magic = reader.next_word("OFF");
  // Prefixes announce texture, colour and normals, which follow the coordinates and are skipped.
  if (magic != "OFF" && magic != "COFF" && magic != "NOFF" && magic != "CNOFF" && magic != "STOFF")
    reader.fail("an OFF file begins with OFF, not '" + excerpt(magic) + "'");
  std::string_view word = reader.next_word("the number of vertices");
  if (word == "BINARY") reader.fail("binary OFF is not read; convert it to text or to PLY");
  const int vertex_count = reader.count(word, "vertices");
  const int face_count = reader.count(reader.next_word("the number of faces"), "faces");
  if (reader.has_words_left()) reader.integer(reader.next_word("the number of edges"));
  if (reader.has_words_left()) reader.fail("the line has more than the numbers of vertices, faces and edges");
  reader.set_note("the header declares " + std::to_string(vertex_count) + " vertices, " +
                  std::to_string(face_count) + " faces");

  MeshBuilder builder;
  for (int v = 0; v < vertex_count; ++v) {
    if (!reader.next_line()) reader.fail("the file ends before vertex " + std::to_string(v));
    read_vertex(reader, 0, 9, builder);  // a normal, a colour, texture coordinates
  }
  std::vector<int> face;
  for (int f = 0; f < face_count; ++f) {
    if (!reader.next_line()) reader.fail("the file ends before face " + std::to_string(f));
    const auto& words = reader.words();
    const auto size = static_cast<std::size_t>(reader.count(words[0], "vertices of a face"));
    if (size < 3) reader.fail("a face needs at least three vertices");
    if (words.size() <= size) reader.fail("a face of " + std::to_string(size) + " vertices names fewer");
    face.clear();
    for (std::size_t k = 1; k <= size; ++k) face.push_back(reader.index(words[k], vertex_count, "vertex"));
    check_further_numbers(reader, size + 1, 4);  // a colour
    builder.add_face(face, [&](const std::string& why) { reader.fail(why); });
  }
  if (reader.next_line()) reader.fail("the file has data after its last face");
  return builder.mesh();
}

std::string exact_text(double value) {
  char buffer[32];
  return std::string(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

std::string obj_text(const TriangleMesh& mesh) {
  std::string text;
  for (int v = 0; v < mesh.vertices.rows(); ++v)
    text += "v " + exact_text(mesh.vertices(v, 0)) + ' ' + exact_text(mesh.vertices(v, 1)) + ' ' +
            exact_text(mesh.vertices(v, 2)) + '\n';
  for (int t = 0; t < mesh.triangles.rows(); ++t)
    text += "f " + std::to_string(mesh.triangles(t, 0) + 1) + ' ' + std::to_string(mesh.triangles(t, 1) + 1) +
            ' ' + std::to_string(mesh.triangles(t, 2) + 1) + '\n';
  return text;
}

}  // namespace drape

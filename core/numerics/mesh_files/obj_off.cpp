// Wavefront OBJ and OFF.
#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <string>

#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/mesh/mesh_builder.h"
#include "core/numerics/mesh/texture_coordinates.h"
#include "core/numerics/mesh_files/io_formats.h"
#include "core/numerics/mesh_files/text_reader.h"

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

/// An index of an OBJ face, from 0: written from 1 or, negative, counted back from the last of `count` so
/// far.
int obj_index(const TextReader& reader, std::string_view word, int count, const std::string& one,
              const std::string& several) {
  const long long i = reader.integer(word);
  if (i == 0 || i > count || i < -static_cast<long long>(count))
    reader.fail("face names " + one + " " + std::to_string(i) + ", but " + std::to_string(count) + " " +
                several + " precede it");
  return static_cast<int>(i > 0 ? i - 1 : count + i);
}

/// The corner of an OBJ face: indices from 0 of its vertex and of its texture coordinates, -1 without.
struct ObjCorner {
  int vertex = 0, uv = -1;
};

/// Reads "v", "v/vt", "v//vn" or "v/vt/vn", of the surface of an obstacle v alone.
ObjCorner obj_corner(const TextReader& reader, std::string_view word, int vertex_count, int uv_count,
                     MeshUse use) {
  const std::size_t slash = std::min(word.find('/'), word.size());
  ObjCorner corner{obj_index(reader, word.substr(0, slash), vertex_count, "vertex", "vertices")};
  if (slash == word.size() || use == MeshUse::surface) return corner;
  const std::string_view further = word.substr(slash + 1);
  const std::size_t second = std::min(further.find('/'), further.size());
  if (second + 1 < further.size()) reader.integer(further.substr(second + 1));
  if (second > 0) corner.uv = obj_index(reader, further.substr(0, second), uv_count, "vt", "vt lines");
  return corner;
}

/// The u and v of a vt line; v is 0 if it has u alone.
std::array<double, 2> obj_uv(const TextReader& reader) {
  const auto& words = reader.words();
  if (words.size() < 2) reader.fail("texture coordinates need one to three numbers");
  std::array<double, 2> uv{};
  for (std::size_t k = 0; k < std::min<std::size_t>(words.size() - 1, 2); ++k)
    uv[k] = reader.coordinate(words[k + 1]);
  check_further_numbers(reader, 3, 1);
  return uv;
}

/// The parts of an OBJ that one of its keywords names: groups, materials or objects.
struct ObjParts {
  std::string_view keyword;
  std::vector<std::string> names = {};
  std::map<std::string, int> numbers = {};  ///< of the names
  std::vector<int> of_triangle = {};
  int current = -1;

  /// A material and an object have one name, which may have blanks; of the several groups the first counts.
  void name(const std::vector<std::string_view>& words) {
    std::string name(words.size() > 1 ? words[1] : "default");
    for (std::size_t k = 2; keyword != "g" && k < words.size(); ++k) name.append(" ").append(words[k]);
    current = numbers.try_emplace(name, static_cast<int>(names.size())).first->second;
    if (current == std::ssize(names)) names.push_back(name);
  }
};

/// The pieces' names as OBJ can hold them, each of one word, and no two the same.
std::vector<std::string> obj_names(const std::vector<std::string>& pieces) {
  std::vector<std::string> names;
  for (const std::string& piece : pieces) {
    std::string name = printable(piece);
    std::ranges::replace_if(
        name, [](char c) { return c == ' ' || c == '#' || c == '\\'; }, '_');
    while (is_one_of(name, names)) name += '_';
    names.push_back(std::move(name));
  }
  return names;
}

/// Whether OBJ defines such a keyword, other than those of vertices, faces and lines.
bool is_other_obj_line(std::string_view word) {
  constexpr std::string_view known[] = {
      "vn",     "vp",     "vc",     "p",      "csh",        "g",         "s",     "o",        "mg",
      "usemtl", "mtllib", "usemap", "maplib", "shadow_obj", "trace_obj", "bevel", "c_interp", "d_interp",
      "lod",    "cstype", "deg",    "bmat",   "step",       "curv",      "curv2", "surf",     "parm",
      "trim",   "hole",   "scrv",   "sp",     "end",        "con",       "ctech", "stech",    "call"};
  return std::find(std::begin(known), std::end(known), word) != std::end(known);
}

}  // namespace

TriangleMesh read_obj(const std::filesystem::path& path, std::string_view bytes, MeshUse use, int& lines) {
  TextReader reader(path, bytes, '#', '\\');
  MeshBuilder builder{.use = use};
  std::vector<int> face;
  std::vector<std::array<double, 2>> uv;
  std::vector<double> face_uv;
  std::array<ObjParts, 3> parts{{{"g"}, {"usemtl"}, {"o"}}};
  while (reader.next_line()) {
    const auto& words = reader.words();
    if (const auto part = std::ranges::find(parts, words[0], &ObjParts::keyword); part != parts.end()) {
      part->name(words);
    } else if (words[0] == "v") {
      read_vertex(reader, 1, 4, builder);  // x y z [weight] [red green blue]
      const std::size_t further = words.size() - 4;
      if ((further == 1 || further == 4) && reader.number(words[4]) != 1)
        reader.fail("a vertex has the weight " + excerpt(words[4]) +
                    ", which only curves use; leave it out, or write 1");
    } else if (words[0] == "vt") {
      if (use == MeshUse::cloth) uv.push_back(obj_uv(reader));
    } else if (words[0] == "f") {
      face.clear();
      face_uv.clear();
      for (std::size_t k = 1; k < words.size(); ++k) {
        const ObjCorner corner =
            obj_corner(reader, words[k], builder.vertex_count(), static_cast<int>(uv.size()), use);
        face.push_back(corner.vertex);
        if (corner.uv >= 0) face_uv.insert(face_uv.end(), uv[corner.uv].begin(), uv[corner.uv].end());
      }
      if (face.empty() && use == MeshUse::surface) continue;
      if (face.size() < builder.fewest_corners()) reader.fail("a face needs at least three vertices");
      if (!face_uv.empty() && face_uv.size() < 2 * face.size())
        reader.fail("a face has a vt at every corner or at none");
      builder.add_face(face, face_uv, [&](const std::string& why) { reader.fail(why); });
      for (ObjParts& part : parts) part.of_triangle.resize(builder.corners.size() / 3, part.current);
    } else if (words[0] == "l") {
      ++lines;
    } else if (!is_other_obj_line(words[0])) {
      reader.fail("no line of an OBJ file begins with '" + excerpt(words[0]) + "'");
    }
  }
  if (builder.coordinates.empty()) reader.fail("the file ends without a vertex");
  TriangleMesh mesh = builder.mesh();
  const auto named = std::ranges::max_element(parts, {}, [](const ObjParts& p) { return p.names.size(); });
  if (named->names.size() < 2) return mesh;
  mesh.piece = named->of_triangle;
  mesh.piece_names = named->names;
  if (const auto unnamed = static_cast<int>(named->names.size()); std::ranges::count(mesh.piece, -1) > 0) {
    std::ranges::replace(mesh.piece, -1, unnamed);
    mesh.piece_names.emplace_back("unnamed");
  }
  return mesh;
}

TriangleMesh read_off(const std::filesystem::path& path, std::string_view bytes, MeshUse use) {
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

  MeshBuilder builder{.use = use};
  for (int v = 0; v < vertex_count; ++v) {
    if (!reader.next_line()) reader.fail("the file ends before vertex " + std::to_string(v));
    read_vertex(reader, 0, 9, builder);  // a normal, a colour, texture coordinates
  }
  std::vector<int> face;
  for (int f = 0; f < face_count; ++f) {
    if (!reader.next_line()) reader.fail("the file ends before face " + std::to_string(f));
    const auto& words = reader.words();
    const auto size = static_cast<std::size_t>(reader.count(words[0], "vertices of a face"));
    if (size < builder.fewest_corners()) reader.fail("a face needs at least three vertices");
    if (words.size() <= size) reader.fail("a face of " + std::to_string(size) + " vertices names fewer");
    face.clear();
    for (std::size_t k = 1; k <= size; ++k) face.push_back(reader.vertex(words[k], vertex_count));
    check_further_numbers(reader, size + 1, 4);  // a colour
    builder.add_face(face, {}, [&](const std::string& why) { reader.fail(why); });
  }
  if (reader.next_line()) reader.fail("the file has data after its last face");
  return builder.mesh();
}

std::string obj_text(const TriangleMesh& mesh) {
  std::string text;
  for (int v = 0; v < mesh.vertices.rows(); ++v)
    text += "v " + exact_text(mesh.vertices(v, 0)) + ' ' + exact_text(mesh.vertices(v, 1)) + ' ' +
            exact_text(mesh.vertices(v, 2)) + '\n';
  const std::vector<std::string> names = obj_names(mesh.piece_names);
  const UvVertices corners = split_at_seams(mesh);
  for (Eigen::Index i = 0; i < corners.uv.rows(); ++i)
    text += "vt " + exact_text(corners.uv(i, 0)) + ' ' + exact_text(corners.uv(i, 1)) + '\n';
  for (int t = 0; t < mesh.triangles.rows(); ++t) {
    if (!mesh.piece.empty() && (t == 0 || mesh.piece[t] != mesh.piece[t - 1])) {
      const std::string& name = names[mesh.piece[t]];
      text += "g " + name + "\nusemtl " + name + '\n';  // Blender keeps materials, and loses groups of faces
    }
    text += 'f';
    for (int k = 0; k < 3; ++k) {
      text += ' ' + std::to_string(mesh.triangles(t, k) + 1);
      if (corners.uv.rows() > 0) text += '/' + std::to_string(corners.triangles(t, k) + 1);
    }
    text += '\n';
  }
  return text;
}

}  // namespace drape

// PLY in: text, binary little endian and binary big endian.
#include <cmath>

#include "core/kernel/files/number_text.h"
#include "core/numerics/mesh/mesh_builder.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/mesh_files/io_formats.h"
#include "core/numerics/mesh_files/ply.h"

namespace drape {
namespace {

/// A face before it is cut, for which the vertices have to be known.
struct PlyFace {
  std::vector<int> corners;
  std::vector<double> uv;  ///< u and v of each corner; empty for a face without
  std::array<double, 3> warp{};
  double piece = -1;
};

/// A scalar vertex property.
struct PlyColumn {
  std::string name;
  std::vector<double> values;
};

constexpr std::array<const char*, 3> warp_names{"warp_x", "warp_y", "warp_z"};

struct PlyContent {
  MeshBuilder mesh;
  int vertex_count = 0, line_count = 0;
  std::vector<PlyFace> faces;
  bool has_warp = false;     ///< of the faces
  std::vector<double> warp;  ///< 3m, or none
  std::vector<int> piece;    ///< m, or none
  std::vector<std::string> piece_names;
  std::optional<double> uv_length;
  std::vector<PlyColumn> columns;

  /// The values of a scalar vertex property; null without one of this name.
  const std::vector<double>* column(const std::string& name) const {
    const auto found = std::ranges::find(columns, name, &PlyColumn::name);
    return found == columns.end() ? nullptr : &found->values;
  }
};

/// Reads an element: calls on_number(property, value) and on_list(property, values) for its properties, then
/// on_end().
template <class OnNumber, class OnList, class OnEnd>
void read_element(PlyBody& body, const PlyElement& element, const OnNumber& on_number, const OnList& on_list,
                  const OnEnd& on_end) {
  std::vector<double> values;
  const int count = element.properties.empty() ? 0 : element.count;  // these take no byte, so any number fits
  for (int i = 0; i < count; ++i) {
    body.enter(element, i);
    for (const PlyProperty& p : element.properties) {
      if (!p.count_type) {
        on_number(p, body.next(p.type));
        continue;
      }
      const auto count = static_cast<long long>(body.next(*p.count_type));
      if (count < 0) body.fail("list '" + excerpt(p.name) + "' has a negative length");
      values.clear();
      for (long long k = 0; k < count; ++k) values.push_back(body.next(p.type));
      on_list(p, values);
    }
    on_end();
  }
}

constexpr auto ignore = [](const auto&...) {};

void read_vertices(PlyBody& body, const PlyElement& element, PlyContent& content) {
  for (const PlyProperty& p : element.properties)
    if (!p.count_type) content.columns.push_back({p.name, {}});
  std::size_t column = 0;
  const auto on_number = [&](const PlyProperty&, double value) {
    content.columns[column++].values.push_back(value);
  };
  read_element(body, element, on_number, ignore, [&] { column = 0; });
}

bool holds_corners(const PlyProperty& p) {
  return p.count_type && (p.name == "vertex_indices" || p.name == "vertex_index");
}

bool has_warp(const PlyElement& faces) {
  return std::ranges::count_if(faces.properties, [](const PlyProperty& p) {
           return !p.count_type && std::ranges::count(warp_names, p.name) > 0;
         }) == std::ssize(warp_names);
}

int corner(const PlyBody& body, double v, int vertex_count) {
  if (!(v >= 0 && v < vertex_count && v == std::floor(v)))
    body.fail("vertex " + exact_text(v) + " is not in 0 … " + std::to_string(vertex_count - 1));
  return static_cast<int>(v);
}

void add_face(const PlyBody& body, const std::vector<double>& values, const std::vector<double>& uv,
              PlyContent& content) {
  if (values.size() < content.mesh.fewest_corners()) body.fail("a face needs at least three vertices");
  std::vector<int> face;
  for (const double v : values) face.push_back(corner(body, v, content.vertex_count));
  const bool finite = std::all_of(uv.begin(), uv.end(), [](double number) { return std::isfinite(number); });
  if (!uv.empty() && (uv.size() != 2 * face.size() || !finite))
    body.fail("list 'texcoord' needs two finite numbers for each corner");
  content.faces.push_back({std::move(face), uv, {}});
}

/// Strips end with -1 or the list. Every second triangle of a strip is turned over, and one that repeats a
/// vertex only joins its neighbours.
void add_strips(const PlyBody& body, const std::vector<double>& values, const std::vector<double>&,
                PlyContent& content) {
  std::vector<int> strip;
  for (const double v : values) {
    if (v == -1) {
      strip.clear();
      continue;
    }
    strip.push_back(corner(body, v, content.vertex_count));
    if (strip.size() < 3) continue;
    std::array<int, 3> t{strip.end()[-3], strip.end()[-2], strip.end()[-1]};
    if (strip.size() % 2 == 0) std::swap(t[0], t[1]);
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) content.faces.push_back({{t.begin(), t.end()}, {}, {}});
  }
}

/// Reads an element of faces or of strips, whose lists of vertices and texture coordinates `add` takes.
template <class Add>
void read_faces(PlyBody& body, const PlyElement& element, PlyContent& content, const Add& add) {
  std::vector<double> corners, uv;
  std::array<double, 3> warp{};
  double piece = -1;
  const auto on_number = [&](const PlyProperty& p, double value) {
    if (p.name == "piece") piece = value;
    for (int k = 0; k < 3; ++k)
      if (p.name == warp_names[k]) warp[k] = value;
  };
  const auto on_list = [&](const PlyProperty& p, const std::vector<double>& values) {
    if (holds_corners(p)) corners = values;
    if (p.name == "texcoord" && content.mesh.use == MeshUse::cloth) uv = values;
  };
  read_element(body, element, on_number, on_list, [&] {
    const std::size_t before = content.faces.size();
    add(body, corners, uv, content);
    for (std::size_t i = before; i < content.faces.size(); ++i) {
      content.faces[i].warp = warp;
      content.faces[i].piece = piece;
    }
    uv.clear();
  });
}

std::string counts_of(const PlyHeader& header) {
  std::string text;
  for (const PlyElement& e : header.elements)
    text += (text.empty() ? "" : ", ") + std::to_string(e.count) + " " + e.name;
  return "the header declares " + excerpt(text);
}

PlyContent read_content(const std::filesystem::path& path, std::string_view bytes, MeshUse use) {
  TextReader reader(path, bytes, '\0');
  const PlyHeader header = read_ply_header(reader);
  const auto vertices = std::ranges::find(header.elements, std::string("vertex"), &PlyElement::name);
  if (vertices == header.elements.end()) reader.fail("the header must have one element 'vertex'");
  for (const PlyElement& e : header.elements)
    if ((e.name == "face" || e.name == "tristrips") && e.count > 0 &&
        std::count_if(e.properties.begin(), e.properties.end(), holds_corners) != 1)
      reader.fail("element '" + e.name + "' must have one list 'vertex_indices'");
  reader.set_note(counts_of(header));

  PlyContent content;
  content.mesh.use = use;
  content.vertex_count = vertices->count;
  PlyBody body(reader, bytes, header.format, path);
  for (const PlyElement& element : header.elements) {
    if (element.name == "vertex")
      read_vertices(body, element, content);
    else if (element.name == "face")
      content.has_warp = has_warp(element), read_faces(body, element, content, add_face);
    else if (element.name == "tristrips")
      read_faces(body, element, content, add_strips);
    else
      read_element(body, element, ignore, ignore, [&] { content.line_count += element.name == "edge"; });
  }
  body.finish();

  content.mesh.coordinates.resize(3 * static_cast<std::size_t>(content.vertex_count));
  for (int axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    const std::vector<double>* values = content.column(name);
    if (!values) refuse_path(path, "vertices have no property '" + name + "'");
    for (std::size_t v = 0; v < values->size(); ++v) {
      const double x = (*values)[v];
      if (!std::isfinite(x))
        refuse_path(path,
                    "vertex " + std::to_string(v) + " (counted from 0) has a coordinate that is not finite");
      content.mesh.coordinates[3 * v + axis] = x;
    }
  }
  for (const PlyFace& face : content.faces) {
    content.mesh.add_face(face.corners, face.uv, [&](const std::string& why) { refuse_path(path, why); });
    if (!header.pieces.empty()) {
      if (!(face.piece >= 0 && face.piece < static_cast<double>(header.pieces.size())))
        refuse_path(path, "a face has no piece among the " + std::to_string(header.pieces.size()) +
                              " that the header names");
      content.piece.resize(content.mesh.corners.size() / 3, static_cast<int>(face.piece));
    }
    while (content.has_warp && content.warp.size() < content.mesh.corners.size())
      content.warp.insert(content.warp.end(), face.warp.begin(), face.warp.end());
  }
  content.piece_names = header.pieces;
  content.uv_length = header.uv_length;
  return content;
}

/// Texture coordinates that the file has at vertices, under the names that Blender, MeshLab or PCL write.
void set_uv_of_vertices(const PlyContent& content, TriangleMesh& mesh) {
  for (const auto& [u, v] : {std::pair("s", "t"), {"texture_u", "texture_v"}, {"u", "v"}}) {
    const std::vector<double>*us = content.column(u), *vs = content.column(v);
    if (!us || !vs) continue;
    mesh.uv.resize(mesh.triangles.rows(), 6);
    for (Eigen::Index t = 0; t < mesh.uv.rows(); ++t)
      for (int k = 0; k < 3; ++k)
        mesh.uv.block<1, 2>(t, 2 * k) << (*us)[mesh.triangles(t, k)], (*vs)[mesh.triangles(t, k)];
    if (mesh.uv.allFinite()) return;
    mesh.uv.resize(0, 6);
  }
}

}  // namespace

TriangleMesh read_ply(const std::filesystem::path& path, std::string_view bytes, MeshUse use, int& lines) {
  const PlyContent content = read_content(path, bytes, use);
  lines += content.line_count;
  TriangleMesh mesh = content.mesh.mesh();
  mesh.warp = Eigen::Map<const Positions>(content.warp.data(), std::ssize(content.warp) / 3, 3);
  mesh.piece = content.piece;
  mesh.piece_names = content.piece_names;
  if (mesh.uv.rows() == 0 && use == MeshUse::cloth) set_uv_of_vertices(content, mesh);
  if (content.uv_length && *content.uv_length > 0 && mesh.uv.rows() > 0)
    mesh.sewing = Sewing{*content.uv_length};
  return mesh;
}

VertexFields ply_fields(const std::filesystem::path& path, std::string_view bytes) {
  const PlyContent content = read_content(path, bytes, MeshUse::cloth);
  VertexFields fields;
  for (const auto& [name, values] : content.columns)
    if (name != "x" && name != "y" && name != "z")
      fields.push_back({name, Eigen::Map<const Eigen::VectorXd>(values.data(), std::ssize(values))});
  return fields;
}

VertexFields read_ply_fields(const std::filesystem::path& path) { return ply_fields(path, read_file(path)); }

}  // namespace drape

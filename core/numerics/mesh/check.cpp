#include "core/numerics/mesh/check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/kernel/files/message_text.h"
#include "core/kernel/plugin/bounds.h"
#include "core/numerics/mesh/area_vectors.h"
#include "core/numerics/mesh/mesh_faults.h"
#include "core/numerics/mesh/texture_coordinates.h"
#include "core/numerics/mesh/unjoined_borders.h"

namespace drape {
namespace {

constexpr std::size_t most_examples = 5;  // of each kind of fault

std::string text(int number) { return std::to_string(number); }

/// Ends a text with indices: a mesh file's own, and messages with its lines, may count from 1.
constexpr const char* from_0 = " (counted from 0)";

std::string triangle_text(const Triangles& triangles, int t) {
  return text(t) + " (" + text(triangles(t, 0)) + ", " + text(triangles(t, 1)) + ", " +
         text(triangles(t, 2)) + ")";
}

std::string edge_text(const FaultyEdge& edge) {
  constexpr std::size_t most_named = 8;
  std::string names = "(" + text(edge.smaller) + ", " + text(edge.larger) + ") in triangles";
  for (std::size_t k = 0; k < std::min(edge.triangles.size(), most_named); ++k)
    names += (k == 0 ? " " : ", ") + text(edge.triangles[k]);
  return names + (edge.triangles.size() > most_named ? ", …" : "");
}

/// How a kind of fault reads: "3 triangles have no area: 4 (0, 1, 2), … (counted from 0); remove them".
struct Wording {
  const char *one, *many, *fault, *remedy;
};

using Lines = std::vector<std::string>;

/// Appends a line for a kind of fault, with a few examples.
template <class Elements, class Text>
void add_line(Lines& lines, const Elements& elements, const Wording& wording, const Text& text_of) {
  if (elements.empty()) return;
  std::string line = std::to_string(elements.size()) + " " +
                     (elements.size() == 1 ? wording.one : wording.many) + wording.fault;
  for (std::size_t k = 0; k < std::min(elements.size(), most_examples); ++k)
    line += (k == 0 ? ": " : ", ") + text_of(elements[k]);
  if (elements.size() > most_examples) line += ", …";
  lines.push_back(line + from_0 + "; " + wording.remedy);
}

/// Appends the triangles that name a vertex out of range. Returns whether all are in range.
bool check_indices(const TriangleMesh& mesh, Lines& lines) {
  const int n = static_cast<int>(mesh.vertices.rows());
  std::vector<int> faulty;
  for (int t = 0; t < mesh.triangles.rows(); ++t)
    if (mesh.triangles.row(t).minCoeff() < 0 || mesh.triangles.row(t).maxCoeff() >= n) faulty.push_back(t);
  const std::string range = "vertices go from 0 to " + text(n - 1);
  add_line(lines, faulty, {"triangle names", "triangles name", " a vertex that is not there", range.c_str()},
           [&](int t) { return triangle_text(mesh.triangles, t); });
  return faulty.empty();
}

void check_elements(const MeshFaults& faults, const Triangles& triangles, Lines& lines) {
  const auto triangle = [&](int t) { return triangle_text(triangles, t); };
  add_line(lines, faults.loose_vertices,
           {"vertex belongs", "vertices belong", " to no triangle",
            "remove them, or merge those at the place of another, as a cloth's \"join\" does"},
           text);
  add_line(lines, faults.repeating_triangles,
           {"triangle repeats", "triangles repeat", " a vertex",
            "remove them; if a cloth's \"join\" made them, lower it"},
           triangle);
  add_line(lines, faults.empty_triangles,
           {"triangle has", "triangles have", " no area", "move their vertices apart, or remove them"},
           triangle);
  add_line(lines, faults.low_triangles,
           {"triangle is", "triangles are", " so low that rounding of coordinates strains the cloth",
            "move the vertices apart, or mesh the cloth anew there"},
           triangle);
  add_line(lines, faults.doubled_triangles,
           {"triangle has", "triangles have", " the same vertices as another", "remove one of each two"},
           [&](const MeshFaults::Pair& p) { return triangle(p.element) + " as " + text(p.other); });
}

void check_connectivity(const MeshFaults& faults, Lines& lines) {
  add_line(lines, faults.crowded_edges,
           {"edge has", "edges have", " more than two triangles",
            "a sheet has one or two at each edge: remove those between its sides, or cut it there"},
           edge_text);
  std::vector<FaultyEdge> turned, one_sided;
  for (const FaultyEdge& edge : faults.inverted_edges) (edge.one_sided ? one_sided : turned).push_back(edge);
  add_line(lines, turned,
           {"edge runs", "edges run", " in the same direction in both triangles",
            "turn one side over, so that all triangles have the same front side"},
           edge_text);
  add_line(lines, one_sided,
           {"edge of a surface with one side, as a Möbius band has, runs",
            "edges of a surface with one side, as a Möbius band has, run",
            " in the same direction in both triangles", "a cloth has two sides: cut it open along them"},
           edge_text);
  add_line(lines, faults.shared_vertices,
           {"vertex joins", "vertices join", " separate fans of triangles",
            "give every fan a vertex of its own, or join the fans along an edge"},
           [](const MeshFaults::Pair& p) { return text(p.element) + " of " + text(p.other) + " fans"; });
}

/// Appends what shows that triangles beside one another are not joined.
void check_borders(const TriangleMesh& mesh, Lines& lines) {
  if (is_soup(mesh)) {
    lines.push_back(
        text(static_cast<int>(mesh.triangles.rows())) +
        " triangles share no vertices, but lie edge to edge (a triangle soup); weld it: merge the "
        "vertices that are at the same place");
    return;
  }
  add_line(lines, t_junctions(mesh),
           {"border vertex lies", "border vertices lie", " inside a border edge (T-junctions)",
            "the cloth would open there: split the edge's triangle at the vertex"},
           [](const TJunction& j) {
             return text(j.vertex) + " in (" + text(j.edge[0]) + ", " + text(j.edge[1]) + ")";
           });
}

void check_overlaps(const TriangleMesh& mesh, Lines& lines) {
  add_line(lines, flat_overlaps(mesh),
           {"triangle of this flat mesh overlaps", "triangles of this flat mesh overlap",
            " those around a vertex: each faces the other way than they do",
            "move its vertices to where no triangles overlap"},
           [&](int t) { return triangle_text(mesh.triangles, t); });
}

}  // namespace

std::vector<std::string> check_coordinates(const Positions& x) {
  Lines faults;
  std::vector<int> not_finite, too_large;
  for (int v = 0; v < x.rows(); ++v) {
    const double largest = x.row(v).cwiseAbs().maxCoeff<Eigen::PropagateNaN>();
    if (!std::isfinite(largest))
      not_finite.push_back(v);
    else if (largest > bounds::largest_coordinate)
      too_large.push_back(v);
  }
  const std::string at_most = "at most " + three_digits(bounds::largest_coordinate) +
                              " m can be computed with: is the file in metres?";
  add_line(faults, not_finite,
           {"vertex has", "vertices have", " a coordinate that is not finite", "write the file again"}, text);
  add_line(faults, too_large, {"vertex has", "vertices have", " too large a coordinate", at_most.c_str()},
           [&](int v) { return text(v) + " with " + three_digits(x.row(v).cwiseAbs().maxCoeff()) + " m"; });
  if (x.rows() == 0 || !faults.empty()) return faults;
  const double diagonal = bounding_box_diagonal(x);
  const double distance = x.cwiseAbs().maxCoeff();
  const double rounding = distance * std::numeric_limits<double>::epsilon();
  if (diagonal < bounds::smallest_diagonal)
    faults.push_back("the mesh is " + three_digits(diagonal) + " m across; at least " +
                     three_digits(bounds::smallest_diagonal) + " m can be computed with");
  else if (rounding > largest_rounding * diagonal)
    faults.push_back("the mesh is " + three_digits(diagonal) + " m across and " + three_digits(distance) +
                     " m from the origin, where rounding moves vertices by " + three_digits(rounding) +
                     " m; move it nearer");
  return faults;
}

std::vector<std::string> check_mesh(const TriangleMesh& mesh) {
  Lines lines;
  if (mesh.vertices.rows() == 0) lines.push_back("the mesh has no vertices");
  if (mesh.triangles.rows() == 0) lines.push_back("the mesh has no triangles");
  if (!check_indices(mesh, lines)) return lines;
  const int count = static_cast<int>(mesh.vertices.rows());
  if (std::string fault = crowded_vertex(mesh.triangles, count); !fault.empty()) return {std::move(fault)};
  const Lines coordinates = check_coordinates(mesh.vertices);
  const bool is_sound = coordinates.empty();  // else no shape can be computed
  lines.insert(lines.end(), coordinates.begin(), coordinates.end());

  MeshFaults faults = MeshFaults::of_elements(mesh);
  if (!is_sound) faults.empty_triangles.clear(), faults.low_triangles.clear();
  std::vector<char> removed(mesh.triangles.rows(), 0);  // by the remedy of another fault
  for (const int t : faults.repeating_triangles) removed[t] = 1;
  for (const MeshFaults::Pair& pair : faults.doubled_triangles) removed[pair.element] = 1;
  faults.find_connectivity(mesh.triangles, count, removed);
  check_elements(faults, mesh.triangles, lines);
  check_connectivity(faults, lines);
  if (is_sound) check_borders(mesh, lines);
  if (lines.empty()) check_overlaps(mesh, lines);
  return lines;
}

std::vector<std::string> check_pieces(const TriangleMesh& mesh) {
  const double across = mesh.sewing->uv_length * (mesh.uv.maxCoeff() - mesh.uv.minCoeff());
  if (across < bounds::smallest_diagonal || across > bounds::largest_coordinate)
    return {"the pieces are " + three_digits(across) + " m across by their texture coordinates, and " +
            three_digits(bounds::smallest_diagonal) + " to " + three_digits(bounds::largest_coordinate) +
            " m can be computed with; check \"uv_unit\""};
  Lines lines;
  constexpr double flat = 1e-12;  // height over the longest side
  std::vector<int> empty;
  for (int t = 0; t < mesh.triangles.rows(); ++t)
    if (!(relative_height(rest_corners(mesh, t)) > flat)) empty.push_back(t);
  const auto name = [&](int t) { return triangle_text(mesh.triangles, t); };
  add_line(lines, empty,
           {"triangle has", "triangles have", " no area in texture coordinates",
            "\"rest: uv\" takes its shape from there: unwrap it"},
           name);
  if (!lines.empty()) return lines;
  const UvVertices split = split_at_seams(mesh);
  TriangleMesh unfolded{Positions::Zero(split.uv.rows(), 3), split.triangles};
  unfolded.vertices.leftCols<2>() = split.uv;
  add_line(lines, flat_overlaps(unfolded),
           {"triangle is", "triangles are", " turned over in texture coordinates, onto those around a vertex",
            "unwrap the piece without overlaps"},
           name);
  return lines;
}

}  // namespace drape

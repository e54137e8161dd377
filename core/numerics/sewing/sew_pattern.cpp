#include "core/numerics/sewing/sew_pattern.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "core/kernel/files/message_text.h"
#include "core/numerics/mesh/disjoint_sets.h"
#include "core/numerics/mesh/mesh_faults.h"
#include "core/numerics/mesh/rotation.h"
#include "core/numerics/mesh_files/file_coordinates.h"
#include "core/numerics/sewing/panel_meshes.h"

namespace drape {

namespace {

constexpr double gap_of_pieces = 0.05;  // between texture coordinates [m]

using VertexPair = std::pair<int, int>;

VertexPair in_order(int a, int b) { return std::minmax(a, b); }

/// Panels' vertices, one panel's after another's, and what the stitches make of them.
class Joints {
 public:
  explicit Joints(const std::vector<PanelMesh>& panels) {
    int count = 0;
    for (const PanelMesh& panel : panels) {
      first_.push_back(count);
      count += static_cast<int>(panel.flat.vertices.rows());
    }
    DisjointSets sets(count);
    std::map<int, int> vertex_of;  // a vertex of each stitch
    for (std::size_t p = 0; p < panels.size(); ++p)
      for (int v = 0; v < panels[p].border(); ++v)
        for (const int stitch : {panels[p].stitches[v], panels[p].ends[v]})
          if (stitch >= 0) sets.unite(first_[p] + v, vertex_of.emplace(stitch, first_[p] + v).first->second);
    joined_ = sets.numbered();
  }
  int vertex_count() const { return *std::ranges::max_element(joined_) + 1; }
  int of(std::size_t panel, int vertex) const { return joined_[first_[panel] + vertex]; }

 private:
  std::vector<int> first_, joined_;
};

/// Divides the edge from a to b, and the triangles beside it, by a new vertex in its middle.
void split_edge(TriangleMesh& mesh, int a, int b) {
  const auto middle = static_cast<int>(mesh.vertices.rows());
  mesh.vertices.conservativeResize(middle + 1, 3);
  mesh.vertices.row(middle) = (mesh.vertices.row(a) + mesh.vertices.row(b)) / 2;
  const Eigen::Index count = mesh.triangles.rows();
  for (Eigen::Index t = 0; t < count; ++t)
    for (int k = 0; k < 3; ++k) {
      const int from = mesh.triangles(t, k), to = mesh.triangles(t, (k + 1) % 3);
      if (in_order(from, to) != in_order(a, b)) continue;
      const int other = mesh.triangles(t, (k + 2) % 3);
      mesh.triangles.row(t) << from, middle, other;
      mesh.triangles.conservativeResize(mesh.triangles.rows() + 1, 3);
      mesh.triangles.bottomRows<1>() << middle, to, other;
      break;
    }
}

/// Divides the edges between border vertices of a panel that no seam joins, but that its stitches lay on
/// another edge, as those across the corners of a bag and its opening, if that is one edge wide.
void divide_doubled_edges(std::vector<PanelMesh>& panels, const Joints& joints) {
  struct Use {
    std::size_t panel;
    VertexPair edge;
  };
  std::map<VertexPair, std::vector<Use>> uses;
  for (std::size_t p = 0; p < panels.size(); ++p) {
    std::set<VertexPair> edges;
    for (const auto& t : panels[p].flat.triangles.rowwise())
      for (int k = 0; k < 3; ++k) edges.insert(in_order(t[k], t[(k + 1) % 3]));
    for (const VertexPair& edge : edges)
      if (edge.second < panels[p].border())
        uses[in_order(joints.of(p, edge.first), joints.of(p, edge.second))].push_back({p, edge});
  }
  constexpr std::size_t most = 1000;  // each looks at a whole panel; what is left is refused as crowded
  std::vector<Use> doubled;
  for (const auto& [joined, all] : uses)
    for (const Use& use : all)
      if (all.size() > 1 && !panels[use.panel].sewn.contains(use.edge)) doubled.push_back(use);
  if (doubled.size() > most) return;
  for (const auto& [panel, edge] : doubled) split_edge(panels[panel].flat, edge.first, edge.second);
}

/// For each panel whether it is turned over, so that all have their right sides on the same side of the cloth
/// but those beyond a seam of right on wrong sides. Appends the seams that leave the cloth one side.
std::vector<char> turned_panels(const Pattern& pattern, ConfigErrors& errors) {
  struct Neighbour {
    int panel;
    const Seam* seam;
  };
  std::vector<std::vector<Neighbour>> neighbours(pattern.panels.size());
  for (const Seam& seam : pattern.seams)
    for (const int side : {0, 1})
      for (const EdgeIndex& edge : seam.sides[side]) {  // one of the other side stands for all of them
        const int other = seam.sides[1 - side][0].panel;
        neighbours[edge.panel].push_back({other, &seam});
        neighbours[other].push_back({edge.panel, &seam});
      }
  std::vector<char> turned(pattern.panels.size(), 0), found(pattern.panels.size(), 0);
  std::set<const Seam*> faulty;
  for (int first = 0; first < std::ssize(turned); ++first) {
    if (found[first]) continue;
    std::vector<int> part = {first};
    found[first] = 1;
    for (std::size_t i = 0; i < part.size(); ++i)
      for (const auto& [panel, seam] : neighbours[part[i]]) {
        const char wanted = static_cast<char>(turned[part[i]] != static_cast<char>(seam->right_wrong));
        if (!found[panel])
          found[panel] = 1, turned[panel] = wanted, part.push_back(panel);
        else if (turned[panel] != wanted && faulty.insert(seam).second)
          errors.push_back(
              {seam->where, "seam " + seam->name +
                                " gives the cloth one side, as a Möbius band has; sew it the other way "
                                "round (\"right_wrong\")"});
      }
    const auto count = std::ranges::count_if(part, [&](int p) { return turned[p] != 0; });
    if (2 * count > std::ssize(part))
      for (const int p : part) turned[p] = !turned[p];
  }
  return turned;
}

/// Appends where the joined panels are not a sheet of two sides.
void check_joints(const Pattern& pattern, const TriangleMesh& cloth, double edge_length,
                  ConfigErrors& errors) {
  MeshFaults faults = MeshFaults::of_elements(cloth);
  const auto panel_of = [&](int t) -> const Panel& { return pattern.panels[cloth.piece[t]]; };
  const auto names = [&](const std::vector<int>& triangles) {
    std::set<std::string> panels;
    for (const int t : triangles) panels.insert(panel_of(t).name);
    std::string text;
    for (const std::string& name : panels) text += (text.empty() ? "" : ", ") + name;
    return (panels.size() == 1 ? "panel " : "panels ") + text;
  };
  const double size = std::sqrt(outline_size(pattern).area / static_cast<double>(pattern.panels.size()));
  const std::string remedy = size > edge_length
                                 ? "; take one of the seams out, or choose a shorter \"edge_length\""
                                 : "; the panels are about " + three_digits(size) +
                                       " m wide, less than \"edge_length\" (" + three_digits(edge_length) +
                                       " m): check \"units_in_meter\"";
  std::set<std::string> told;
  const auto add = [&](int t, const std::string& text) {
    if (told.insert(text).second) errors.push_back({panel_of(t).where, text + remedy});
  };
  for (const int t : faults.repeating_triangles)
    add(t, names({t}) +
               ": its seams join two vertices of one triangle; where they join both sides of a corner, "
               "end them one triangle before it, by a vertex on each side");
  if (!errors.empty()) return;
  for (const auto& [t, other] : faults.doubled_triangles)
    add(t, names({t, other}) + ": the seams lay one triangle on another");
  if (!errors.empty()) return;
  faults.find_connectivity(cloth.triangles, static_cast<int>(cloth.vertices.rows()),
                           std::vector<char>(cloth.triangles.rows(), 0));
  for (const FaultyEdge& edge : faults.crowded_edges)
    add(edge.triangles[0], names(edge.triangles) + " meet at one edge, where a cloth has two triangles");
  std::map<int, std::vector<int>> around;  // each vertex that is shared its triangles
  for (const auto& [v, fans] : faults.shared_vertices) around[v];
  for (int t = 0; t < cloth.triangles.rows(); ++t)
    for (const int v : cloth.triangles.row(t))
      if (const auto shared = around.find(v); shared != around.end()) shared->second.push_back(t);
  for (const auto& [v, triangles] : around)
    add(triangles[0], names(triangles) + " meet at a point only, as seams join it and no edges beside it");
}

}  // namespace

double Pattern::length(const std::vector<EdgeIndex>& chain) const {
  double sum = 0;
  for (const EdgeIndex& e : chain) sum += edge(e).curve.length();
  return sum;
}

double Pattern::gathered(const Seam& seam) const {
  const double first = length(seam.sides[0]), second = length(seam.sides[1]);
  return std::abs(first - second) / std::max(first, second);
}

double area_of(const std::vector<int>& loop, const std::vector<PanelEdge>& edges) {
  constexpr int steps = 32;  // of a curve
  Polygon corners;
  for (const int e : loop)
    for (int i = 0; i < steps; ++i) corners.push_back(edges[e].curve.at(double(i) / steps));
  return area_of(corners);
}

OutlineSize outline_size(const Pattern& pattern) {
  OutlineSize size;
  for (const Panel& panel : pattern.panels) {
    double area = 0;
    for (const std::vector<int>& loop : panel.loops) {
      for (const int e : loop) size.border += panel.edges[e].curve.length();
      area += (&loop == &panel.loops[0] ? 1 : -1) * std::abs(area_of(loop, panel.edges));
    }
    size.area += std::max(area, 0.0);  // holes that are larger than their outline are refused later
  }
  return size;
}

std::optional<TriangleMesh> sew_pattern(const Pattern& pattern, double edge_length, ConfigErrors& errors,
                                        LabelEdges* labels) {
  const std::size_t before = errors.size();
  const auto divisions = divide_edges(pattern, edge_length, errors);
  if (errors.size() > before) return std::nullopt;
  std::vector<PanelMesh> panels = mesh_panels(pattern, edge_length, divisions, errors);
  const std::vector<char> turned = turned_panels(pattern, errors);
  if (errors.size() > before) return std::nullopt;
  divide_doubled_edges(panels, Joints(panels));
  const Joints joints(panels);

  TriangleMesh cloth{Positions::Zero(joints.vertex_count(), 3), {}};
  Eigen::Index triangle_count = 0, t = 0;
  for (const PanelMesh& panel : panels) triangle_count += panel.flat.triangles.rows();
  cloth.triangles.resize(triangle_count, 3);
  cloth.uv.resize(triangle_count, 6);
  cloth.warp.resize(triangle_count, 3);
  Eigen::VectorXd places = Eigen::VectorXd::Zero(joints.vertex_count());
  double right_end = 0;  // of the panels before, which lie in a row
  for (std::size_t p = 0; p < panels.size(); ++p) {
    const Panel& panel = pattern.panels[p];
    const TriangleMesh& flat = panels[p].flat;
    const Eigen::AlignedBox3d box = bounding_box(flat.vertices);
    const Eigen::RowVector2d shift(right_end - box.min().x(), -box.min().y());
    right_end += box.sizes().x() + gap_of_pieces;
    const Eigen::Matrix3d rotation = rotation_matrix(panel.rotation);
    for (int v = 0; v < flat.vertices.rows(); ++v) {
      cloth.vertices.row(joints.of(p, v)) +=
          (rotation * flat.vertices.row(v).transpose() + panel.translation).transpose();
      ++places[joints.of(p, v)];
    }
    for (Eigen::Index i = 0; i < flat.triangles.rows(); ++i, ++t)
      for (int k = 0; k < 3; ++k) {
        const int corner = flat.triangles(i, turned[p] ? 2 - k : k);
        cloth.triangles(t, k) = joints.of(p, corner);
        cloth.uv.block<1, 2>(t, 2 * k) = flat.vertices.row(corner).head<2>() + shift;
      }
    const double grain = panel.grain * std::numbers::pi / 180;
    cloth.warp.middleRows(t - flat.triangles.rows(), flat.triangles.rows()).rowwise() =
        Eigen::RowVector3d(-std::sin(grain), std::cos(grain), 0);
    cloth.piece.insert(cloth.piece.end(), flat.triangles.rows(), static_cast<int>(p));
    cloth.piece_names.push_back(panel.name);
    for (const auto& [side, edge] : panels[p].sides)
      if (const auto& label = panel.edges[edge].label; label && labels)
        for (const int v : {side.first, side.second}) (*labels)[*label].push_back(joints.of(p, v));
  }
  if (std::ranges::all_of(pattern.panels, [](const Panel& p) { return p.grain == 0; }))
    cloth.warp.resize(0, 3);
  cloth.vertices.array().colwise() /= places.array();
  FileCoordinates{"m", pattern.up}.convert(cloth.vertices);
  cloth.sewing = Sewing{};
  check_joints(pattern, cloth, edge_length, errors);
  if (errors.size() > before) return std::nullopt;
  return cloth;
}

}  // namespace drape

#include <algorithm>

#include "core/app/scene/boundary_conditions.h"
#include "core/numerics/mesh/seams.h"

namespace drape {

namespace {

/// The vertices of a piece, or the ends of its border edges or seams, or of all seams.
std::vector<int> vertices_of_piece(const VertexSelection& selection, const Level& level) {
  const TriangleMesh& rest = level.rest;
  const auto has = [&](int t) {
    return !selection.piece || (!rest.piece.empty() && rest.piece_names[rest.piece[t]] == *selection.piece);
  };
  std::vector<char> chosen(level.vertex_count(), 0);
  for (int t = 0; t < level.triangle_count(); ++t)
    for (int k = 0; k < 3 && has(t); ++k) {
      const int e = level.topology.triangle_edges(t, k);
      const bool whole = selection.region == "piece", edge = selection.region == "seam"
                                                                 ? is_seam(rest, level.topology, e)
                                                                 : level.topology.edge_triangles(e, 1) == -1;
      if (whole || edge)
        for (const int corner : {(k + 1) % 3, (k + 2) % 3}) chosen[rest.triangles(t, corner)] = 1;
    }
  std::vector<int> vertices;
  for (int v = 0; v < level.vertex_count(); ++v)
    if (chosen[v]) vertices.push_back(v);
  return vertices;
}

/// The vertices on the edges of a label: those of finer levels lie on the coarsest level's edges, in the
/// placement. On levels below the cloth's mesh, those that stand for its vertices on these edges.
std::vector<int> vertices_of_label(const VertexSelection& selection, const Level& level,
                                   const Level& coarsest) {
  if (!coarsest.own_vertices.empty()) {
    std::vector<int> vertices;
    for (const int v : selection.label_edges) vertices.push_back(level.own_vertex(v));
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }
  constexpr double rounding = 1e-9;  // of an edge
  std::vector<char> at_edge(level.topology.on_border.begin(), level.topology.on_border.end());
  for (int e = 0; e < level.topology.edges.rows(); ++e)
    if (is_seam(level.rest, level.topology, e))
      for (const int v : level.topology.edges.row(e)) at_edge[v] = 1;
  std::vector<int> vertices;
  for (int v = 0; v < level.vertex_count(); ++v)
    for (std::size_t i = 0; at_edge[v] && i + 1 < selection.label_edges.size(); i += 2) {
      const auto end = [&](std::size_t k) -> Eigen::RowVector3d {
        return coarsest.rest.vertices.row(selection.label_edges[k]);
      };
      const Eigen::RowVector3d a = end(i), along = end(i + 1) - a, p = level.rest.vertices.row(v);
      const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
      if ((p - a - t * along).squaredNorm() > rounding * rounding * along.squaredNorm()) continue;
      vertices.push_back(v);
      break;
    }
  return vertices;
}

}  // namespace

std::vector<int> selected_vertices(const VertexSelection& selection, const Level& level,
                                   const Level& coarsest) {
  std::vector<int> selected;
  if (selection.region == "nearest") {
    Eigen::Index nearest = 0;
    (coarsest.rest.vertices.rowwise() - selection.point.transpose())
        .rowwise()
        .squaredNorm()
        .minCoeff(&nearest);
    return {level.own_vertex(coarsest.cloth_vertex(static_cast<int>(nearest)))};
  }
  if (selection.region == "vertices") {
    // Children of the cloth's vertices keep their index on every level.
    for (int v : selection.vertices)
      if (v >= 0 && v < coarsest.cloth_vertex_count()) selected.push_back(level.own_vertex(v));
    std::ranges::sort(selected);
    selected.erase(std::unique(selected.begin(), selected.end()), selected.end());
    return selected;
  }
  if (selection.region == "label") return vertices_of_label(selection, level, coarsest);
  if (selection.region == "piece" || selection.region == "seam" || selection.piece)
    return vertices_of_piece(selection, level);
  constexpr double rounding = 1e-12;  // round-off must not exclude vertices on a region's boundary
  for (int i = 0; i < level.vertex_count(); ++i) {
    const Eigen::Vector3d p = level.rest.vertices.row(i);
    const bool in_ball = (p - selection.point).norm() <= selection.radius * (1 + rounding);
    const bool in_box = (p.array() >= selection.lower.array() - rounding).all() &&
                        (p.array() <= selection.upper.array() + rounding).all();
    if (selection.region == "border" ? level.topology.on_border[i]
        : selection.region == "ball" ? in_ball
                                     : in_box)
      selected.push_back(i);
  }
  return selected;
}

}  // namespace drape

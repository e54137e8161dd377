#include "core/app/scene/vertex_search.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "core/numerics/collision_detection/closest.h"
#include "core/numerics/mesh/seams.h"

namespace drape {

namespace {

/// The vertices of a piece's triangles, or the ends of their border edges or seams.
std::vector<int> vertices_of_piece(const VertexSelection& selection, const Level& level,
                                   const std::vector<int>& triangles) {
  const TriangleMesh& rest = level.rest;
  std::set<int> chosen;
  for (const int t : triangles)
    for (int k = 0; k < 3; ++k) {
      const int e = level.topology.triangle_edges(t, k);
      const bool whole = selection.region == "piece", edge = selection.region == "seam"
                                                                 ? is_seam(rest, level.topology, e)
                                                                 : level.topology.edge_triangles(e, 1) == -1;
      if (whole || edge)
        for (const int corner : {(k + 1) % 3, (k + 2) % 3}) chosen.insert(rest.triangles(t, corner));
    }
  return {chosen.begin(), chosen.end()};
}

/// The level's vertices that stand for some of the cloth's, of those that are there.
std::vector<int> own_vertices(const std::vector<int>& vertices, const Level& level, const Level& coarsest) {
  std::set<int> own;
  for (const int v : vertices)
    if (v >= 0 && v < coarsest.cloth_vertex_count()) own.insert(level.own_vertex(v));
  return {own.begin(), own.end()};
}

/// The vertices on the edges of a label: those of finer levels lie on the coarsest level's edges, in the
/// placement. On levels below the cloth's mesh, those that stand for its vertices on these edges.
std::vector<int> vertices_of_label(const VertexSelection& selection, const Level& level,
                                   const Level& coarsest) {
  if (!coarsest.own_vertices.empty()) return own_vertices(selection.label_edges, level, coarsest);
  constexpr double rounding = 1e-9;  // of an edge
  std::vector<char> at_edge(level.topology.on_border.begin(), level.topology.on_border.end());
  for (int e = 0; e < level.topology.edges.rows(); ++e)
    if (is_seam(level.rest, level.topology, e))
      for (const int v : level.topology.edges.row(e)) at_edge[v] = 1;
  const auto end = [&](std::size_t k) -> Eigen::Vector3d {
    return coarsest.rest.vertices.row(selection.label_edges[k]);
  };
  std::vector<Box> boxes;
  for (std::size_t i = 0; i + 1 < selection.label_edges.size(); i += 2)
    boxes.push_back(Box::around(end(i), end(i + 1), rounding * (end(i + 1) - end(i)).norm()));
  BoxTree edges;
  edges.build(boxes);
  std::vector<int> vertices;
  for (int v = 0; v < level.vertex_count(); ++v) {
    const Eigen::Vector3d p = level.rest.vertices.row(v);
    const auto distance = [own = Box::around(p, p, 0)](const Box& box) { return box.squared_distance(own); };
    bool found = false;
    if (at_edge[v])
      edges.visit_near(0, distance, [&](int i) {
        const Eigen::Vector3d a = end(2 * i), along = end(2 * i + 1) - a;
        const Eigen::Vector3d away = p - a - nearest_on_segment(along, p - a) * along;
        found = found || away.squaredNorm() <= rounding * rounding * along.squaredNorm();
        return found ? -1.0 : 0.0;
      });
    if (found) vertices.push_back(v);
  }
  return vertices;
}

}  // namespace

VertexSearch::VertexSearch(const Level& level, const Level& coarsest, std::size_t count)
    : level_(level),
      coarsest_(coarsest),
      tree_(level.rest.vertices, count),
      coarse_tree_(coarsest.rest.vertices, &level == &coarsest ? 0 : count) {
  for (int v = 0; v < level.vertex_count(); ++v)
    if (level.topology.on_border[v]) border_.push_back(v);
  for (int t = 0; t < std::ssize(level.rest.piece); ++t)
    triangles_[level.rest.piece_names[level.rest.piece[t]]].push_back(t);
}

std::vector<int> VertexSearch::candidates(const VertexSelection& selection) const {
  constexpr double margin = 1 + 1e-6;  // over round-off
  const bool in_ball = selection.region == "ball";
  std::vector<int> found;
  if (selection.region == "border") return border_;
  if (tree_.boxes.size() == 0) {
    found.resize(level_.vertex_count());
    std::iota(found.begin(), found.end(), 0);
    return found;
  }
  const Box region = in_ball ? Box::around(selection.point, selection.point, 0)
                             : Box::around(selection.lower.cwiseMin(selection.upper), selection.upper, 1e-9);
  const double reach = in_ball ? margin * selection.radius * margin * selection.radius : 0;
  tree_.boxes.visit_near(
      reach, [&](const Box& box) { return box.squared_distance(region); },
      [&](int v) {
        found.push_back(v);
        return reach;
      });
  std::ranges::sort(found);
  return found;
}

std::vector<int> VertexSearch::selected_by_name(const VertexSelection& selection) const {
  if (selection.region == "label") return vertices_of_label(selection, level_, coarsest_);
  std::vector<int> all(level_.triangle_count());
  std::iota(all.begin(), all.end(), 0);
  if (!selection.piece) return vertices_of_piece(selection, level_, all);
  const auto piece = triangles_.find(*selection.piece);
  return piece == triangles_.end() ? std::vector<int>() : vertices_of_piece(selection, level_, piece->second);
}

std::vector<int> VertexSearch::selected(const VertexSelection& selection) const {
  if (selection.region == "vertices") return own_vertices(selection.vertices, level_, coarsest_);
  if (selection.region == "label" || selection.region == "piece" || selection.region == "seam" ||
      (selection.piece && selection.region == "border")) {
    const auto [known, is_new] =
        named_.try_emplace({selection.region, selection.piece.value_or(""), selection.label.value_or("")});
    if (is_new) known->second = selected_by_name(selection);
    return known->second;
  }
  if (selection.region == "nearest") {
    const int nearest = (&level_ == &coarsest_ ? tree_ : coarse_tree_).nearest(selection.point);
    return {level_.own_vertex(coarsest_.cloth_vertex(nearest))};
  }
  std::vector<int> among = candidates(selection);
  constexpr double rounding = 1e-12;  // round-off must not exclude vertices on a region's boundary
  std::erase_if(among, [&](int v) {
    const Eigen::Vector3d p = level_.rest.vertices.row(v);
    if (selection.region == "ball")
      return !((p - selection.point).norm() <= selection.radius * (1 + rounding));
    return selection.region != "border" && !((p.array() >= selection.lower.array() - rounding).all() &&
                                             (p.array() <= selection.upper.array() + rounding).all());
  });
  return among;
}

}  // namespace drape

#include "core/app/experiment/garment_place.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "core/app/experiment/pattern_file.h"
#include "core/kernel/files/string_utils.h"

namespace drape {

namespace {

constexpr int steps_of_edge = 16;

/// The points of an edge, one a column [m].
Eigen::Matrix2Xd points_of(const PanelEdge& edge) {
  Eigen::Matrix2Xd points(2, steps_of_edge + 1);
  for (int k = 0; k <= steps_of_edge; ++k) points.col(k) = edge.curve.at(double(k) / steps_of_edge);
  return points;
}

/// The way from texture coordinates of a panel's triangles to where the pattern's file draws them [m].
Eigen::Vector2d way_to_drawn(const Panel& panel, const TriangleMesh& cloth, int piece) {
  Eigen::AlignedBox2d drawn, flat;
  for (const PanelEdge& edge : panel.edges) {
    const Eigen::Matrix2Xd points = points_of(edge);
    for (const auto& point : points.colwise()) drawn.extend(point);
  }
  for (Eigen::Index t = 0; t < cloth.triangles.rows(); ++t) {
    if (cloth.piece[t] != piece) continue;
    const Eigen::Matrix3d corners = rest_corners(cloth, t);
    for (int k = 0; k < 3; ++k) flat.extend(corners.col(k).head<2>());
  }
  return drawn.min() - flat.min();
}

const Seam* nearest_seam(const Pattern& pattern, int panel, const Eigen::Vector2d& point) {
  const Seam* nearest = nullptr;
  double least = std::numeric_limits<double>::infinity();
  for (const Seam& seam : pattern.seams)
    for (const auto& side : seam.sides)
      for (const EdgeIndex& edge : side) {
        if (edge.panel != panel) continue;
        const double distance = (points_of(pattern.edge(edge)).colwise() - point).colwise().norm().minCoeff();
        if (distance < least) least = distance, nearest = &seam;
      }
  return nearest;
}

/// The edge of a panel that no seam joins and that is nearest to a point; -1 without one.
int nearest_open_edge(const Pattern& pattern, int panel, const Eigen::Vector2d& point) {
  std::vector<char> sewn(pattern.panels[panel].edges.size(), 0);
  for (const Seam& seam : pattern.seams)
    for (const auto& side : seam.sides)
      for (const EdgeIndex& edge : side)
        if (edge.panel == panel) sewn[edge.edge] = 1;
  int nearest = -1;
  double least = std::numeric_limits<double>::infinity();
  for (int e = 0; e < std::ssize(sewn); ++e) {
    if (sewn[e]) continue;
    const Eigen::Matrix2Xd points = points_of(pattern.panels[panel].edges[e]);
    for (int k = 0; k < steps_of_edge; ++k) {  // of chords, since two edges share the points of a corner
      const Eigen::Vector2d chord = points.col(k + 1) - points.col(k), to = point - points.col(k);
      const double at = std::clamp(to.dot(chord) / chord.squaredNorm(), 0.0, 1.0);
      if (const double distance = (to - at * chord).norm(); distance < least) least = distance, nearest = e;
    }
  }
  return nearest;
}

/// The pattern that a cloth was made of; none of another cloth, and of a file that has changed since.
std::optional<Pattern> pattern_of(const ClothParameters& parameters, const TriangleMesh& cloth) {
  if (parameters.shape != "pattern") return std::nullopt;
  ConfigErrors faults;
  std::optional<Pattern> pattern = read_pattern(parameters.file, faults);
  if (!pattern || !std::ranges::equal(pattern->panels, cloth.piece_names, {}, &Panel::name))
    return std::nullopt;
  return pattern;
}

}  // namespace

GarmentPlace place_in_garment(const ClothParameters& parameters, const Level& coarsest, int triangle) {
  const TriangleMesh& cloth = coarsest.rest;
  const int piece = cloth.piece.at(triangle);
  const std::string& name = cloth.piece_names.at(piece);
  const std::optional<Pattern> pattern = pattern_of(parameters, cloth);
  if (!pattern) return {"piece " + name, std::nullopt};
  const Panel& panel = pattern->panels[piece];
  GarmentPlace place{"panel " + name, panel.where};
  const Eigen::Vector2d middle = rest_corners(cloth, triangle).rowwise().mean().head<2>();
  if (const Seam* seam = nearest_seam(*pattern, piece, middle + way_to_drawn(panel, cloth, piece)))
    place.text += ", by its seam " + seam->name + " (" + seam->where.text() + ")";
  return place;
}

std::string place_in_garment(const Level& level, int vertex) {
  const TriangleMesh& cloth = level.rest;
  if (cloth.piece_names.empty()) return "";
  std::vector<std::string> pieces;
  for (const int t : level.topology.vertex_triangles.row(vertex))
    add_new(pieces, cloth.piece_names[cloth.piece[t]]);
  return pieces.size() == 1 ? "piece " + pieces[0] : "the seam of " + joined(pieces, ", ", " and ");
}

std::vector<std::vector<PieceEdge>> edges_along(const ClothParameters& parameters, const Level& level,
                                                const std::vector<std::vector<int>>& borders) {
  const TriangleMesh& cloth = level.rest;
  std::vector<std::vector<PieceEdge>> edges(borders.size());
  if (cloth.piece_names.empty()) return edges;
  const std::optional<Pattern> pattern = pattern_of(parameters, cloth);
  std::map<int, Eigen::Vector2d> ways;  // of each piece
  const auto edge_at = [&](int half_edge) {
    const int t = half_edge / 3, piece = cloth.piece[t];
    if (!pattern) return -1;
    if (!ways.contains(piece)) ways[piece] = way_to_drawn(pattern->panels[piece], cloth, piece);
    const Eigen::Matrix3d corners = rest_corners(cloth, t);
    const Eigen::Vector3d middle = (corners.col((half_edge + 1) % 3) + corners.col((half_edge + 2) % 3)) / 2;
    return nearest_open_edge(*pattern, piece, middle.head<2>() + ways[piece]);
  };
  for (std::size_t b = 0; b < borders.size(); ++b) {
    std::set<std::pair<int, int>> along;  // pieces, and edges of their panels
    for (const int h : borders[b]) along.emplace(cloth.piece[h / 3], edge_at(h));
    for (const auto& [piece, edge] : along)
      edges[b].push_back({cloth.piece_names[piece], edge < 0 ? "" : pattern->panels[piece].edges[edge].name});
  }
  return edges;
}

}  // namespace drape

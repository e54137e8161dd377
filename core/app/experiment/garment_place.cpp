#include "core/app/experiment/garment_place.h"

#include <Eigen/Geometry>
#include <limits>

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

/// The middle of a triangle in its panel as the pattern's file draws it, whose texture coordinates are
/// shifted.
Eigen::Vector2d drawn_middle(const Panel& panel, const TriangleMesh& cloth, int triangle) {
  Eigen::AlignedBox2d drawn, flat;
  for (const PanelEdge& edge : panel.edges) {
    const Eigen::Matrix2Xd points = points_of(edge);
    for (const auto& point : points.colwise()) drawn.extend(point);
  }
  for (Eigen::Index t = 0; t < cloth.triangles.rows(); ++t) {
    if (cloth.piece[t] != cloth.piece[triangle]) continue;
    const Eigen::Matrix3d corners = rest_corners(cloth, t);
    for (int k = 0; k < 3; ++k) flat.extend(corners.col(k).head<2>());
  }
  return rest_corners(cloth, triangle).rowwise().mean().head<2>() - flat.min() + drawn.min();
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

}  // namespace

GarmentPlace place_in_garment(const ClothParameters& parameters, const Level& coarsest, int triangle) {
  const TriangleMesh& cloth = coarsest.rest;
  const int piece = cloth.piece.at(triangle);
  const std::string& name = cloth.piece_names.at(piece);
  GarmentPlace place{"piece " + name, std::nullopt};
  if (parameters.shape != "pattern") return place;
  ConfigErrors faults;
  const std::optional<Pattern> pattern = read_pattern(parameters.file, faults);
  // The file may have changed since.
  if (!pattern || piece >= std::ssize(pattern->panels) || pattern->panels[piece].name != name) return place;
  const Panel& panel = pattern->panels[piece];
  place = {"panel " + name, panel.where};
  if (const Seam* seam = nearest_seam(*pattern, piece, drawn_middle(panel, cloth, triangle)))
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

}  // namespace drape

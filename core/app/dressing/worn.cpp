#include "core/app/dressing/worn.h"

#include <algorithm>
#include <numbers>

#include "core/app/scene/scene_summary.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/collision_detection/surface_search.h"

namespace drape {

namespace {

constexpr std::size_t most_named = 4;  // pieces of an opening, and openings, in a message

/// An opening of a garment, and what its border is called.
struct NamedOpening : Opening {
  std::vector<PieceEdge> edges;  ///< along its border

  /// The names of its pieces, each once.
  std::vector<std::string> pieces() const;
  /// "sleeve_left, by its edge cuff", "front, by its edge hem, and back, by its edge hem", "front and back at
  /// (0, 0.1, 1.2)".
  std::string text() const;
};

/// "a, b and c", or the first few and how many more there are.
std::string few(const std::vector<std::string>& words, const char* last) {
  return words.size() > most_named ? joined(first_of(words, most_named)) : joined(words, ", ", last);
}

/// "by its edge cuff", "by its edges 2 and 3".
std::string text_of_edges(const std::vector<std::string>& names) {
  return std::string("by its edge") + (names.size() > 1 ? "s " : " ") + few(names, " and ");
}

std::vector<std::string> NamedOpening::pieces() const {
  std::vector<std::string> names;
  for (const PieceEdge& edge : edges) add_new(names, edge.piece);
  return names;
}

std::string NamedOpening::text() const {
  const bool has_edges = std::ranges::none_of(edges, [](const PieceEdge& edge) { return edge.edge.empty(); });
  if (edges.empty() || !has_edges)
    return few(pieces(), " and ") + " at " + point_text((1000 * middle.array()).round() / 1000 + 0.0);
  std::vector<std::string> parts;
  for (const std::string& piece : pieces()) {
    std::vector<std::string> own;
    for (const PieceEdge& edge : edges)
      if (edge.piece == piece) own.push_back(edge.edge);
    parts.push_back(piece + ", " + text_of_edges(own));
  }
  return few(parts, ", and ");
}

std::vector<NamedOpening> named(const ClothParameters& cloth, const Level& level,
                                std::vector<Opening> openings) {
  std::vector<std::vector<int>> borders;
  for (const Opening& opening : openings) borders.push_back(opening.half_edges);
  std::vector<std::vector<PieceEdge>> edges = edges_along(cloth, level, borders);
  std::vector<NamedOpening> all;
  for (std::size_t k = 0; k < openings.size(); ++k)
    all.push_back({std::move(openings[k]), std::move(edges[k])});
  return all;
}

/// Says which of these openings at x are not passed.
std::string missed_text(const ClothParameters& cloth, const Level& level, const Positions& x,
                        const TriangleMesh& body, std::vector<Opening> openings) {
  const auto longest_side = [](const Positions& points) { return bounding_box(points).sizes().maxCoeff(); };
  const bool hangs = longest_side(body.vertices) < longest_side(x);
  if (std::erase_if(openings, &Opening::passed) > 0 && hangs) return "";
  std::string text;
  const std::size_t more = openings.size() - std::min(openings.size(), most_named);
  openings.resize(openings.size() - more);
  for (const NamedOpening& opening : named(cloth, level, std::move(openings)))
    text += (text.empty() ? "no part of the body passes through the opening of " : "; nor through that of ") +
            opening.text();
  return text + (more > 0 ? "; nor through " + std::to_string(more) + " more" : "");
}

}  // namespace

TriangleMesh dressed_body(const Experiment& e, const LevelModel& model) {
  const std::vector<std::string> names = e.obstacle_names();
  const auto index = std::ranges::find(names, e.parameters.dress.obstacle) - names.begin();
  return model.obstacles().at(index);
}

std::vector<GarmentOpening> garment_openings(const Level& level, const Positions& x,
                                             const TriangleMesh& body) {
  std::vector<GarmentOpening> all;
  for (const Opening& opening : openings_of(level, x, body)) {
    GarmentOpening& own = all.emplace_back();
    for (const int h : opening.half_edges)
      add_new(own.pieces, level.rest.piece_names.at(level.rest.piece[h / 3]));
    own.length = opening.length;
    own.middle = opening.middle;
    own.passed = opening.passed;
  }
  return all;
}

std::string not_worn_text(const ClothParameters& cloth, const Level& level, const Positions& x,
                          const TriangleMesh& body) {
  return missed_text(cloth, level, x, body, openings_of(level, x, body));
}

std::string not_placed_text(const ClothParameters& cloth, const Level& level, const Positions& x,
                            const TriangleMesh& contracted, const TriangleMesh& full) {
  std::vector<Opening> openings = openings_of(level, x, contracted);
  if (std::ranges::all_of(openings, &Opening::passed)) return "";
  const std::vector<Opening> around_full = openings_of(level, x, full);
  const SurfaceSearch search(full);
  for (std::size_t k = 0; k < openings.size(); ++k) {
    const double radius = openings[k].length / (2 * std::numbers::pi);
    if (around_full[k].passed || search.nearest(openings[k].middle, radius).triangle >= 0)
      openings[k].passed = true;
  }
  return missed_text(cloth, level, x, full, std::move(openings));
}

}  // namespace drape

#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/app/experiment/experiment_parameters.h"
#include "core/kernel/interfaces/level.h"

namespace drape {

/// Where in a garment something is, for messages.
struct GarmentPlace {
  std::string text;               ///< as "panel front, by its seam side (shirt.json:40:7)", or "piece front"
  std::optional<Location> where;  ///< of the panel in the pattern's file
};

/// The place of a triangle of the coarsest level. A cloth that was read from a sewing pattern has panels,
/// with the seam that is nearest to the triangle.
GarmentPlace place_in_garment(const ClothParameters& cloth, const Level& coarsest, int triangle);

/// The place of a vertex in a cloth of flat pieces, "piece front" or "the seam of front and sleeve_left"; ""
/// in another cloth.
std::string place_in_garment(const Level& level, int vertex);

/// An edge of a piece as its pattern's file draws it.
struct PieceEdge {
  std::string piece;
  std::string edge;  ///< its name, or its number from 0; "" of a cloth that was not read from a pattern
};

/// The edges that each of these borders of a cloth of flat pieces runs along, each once, in the pattern's
/// order. A border is given by its half-edges.
std::vector<std::vector<PieceEdge>> edges_along(const ClothParameters& cloth, const Level& level,
                                                const std::vector<std::vector<int>>& borders);

}  // namespace drape

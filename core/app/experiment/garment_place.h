#pragma once

#include <optional>
#include <string>

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

}  // namespace drape

#pragma once

#include <optional>

#include "core/app/scene/scene.h"

namespace drape {

/// The start of a garment around a contracted body.
struct DressingStart {
  double contraction = 0;           ///< of the body, of its area [1]
  double smoothing = 0;             ///< of the placed garment [1]
  double inflation = 0;             ///< of the smoothed garment, along its normals [m]
  double rise = 0;                  ///< of the smoothed garment, against the loads [m]
  bool is_untangled = false;        ///< then, where it crossed itself or the body
  std::vector<Positions> garments;  ///< of every level, n×3 [m]
  Positions placed = {};            ///< the pieces of the coarsest level as they were placed, n×3 [m]
  double enclosure = 0;             ///< the largest winding number around a point of the contracted body
  std::string not_placed = {};      ///< not_placed_text
};

/// Finds a start without intersections of a garment around its body: the placed garment smoothed, the body
/// contracted, each by little if that will do, and what still crosses untangled. The scene's models are made.
/// None, with an error appended that names the piece which every start leaves in the body, or in another
/// piece, or tells of a body that is elsewhere.
std::optional<DressingStart> find_dressing_start(const Experiment& experiment, const Scene& scene,
                                                 ConfigErrors& errors);

}  // namespace drape

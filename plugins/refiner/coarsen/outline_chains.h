#pragma once

#include <numbers>
#include <vector>

#include "plugins/refiner/coarsen/flat_cloth.h"

namespace drape {

/// Outlines that turn by more than this have a corner there [rad].
constexpr double corner_angle = 40 * std::numbers::pi / 180;

/// Edges of borders and seams from one corner to the next, or of a loop without corners, which ends at its
/// first vertex.
struct OutlineChain {
  std::vector<int> vertices, edges;
};

/// All chains; corners are where outlines turn by more than 40° in a piece, meet or end.
std::vector<OutlineChain> outline_chains(const Level& level, const FlatCloth& flat);

/// The vertices of a chain that stay in a mesh with 1/ratio of the vertices: its ends and others at even
/// distances by the density of the mesh; at least three edges of a loop.
std::vector<int> kept_of(const OutlineChain& chain, const Level& level, const FlatCloth& flat, double ratio);

}  // namespace drape

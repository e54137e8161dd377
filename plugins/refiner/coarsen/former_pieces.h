#pragma once

#include <optional>

#include "plugins/refiner/coarsen/coarse_pieces.h"

namespace drape {

/// The triangles that a mesh splits into four each, if it splits any mesh so: that of a grid with even
/// numbers of cells, or what a CAD tool or a refinement has split before. Nothing if it does not, or if its
/// new vertices are not about halfway between their neighbours.
std::optional<CoarsePieces> former_pieces(const Level& fine, const FlatCloth& flat);

}  // namespace drape

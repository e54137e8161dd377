#pragma once

#include <vector>

#include "plugins/refiner/coarsen/flat_cloth.h"

namespace drape {

/// Flags of the vertices that a coarser mesh with 1/ratio of the vertices keeps: corners and junctions of
/// outlines, between them vertices at even distances along the outlines, and inner ones that are well spread.
/// Distances follow the density of the mesh.
std::vector<char> chosen_vertices(const Level& level, const FlatCloth& flat, double ratio);

}  // namespace drape

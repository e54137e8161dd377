#pragma once

#include <array>
#include <vector>

#include "plugins/refiner/coarsen/flat_cloth.h"

namespace drape {

/// The triangulation of each flat piece by the vertices that a coarser mesh keeps.
struct CoarsePieces {
  std::vector<char> kept;  ///< n flags of the fine mesh's vertices
  Triangles triangles;     ///< m_c×3 images, counter-clockwise, piece by piece
  std::vector<int> first;  ///< the first triangle of each piece, and their number

  /// Constrained Delaunay triangulations within the outlines whose sides join kept vertices. Where outlines
  /// would cross each other, or triangles of two places share an edge, vertices between are kept too. Throws
  /// std::runtime_error where there are none.
  static CoarsePieces of(const FlatCloth& flat, std::vector<char> kept);
};

}  // namespace drape

#pragma once

#include "core/kernel/interfaces/level.h"

namespace drape {

/// A level of flat pieces whose triangles rest between two shapes: the metric of each (the Gram matrix of its
/// edges) is `weight` times the one that it has at `placed` (n×3) [m] and 1 - weight times that of its piece.
/// A mean of positive definite metrics is one, so no triangle turns over on the way, however far it is
/// stretched at `placed`. A triangle rests as its piece does but for a symmetric stretch, and so keeps its
/// warp. Areas at vertices, and so masses, stay those of the pieces.
Level with_intermediate_rest(const Level& flat, const Positions& placed, double weight);

/// How tight a piece of cloth is.
struct Tightness {
  int piece = 0;       ///< of the cloth's piece_names
  double stretch = 0;  ///< largest principal stretch less one that a tenth of the piece's area exceeds [1]
  int triangle = 0;    ///< of the piece, the most stretched one
};

/// The tightest piece of a cloth of flat pieces at x (n×3) [m]. A tenth of its area, since single triangles
/// are stretched at corners of a garment that fits, and the girth that is too narrow may be a part of a
/// piece.
Tightness tightest_piece(const Level& level, const Positions& x);

}  // namespace drape

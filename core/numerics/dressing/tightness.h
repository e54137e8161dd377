#pragma once

#include "core/kernel/interfaces/level.h"

namespace drape {

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

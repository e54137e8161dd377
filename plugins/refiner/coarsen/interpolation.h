#pragma once

#include "core/kernel/interfaces/prolongation_matrix.h"
#include "plugins/refiner/coarsen/coarse_pieces.h"

namespace drape {

/// The weights of the kept vertices for each fine one: those of its flat place in the coarse triangle that
/// holds it, or beyond an outline's chord in the nearest one; of a vertex on a seam the mean of its images.
/// Linear functions of a piece's plane are reproduced. `coarse` numbers the kept vertices.
ProlongationMatrix flat_interpolation(const FlatCloth& flat, const CoarsePieces& pieces,
                                      const std::vector<int>& coarse, int coarse_count);

}  // namespace drape

#pragma once

#include <Eigen/SparseCore>

#include "core/hierarchy/level.h"

namespace drape {

/// n_f × n_c weights of a subdivision, applied to each coordinate; rows sum to 1.
using ProlongationMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// A finer mesh and how its vertices follow from the coarse ones. The first n_c fine vertices are the
/// children of the coarse vertices, in order; then one vertex an edge, in the order of Topology::edges.
struct Refinement {
  Triangles triangles;         ///< of the finer mesh; triangle t gives 4t … 4t + 3
  ProlongationMatrix weights;  ///< P_{l→l+1}
};

/// A 1→4 subdivision. Pure geometry: depends on the level's rest shape and connectivity alone.
class Refiner {
 public:
  virtual ~Refiner() = default;
  virtual Refinement refine(const Level& coarse) const = 0;
};

}  // namespace drape

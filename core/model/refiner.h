#pragma once

#include <Eigen/SparseCore>

#include "core/hierarchy/level.h"

namespace drape {

/// n_f × n_c prolongation weights, applied to each coordinate; rows sum to 1.
using ProlongationMatrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;

/// A finer mesh and its prolongation. The first n_c fine vertices are the children of the coarse vertices, in
/// order; then one vertex for each edge follows, in the order of Topology::edges.
struct Refinement {
  Triangles triangles;         ///< of the finer mesh; triangle t becomes 4t … 4t + 3
  ProlongationMatrix weights;  ///< P_{l→l+1}
};

/// A 1→4 subdivision. It depends only on the level's rest shape and connectivity.
class Refiner {
 public:
  virtual ~Refiner() = default;
  virtual Refinement refine(const Level& coarse) const = 0;
};

}  // namespace drape

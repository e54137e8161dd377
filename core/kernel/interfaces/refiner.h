#pragma once

#include "core/kernel/interfaces/level.h"
#include "core/kernel/interfaces/prolongation_matrix.h"

namespace drape {

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

/// Which prolongation maps a coarse level's vertices to a finer level.
enum class Interpolation {
  midpoint,  ///< linear in the rest shape; on regular refinements new vertices are edge midpoints
  refiner    ///< the weights of the hierarchy's refiner
};

}  // namespace drape

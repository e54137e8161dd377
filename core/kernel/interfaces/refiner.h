#pragma once

#include "core/kernel/interfaces/level.h"
#include "core/kernel/interfaces/prolongation_matrix.h"

namespace drape {

/// Says where the vertices of a 1→4 subdivision lie, by the level's rest shape and connectivity alone.
class Refiner {
 public:
  static constexpr const char* kind = "refiner";  ///< in the registry
  virtual ~Refiner() = default;
  /// P_{l→l+1}: a row for each vertex of the level, then one for each edge in the order of Topology::edges;
  /// a column for each vertex. Rows sum to 1.
  virtual ProlongationMatrix weights(const Level& coarse) const = 0;
};

/// Which prolongation maps a coarse level's vertices to a finer level.
enum class Interpolation {
  midpoint,  ///< linear in the rest shape; on regular refinements new vertices are edge midpoints
  refiner    ///< the weights of the hierarchy's refiner
};

}  // namespace drape

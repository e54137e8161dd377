#pragma once

#include <optional>

#include "core/kernel/interfaces/level.h"
#include "core/kernel/interfaces/prolongation_matrix.h"

namespace drape {

/// A mesh below another one, and the operator between them.
struct CoarserMesh {
  TriangleMesh rest;
  std::vector<int> vertices;   ///< the finer mesh's vertex that each of its own is, ascending
  ProlongationMatrix weights;  ///< n_f × n_c, linear over the coarse rest shape; rows sum to 1
};

/// Makes a hierarchy of one mesh: finer levels by 1→4 subdivision, and, if it can, coarser ones.
class Refiner {
 public:
  static constexpr const char* kind = "refiner";  ///< in the registry
  virtual ~Refiner() = default;
  /// P_{l→l+1}, by the level's rest shape and connectivity alone: a row for each vertex of the level, then
  /// one for each edge in the order of Topology::edges; a column for each vertex. Rows sum to 1.
  virtual ProlongationMatrix weights(const Level& coarse) const = 0;
  /// A mesh of about a quarter of the level's vertices; nothing from a refiner that makes no coarser levels.
  virtual std::optional<CoarserMesh> coarser(const Level& /*fine*/) const { return std::nullopt; }
};

/// Which prolongation maps a coarse level's vertices to a finer level.
enum class Interpolation {
  midpoint,  ///< linear in the rest shape; on regular refinements new vertices are edge midpoints
  refiner    ///< the weights of the hierarchy's refiner
};

}  // namespace drape

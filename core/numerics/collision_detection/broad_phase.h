#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "core/kernel/interfaces/topology.h"
#include "core/numerics/collision_detection/box.h"
#include "core/numerics/linear_algebra/block_matrix.h"

namespace drape {

/// Algorithms that find overlapping boxes. Both find the same pairs: `fcl` is the check of `bvh`.
enum class BroadPhaseKind {
  bvh,  ///< own eight-wide BVH, built once and refitted
  fcl   ///< FCL's BVHModel, refitted too
};

/// Finds the overlapping pairs of closed boxes, except for boxes of primitives that share a vertex.
class BroadPhase {
 public:
  virtual ~BroadPhase() = default;

  /// Copies the boxes, none of which may be empty. Cheapest if their number is that of the last call and
  /// their neighbours are the same.
  virtual void update(const std::vector<Box>& boxes) = 0;

  /// Sets row i of `pairs` to the other's boxes that overlap box i, ascending; of itself, to the boxes j > i.
  /// Returns false, without rows, if there are more than `limit` pairs. Throws std::runtime_error if `other`
  /// is of another kind.
  virtual bool overlaps(const BroadPhase& other, long limit, AdjacencyList& pairs) const = 0;

  /// A broad phase of the same primitives, to be updated with boxes of other places. A tree is copied too.
  virtual std::unique_ptr<BroadPhase> copy() const = 0;
};

/// An empty broad phase of this kind. Row i of `vertices`, if it has any, names the vertices of the primitive
/// in box i, at most three; the number of boxes is then that of the rows.
std::unique_ptr<BroadPhase> make_broad_phase(BroadPhaseKind kind, const Stencils& vertices = {});

/// The broad phases of a surface in ever new poses. Each copies the last one, since refitting a tree takes a
/// fraction of the time of building one. Threads may ask at the same time.
class PoseTrees {
 public:
  explicit PoseTrees(BroadPhaseKind kind) : last_(make_broad_phase(kind)) {}

  /// The broad phase of a pose with these boxes, whose pairs do not depend on earlier poses.
  std::shared_ptr<const BroadPhase> of(const std::vector<Box>& boxes);

 private:
  std::mutex busy_;  // guards last_
  std::shared_ptr<const BroadPhase> last_;
};

}  // namespace drape

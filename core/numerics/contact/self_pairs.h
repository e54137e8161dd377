#pragma once

#include <memory>
#include <vector>

#include "core/numerics/collision_detection/broad_phase.h"
#include "core/numerics/contact/candidates.h"

namespace drape {

/// Searches for vertex-triangle and edge-edge pairs of the cloth that share no vertex. Keeps the trees of its
/// primitives between searches; results do not depend on earlier ones.
class SelfPairSearch {
 public:
  /// `cloth` must outlive the search.
  SelfPairSearch(const Surface& cloth, BroadPhaseKind kind);

  /// Appends the pairs that may come within d̂ during the motion, in the order of their representative
  /// triangles, and adds to `counts`. Returns false, without pairs, once `counts` exceed `limits`.
  bool find(const LinearMotion& motion, double friction, const PairCounts& limits, PairCounts& counts,
            BroadPhasePairs& found);

 private:
  struct Pair;
  /// Appends the pairs that may come within d̂ of those in rows_.
  template <PairKind kind>
  void collect(const LinearMotion& motion, long limit, std::vector<Pair>& pairs) const;
  template <PairKind kind>
  bool find_kind(const BroadPhase& first, const BroadPhase& second, const LinearMotion& motion,
                 const PairCounts& limits, PairCounts& counts, std::vector<Pair>& pairs);
  template <PairKind kind>
  std::array<int, 4> vertices_of(int a, int b) const;
  /// The pair of primitives a and b, with its place in the order.
  template <PairKind kind>
  Pair placed(int a, int b) const;
  std::vector<Pair> in_order(const std::vector<Pair>& pairs) const;

  const Surface& cloth_;
  SweptBoxes boxes_;
  std::unique_ptr<BroadPhase> vertices_, edges_, triangles_;
  AdjacencyList rows_;
};

}  // namespace drape

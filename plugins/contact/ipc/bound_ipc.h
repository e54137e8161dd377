#pragma once

#include <memory>
#include <mutex>

#include "core/contact/broad_phase.h"
#include "core/model/smallest_gap.h"
#include "plugins/contact/ipc/candidates.h"
#include "plugins/contact/ipc/ipc.h"

namespace drape {

/// What a sweep found: pairs that repel each other, pairs that are only not to pass through each other, and
/// the cloth's vertices with the triangles whose surface repels them.
struct Candidates {
  std::vector<ContactPair> repelling, passive;
  std::vector<NearTriangle> near;
};

/// What follows from the cloth's rest shape. A level that is bound again, as conditions change, shares it.
struct RestingCloth {
  TriangleMesh rest;
  double range = 0;  ///< d̂ [m]
  bool self_contact = true;
  Surface surface;
  std::vector<std::array<int, 4>> close;  ///< self pairs that rest within the range, in order

  /// Kept for as long as somebody has it.
  static std::shared_ptr<const RestingCloth> of(const Level& level, double range, bool self_contact);
};

/// The obstacles' boxes, a tree of them and what else depends on the range, kept likewise.
struct ObstacleTree {
  std::shared_ptr<const Obstacles> obstacles;
  double range;
  BroadPhaseKind kind;
  SweptBoxes boxes;
  OperatorCoefficients coefficients;
  std::unique_ptr<BroadPhase> tree;

  static std::shared_ptr<const ObstacleTree> of(std::shared_ptr<const Obstacles> obstacles, double range,
                                                BroadPhaseKind kind);
};

/// Contact `ipc` of one level.
class BoundIpc final : public BoundContact, public MovableObstacles, public NamesSmallestGap {
 public:
  BoundIpc(const Ipc::Parameters& parameters, std::shared_ptr<const Obstacles> obstacles, const Level& level,
           const Material& material);

  /// Shortened, and its max_step with it, where the whole way would bring more pairs together than are
  /// reasonable to hold (see README.md, "Long steps").
  std::unique_ptr<ContactSweep> sweep(const Positions& x0, const Positions& x1) const override;
  std::vector<Touch> intersections(const Positions& x) const override;
  std::vector<TriangleMesh> obstacles() const override;

  SmallestGap smallest_gap(const Positions& x) const override;
  StepLimit max_move(const BoundContact& before, const Positions& x) const override;
  void carry(const BoundContact& before, const Positions& x, Positions& from) const override;

 private:
  /// Numbers of pairs, of triangles whose boxes overlap and of primitives that may come near.
  struct Counts {
    long triangles = 0, primitives = 0;
    bool operator==(const Counts&) const = default;
  };
  /// False if there are more than `limits`. Called by one thread at a time.
  bool search(const Positions& x0, const Positions& x1, const Counts& limits, FoundPairs& found,
              Counts& counts) const;

  double friction_, keep_;
  bool self_contact_;
  BarrierParameters barrier_;
  std::shared_ptr<const Obstacles> obstacles_;
  std::shared_ptr<const ObstacleTree> obstacle_tree_;
  std::shared_ptr<const RestingCloth> rest_;
  const Surface& cloth_;
  BroadPhaseKind broad_phase_;

  // Kept from call to call for speed alone: results do not depend on them.
  mutable std::mutex busy_;
  mutable std::unique_ptr<BroadPhase> cloth_tree_;
  mutable SweptBoxes boxes_;
  mutable AdjacencyList rows_;
};

}  // namespace drape

#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "core/kernel/interfaces/contact_model.h"
#include "core/numerics/collision_detection/broad_phase.h"
#include "core/numerics/contact/candidates.h"
#include "core/numerics/contact/pair_geometry.h"
#include "plugins/contact/ipc/ipc.h"
#include "plugins/contact/ipc/rest_layers.h"

namespace drape::ipc {

/// Data of the cloth's rest shape, shared when the level is bound again under other loads.
struct RestCloth {
  double dhat;  ///< d̂ [m]
  bool self_contact;
  Surface surface;
  RestLayers layers;  ///< none without self-contact

  /// Throws std::runtime_error if too many pairs are within d̂ at rest.
  RestCloth(const Level& level, double dhat, bool self_contact);
};

/// The obstacles with what depends on d̂ and the broad phase: their boxes, their tree and the coefficients of
/// the improved maximum operator.
struct ObstacleTree {
  std::shared_ptr<const Obstacles> obstacles;
  Eigen::RowVector3d origin;  // of the boxes, and of those that are compared with them
  SweptBoxes boxes;
  OperatorCoefficients coefficients;
  std::unique_ptr<BroadPhase> tree;

  ObstacleTree(std::shared_ptr<const Obstacles> all, double dhat, BroadPhaseKind kind);
};

/// The contact model `ipc` bound to one level.
class BoundIpc final : public BoundContact {
 public:
  BoundIpc(const Ipc::Parameters& parameters, const BarrierParameters& barrier,
           std::shared_ptr<const ObstacleTree> obstacles, std::shared_ptr<const RestCloth> rest);

  const std::shared_ptr<const RestCloth>& rest() const { return rest_; }

  /// Shortens the motion, and with it max_step, if it has too many candidate pairs.
  std::unique_ptr<CollisionCandidates> build_candidates(const Positions& x0,
                                                        const Positions& x1) const override;
  std::vector<Intersection> intersections(const Positions& x) const override;
  std::vector<TriangleMesh> obstacles() const override;
  double dhat() const override { return barrier_.dhat; }
  double stiffness() const override { return barrier_.stiffness; }
  std::shared_ptr<const BoundContact> with_stiffness(double stiffness) const override;
  std::string remark() const override { return rest_->layers.remark(); }

  SmallestGap smallest_gap(const Positions& x) const override;
  std::vector<ObstacleGap> obstacle_gaps(const Positions& x) const override;
  StepLimit max_step(const BoundContact& before, const Positions& x) const override;
  Eigen::Vector3d displacement(const BoundContact& before, const ObstaclePoint& point) const override;

 private:
  class Candidates;

  /// Sets `found`, and `boxes` to the number of overlapping boxes. Returns false if there are more pairs than
  /// `limits`. The caller holds busy_.
  bool search(const Positions& x0, const Positions& x1, const PairLimits& limits,
              std::vector<ContactPair>& found, long& boxes) const;

  Ipc::Parameters p_;
  BarrierParameters barrier_;
  std::shared_ptr<const ObstacleTree> obstacle_tree_;
  std::shared_ptr<const RestCloth> rest_;
  const Obstacles& obstacles_;  // the tree's
  const Surface& cloth_;        // the rest shape's

  // Reused between calls for speed; results do not depend on them.
  mutable std::mutex busy_;
  mutable std::unique_ptr<SelfPairSearch> self_search_;  // null without self-contact
  mutable std::unique_ptr<BroadPhase> cloth_tree_;
  mutable SweptBoxes boxes_;
  mutable AdjacencyList rows_;
};

}  // namespace drape::ipc

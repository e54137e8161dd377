#pragma once

#include <memory>
#include <vector>

#include "core/kernel/interfaces/contact_model.h"
#include "core/numerics/contact/pair_geometry.h"
#include "plugins/contact/ipc/cloth_search.h"
#include "plugins/contact/ipc/ipc.h"
#include "plugins/contact/ipc/rest_layers.h"

namespace drape::ipc {

/// Data of the cloth's rest shape, shared when the level is bound again under other loads.
struct RestCloth {
  double dhat;  ///< d̂ [m]
  bool self_contact;
  BroadPhaseKind broad_phase;
  Surface surface;
  RestLayers layers;  ///< none without self-contact
  mutable ClothSearch search;

  /// Throws std::runtime_error if too many pairs are within d̂ at rest.
  RestCloth(const Level& level, const Ipc::Parameters& p);
  /// Whether it is that of these parameters too.
  bool serves(const Ipc::Parameters& p) const {
    return dhat == p.dhat && self_contact == p.self_contact && broad_phase == p.broad_phase;
  }
};

/// The contact model `ipc` bound to one level.
class BoundIpc final : public BoundContact {
 public:
  /// `tree` is that of the obstacles.
  BoundIpc(const Ipc::Parameters& parameters, const BarrierParameters& barrier,
           std::shared_ptr<const Obstacles> obstacles, Deferred<ObstacleTree> tree,
           std::shared_ptr<const RestCloth> rest);

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
  /// `limits`. The caller holds ClothSearch::busy.
  bool search(const Positions& x0, const Positions& x1, const PairLimits& limits,
              std::vector<ContactPair>& found, long& boxes) const;

  Ipc::Parameters p_;
  BarrierParameters barrier_;
  std::shared_ptr<const Obstacles> obstacles_;
  Deferred<ObstacleTree> tree_;
  std::shared_ptr<const RestCloth> rest_;
  const Surface& cloth_;  // the rest shape's
};

}  // namespace drape::ipc

#pragma once

#include <memory>
#include <vector>

#include "core/kernel/interfaces/contact_model.h"
#include "core/kernel/threads/deferred.h"
#include "core/numerics/collision_detection/broad_phase.h"
#include "core/numerics/contact/contact_parameters.h"
#include "plugins/contact/ipc/obstacle.h"

namespace drape::ipc {

struct ObstacleTree;
struct RestCloth;

/// Incremental potential contact (Li et al. 2020, 2021) of a cloth with itself and with triangle meshes.
class Ipc final : public ContactModel {
 public:
  struct Parameters : ContactParameters {
    bool self_contact = true;
    std::vector<ObstacleParameters> obstacles;
    BroadPhaseKind broad_phase = BroadPhaseKind::bvh;

    static void declare(Declaration<Parameters>& d);
  };

  /// Reads and validates the obstacles. Throws RefusedParameters naming all invalid ones.
  explicit Ipc(const Parameters& parameters) : Ipc(parameters, nullptr) {}
  /// Takes the meshes, cages and trees of `before` where they are equal.
  Ipc(const Parameters& parameters, const Ipc& before) : Ipc(parameters, &before) {}

  std::unique_ptr<BoundContact> bind(const Level& level, const Material& material) const override;
  std::unique_ptr<BoundContact> rebind(const Level& level, const Material& material,
                                       const BoundContact& before) const override;
  /// How obstacles were repaired, a line each.
  std::vector<std::string> input_remarks() const override;

 private:
  Ipc(const Parameters& parameters, const Ipc* before);
  std::unique_ptr<BoundContact> bind(const Level& level, const Material& material,
                                     std::shared_ptr<const RestCloth> rest) const;

  /// The obstacles of a level, made when it is first bound, and their tree, when it is first searched: a load
  /// may be bound to a single level or none, and its pose refused.
  struct LevelObstacles {
    std::vector<Obstacle> bodies;
    Deferred<ObstacleTopology> topology;  // of all poses
    std::shared_ptr<PoseTrees> trees;     // of all poses
    Deferred<Obstacles> obstacles;
    Deferred<ObstacleTree> tree;
  };

  /// The obstacles of the next level, which takes from `before` (or null) what stays the same.
  LevelObstacles level_obstacles(std::vector<Obstacle> bodies, const Ipc* before) const;

  Parameters p_;
  std::vector<ObstacleMeshes> meshes_;  // of each obstacle
  std::vector<LevelObstacles> levels_;  // finer levels use the last
};

}  // namespace drape::ipc

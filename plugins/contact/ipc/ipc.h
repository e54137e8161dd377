#pragma once

#include <optional>
#include <vector>

#include "core/contact/broad_phase.h"
#include "core/model/contact_model.h"
#include "plugins/contact/ipc/obstacle.h"

namespace drape {

/// The barrier of incremental potential contact (Li et al. 2020, 2021) between a cloth, itself and obstacles
/// that are triangle meshes.
class Ipc final : public ContactModel {
 public:
  struct Parameters {
    bool self_contact = true;
    std::vector<ObstacleParameters> obstacles;
    double friction = 0;
    double range = 1e-3;
    std::optional<double> stiffness;
    double slip_distance = 1e-4;
    double keep = 0.1;
    BroadPhaseKind broad_phase = BroadPhaseKind::bvh;

    static void declare(Declaration<Parameters>& d);
  };

  /// Reads and checks the obstacles; throws std::runtime_error naming the one that is not sound.
  explicit Ipc(const Parameters& parameters);
  std::unique_ptr<BoundContact> bind(const Level& level, const Material& material) const override;

 private:
  Parameters p_;
  std::vector<std::shared_ptr<const Obstacles>> obstacles_;  // by level; finer ones meet the last
};

}  // namespace drape

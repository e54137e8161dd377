#pragma once

#include <vector>

#include "core/kernel/contact/broad_phase.h"
#include "core/kernel/contact/contact_parameters.h"
#include "core/kernel/model/contact_model.h"
#include "plugins/contact/ipc/obstacle.h"

namespace drape::ipc {

/// Incremental potential contact (Li et al. 2020, 2021) of a cloth with itself and with triangle meshes.
class Ipc final : public ContactModel {
 public:
  struct Parameters : ContactParameters {
    bool self_contact = true;
    std::vector<ObstacleParameters> obstacles;
    BroadPhaseKind broad_phase = BroadPhaseKind::bvh;

    static void declare(Declaration<Parameters>& d);
  };

  /// Reads and validates the obstacles. Throws std::runtime_error naming an invalid one.
  explicit Ipc(const Parameters& parameters);
  std::unique_ptr<BoundContact> bind(const Level& level, const Material& material) const override;

 private:
  Parameters p_;
  std::vector<std::shared_ptr<const Obstacles>> obstacles_;  // by level; finer levels use the last
};

}  // namespace drape::ipc

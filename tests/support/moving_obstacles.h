#pragma once

#include <memory>
#include <vector>

#include "core/numerics/model/required.h"
#include "plugins/contact/ipc/ipc.h"
#include "tests/support/ipc_obstacles.h"
#include "tests/support/meshes.h"

// Obstacles that tests move.

namespace drape::ipc {

using Bodies = std::vector<ObstacleParameters>;

inline std::shared_ptr<const BoundContact> bound(const Bodies& bodies, const Level& level,
                                                 double friction = 0) {
  Ipc::Parameters p;
  p.self_contact = false;
  p.obstacles = bodies;
  p.friction = friction;
  return Ipc(p).bind(level, Material());
}

/// A sheet within d̂ above z = 0.
inline Positions resting(const Level& level) {
  return level.rest.vertices.rowwise() + Eigen::RowVector3d(0, 0, 4e-4);
}

}  // namespace drape::ipc

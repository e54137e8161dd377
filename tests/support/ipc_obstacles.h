#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "plugins/contact/ipc/obstacle.h"

// Obstacles that tests of ipc share.

namespace drape::ipc {

inline Obstacle obstacle_of(const ObstacleParameters& p) {
  return Obstacle::of(p, 0, ObstacleMeshes::of(p, 0));
}

inline Obstacles obstacles_of(const std::vector<Obstacle>& bodies) {
  return Obstacles::of(bodies, std::make_shared<const ObstacleTopology>(topology_of(bodies)));
}

inline ObstacleParameters box(const Eigen::Vector3d& size,
                              const Eigen::Vector3d& translate = Eigen::Vector3d::Zero()) {
  ObstacleParameters p;
  p.name = "block";
  p.meshed_shape = "box";
  p.size = size;
  p.translate = translate;
  return p;
}

inline ObstacleParameters ball(int subdivisions, const Eigen::Vector3d& translate, double radius = 0.05) {
  ObstacleParameters p;
  p.name = "ball";
  p.meshed_shape = "sphere";
  p.radius = radius;
  p.subdivisions = subdivisions;
  p.translate = translate;
  return p;
}

}  // namespace drape::ipc

#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace drape {

/// Identifies a contact of one contact model from one state to the next.
using ContactKey = std::array<int, 5>;

/// The point of an obstacle that a contact touches: Σ weights_k vertex_k + offset.
struct ObstaclePoint {
  int obstacle = -1;                           ///< index in the contact model; -1: the contact has none
  std::array<int, 3> vertices = {-1, -1, -1};  ///< of the model's obstacles, padded with -1
  Eigen::Vector3d weights = Eigen::Vector3d::Zero();
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< [m]
};

/// A collision as friction needs it. Σ c_k x_k is the position of one side relative to the other.
struct FrictionContact {
  ContactKey key = {};
  std::array<int, 4> vertices;  ///< of the cloth; -1 for an obstacle's
  Eigen::Vector4d c = Eigen::Vector4d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit length
  double force = 0;                                  ///< μ times the normal force [N]
  ObstaclePoint touched = {};                        ///< none where the cloth touches itself
};

/// Friction contacts in groups whose energies are summed apart: one for each part of the collisions.
using FrictionContacts = std::vector<std::vector<FrictionContact>>;

}  // namespace drape

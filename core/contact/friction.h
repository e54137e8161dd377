#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "core/model/contact_model.h"

namespace drape {

/// One contact as friction sees it, all of it lagged: Σ c_k x_k is the place of one side relative to the
/// other.
struct FrictionContact {
  ContactKey key = {};
  std::array<int, 4> vertices;  ///< of the cloth; -1 for what does not move
  Eigen::Vector4d c = Eigen::Vector4d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit length
  double force = 0;                                  ///< μ times the normal force [N]
};

/// The lagged friction potential Σ force f₀(|u|), u being the tangential part of s + Σ c_k (x_k - from_k), s
/// the contact's among `slips`, 0 where it is new, f₀' = f₁, f₁(y) = 2y/ε - (y/ε)² below ε = slip_distance
/// [m] and 1 beyond (Li et al. 2020, eq. 14), f₀(0) = 0. Its Hessian is positive semidefinite as it is. Null
/// without contacts.
///
/// Departure from the paper, which has no s, so that a cloth at rest creeps by up to ε_v h in each step: with
/// it what sticks is held by a force that lasts.
std::unique_ptr<FrictionEnergy> make_friction(std::vector<FrictionContact> contacts, const Positions& from,
                                              const Slips& slips, double slip_distance);

}  // namespace drape

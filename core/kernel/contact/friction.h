#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "core/kernel/model/contact_model.h"

namespace drape {

/// A contact with lagged normal force and tangent plane. Σ c_k x_k is the position of one side relative to
/// the other.
struct FrictionContact {
  ContactKey key = {};
  std::array<int, 4> vertices;  ///< of the cloth; -1 for an obstacle's
  Eigen::Vector4d c = Eigen::Vector4d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< unit length
  double force = 0;                                  ///< μ times the normal force [N]
};

/// The lagged friction potential Σ force f₀(|u|) (Li et al. 2020, eq. 14), null without contacts. u is the
/// tangential part of s + Σ c_k (x_k - reference_k), with s the contact's stored displacement, 0 for a new
/// contact. f₀(0) = 0 and f₀' = f₁, f₁(y) = 2y/ε - (y/ε)² below ε = friction_smoothing_distance [m], 1 above.
/// The Hessian is positive semidefinite without projection.
///
/// Departure from the paper: there s = 0, and a cloth at rest creeps by up to ε_v h in each step. With s,
/// sticking contacts keep their friction force.
std::unique_ptr<FrictionEnergy> make_friction(std::vector<FrictionContact> contacts,
                                              const Positions& reference,
                                              const TangentialDisplacements& displacements,
                                              double friction_smoothing_distance);

}  // namespace drape

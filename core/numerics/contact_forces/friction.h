#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "core/kernel/interfaces/contact_model.h"

namespace drape {

/// Tangential displacement u of a contact's two sides since the contact began to stick (Li et al. 2020).
struct TangentialDisplacement {
  ContactKey contact;
  Eigen::Vector3d displacement;  ///< of one side relative to the other, in the tangent plane [m]
  double force = 0;              ///< the friction force that its normal force allowed then [N]
};

/// What a contact that sticks keeps when its normal force changes.
enum class Sticking {
  displacement,  ///< and the friction force follows the normal force
  force          ///< up to what the normal force allows; the displacement follows
};

/// Ascending by contact, without duplicates. After an obstacle has moved, the cloth may touch other features
/// of it: there are entries for each cloth vertex and obstacle then, too, with the mean over the vertex's
/// contacts.
using TangentialDisplacements = std::vector<TangentialDisplacement>;

/// The displacement of a touched point since the obstacles were where the contact was found [m].
using ObstacleMotion = std::function<Eigen::Vector3d(const ObstaclePoint& point)>;

/// The under-relaxed lag of friction: normal forces, points and normals of each contact of `before`, averaged
/// with those of `now` by (1 - fraction) and `fraction` of their friction forces. Contacts of `before` that
/// are not in `now` keep (1 - fraction) of their force, in a last group of their own, until it is negligible;
/// a fraction of 1 keeps them with no force.
FrictionContacts under_relaxed(const FrictionContacts& before, FrictionContacts now, double fraction);

/// The lagged friction potential D = Σ force f₀(|u|) (Li et al. 2020, eq. 14 and 15), a value. u is the
/// tangential part of s + Σ c_k (x_k - reference_k), with s the contact's stored displacement, 0 for a new
/// contact. f₀(0) = 0 and f₀' = f₁, f₁(y) = 2y/ε - (y/ε)² below ε, 1 above. The Hessian is positive
/// semidefinite without projection.
///
/// Departure from the paper: there s = 0, and a cloth at rest creeps by up to ε_v h in each step. With s,
/// sticking contacts keep their friction force.
class LaggedFriction final : public BoundEnergy {
 public:
  /// Displacements are measured from `reference` (n×3) [m]; `displacements` are added to those of the
  /// contacts that they name.
  LaggedFriction(FrictionContacts groups, const Positions& reference,
                 const TangentialDisplacements& displacements, double friction_smoothing_distance,
                 Sticking sticking = Sticking::displacement);

  double value(const Positions& x) const override;
  double add_gradient(const Positions& x, Positions& g) const override;
  Stencils stencils() const override;
  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override;

  /// Each contact's tangential displacement at x. Its length is limited to the friction smoothing distance:
  /// the next step then starts with the same friction forces.
  TangentialDisplacements tangential_displacements(const Positions& x) const;
  /// Tangential displacements without that limit, relative to obstacles that have moved: every contact
  /// subtracts the tangential part of the motion of the point that it touches. With entries for vertices.
  TangentialDisplacements advected_tangential_displacements(const Positions& x,
                                                            const ObstacleMotion& motion) const;

 private:
  int size() const { return static_cast<int>(contacts_.size()); }
  void append_means(TangentialDisplacements& of_contacts) const;
  Eigen::Vector3d tangential(int i, const Eigen::Vector3d& u) const;
  Eigen::Vector3d displacement(int i, const Positions& x) const;
  double potential(int i, double y) const;
  double ratio(double y) const;
  Eigen::Matrix3d stiffness(int i, const Eigen::Vector3d& u) const;

  std::vector<FrictionContact> contacts_;
  std::vector<int> group_ends_;  // indices of contacts_
  // Σ c_k reference_k of each contact, less its stored displacement [m].
  std::vector<Eigen::Vector3d> origin_;
  double epsilon_;  // ε, the friction smoothing distance [m]
};

/// The friction contacts of these collisions, with the normal forces and tangents of their state; no group is
/// empty.
FrictionContacts friction_contacts(const Collisions& collisions);

/// The friction of these contacts of the collisions, as LaggedFriction's constructor describes; by default
/// all of them. Null without contacts.
std::unique_ptr<const LaggedFriction> lagged_friction(const Collisions& collisions, FrictionContacts contacts,
                                                      const Positions& reference,
                                                      const TangentialDisplacements& displacements,
                                                      Sticking sticking = Sticking::displacement);
inline std::unique_ptr<const LaggedFriction> lagged_friction(const Collisions& collisions,
                                                             const Positions& reference,
                                                             const TangentialDisplacements& displacements) {
  return lagged_friction(collisions, friction_contacts(collisions), reference, displacements);
}

}  // namespace drape

#pragma once

#include "core/numerics/contact/collisions.h"
#include "core/numerics/contact/pair_geometry.h"

namespace drape {

/// A pair within its d̂ at one state, with the barrier κ · weight · d̂ · m · b(gap / d̂), b(s) = -(s - 1)² ln s,
/// m the edge-edge mollifier (BarrierCollisions). Obstacle vertices are static.
struct PairContact {
  ContactPair pair;
  int cloth_count;  ///< indices from here on are obstacle vertices
  Closest closest;
  Eigen::Vector3d normal;      ///< r / |r|
  double distance;             ///< |r| [m]
  Eigen::Matrix3d difference;  ///< columns x_k - x_0, k = 1 … 3 [m]
  Derivatives barrier;         ///< b and its derivatives by gap / d̂
  Derivatives mollifier;       ///< m and its derivatives by |u × v|²

  PairContact() {}  // numbers stay uninitialised, to save time
  /// The primitives must not touch.
  PairContact(const ContactPair& pair, const Positions& x, const Positions& obstacle_vertices);

  static constexpr int columns = 4;
  std::array<int, 4> vertices() const;
  double gap() const { return distance - pair.offset; }
  void add_energy(const BarrierParameters&, double& sum) const {
    sum += pair.weight * pair.dhat * mollifier.value * barrier.value;
  }
  static double unit(const BarrierParameters& p) { return p.stiffness; }
  void add_gradient(const BarrierParameters& p, Positions& g) const;
  /// Projected as matrices of the cloth's vertices; other blocks are zero. Without projection they are exact:
  /// the distance's second derivatives follow from ∂c/∂t by a Schur complement.
  static void hessians(std::span<const PairContact> contacts, const BarrierParameters& p,
                       Projection projection, ContactBlocks<4>* blocks);
  void add_normal_forces(const BarrierParameters& p, NormalForces& forces) const {
    forces.add(p.stiffness * pressure(), barrier.first);
  }
  void append_friction(const BarrierParameters& p, std::vector<FrictionContact>& all) const {
    if (pair.friction != 0) all.push_back(friction_contact(p, pressure()));
  }

  bool is_cloth(int k) const { return pair.vertices[k] < cloth_count; }
  /// Normal force over κ [m²].
  double pressure() const { return -pair.weight * mollifier.value * barrier.first; }
  /// The gradient of the energy over κ; column k is vertex k's [m²].
  PairPositions gradient() const;
  /// The contact as friction needs it, with this normal force over κ [m²].
  FrictionContact friction_contact(const BarrierParameters& p, double force) const;

  /// Whether the edges are nearly parallel: then m is not constant 1.
  bool mollified() const { return has_two_edges(pair.kind) && mollifier.second != 0; }
  Eigen::Vector3d first_edge() const { return difference.col(0); }
  Eigen::Vector3d second_edge() const { return difference.col(2) - difference.col(1); }
};

/// Those of the pairs whose gap at x (cloth, n×3) is below their d̂, in their order.
std::vector<PairContact> find_pair_contacts(const Positions& x, const Positions& obstacle_vertices,
                                            const std::vector<ContactPair>& pairs);

}  // namespace drape

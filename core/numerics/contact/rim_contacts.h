#pragma once

#include "core/numerics/contact/pair_contacts.h"

namespace drape {

/// An edge of the cloth and one of an obstacle, of which either is the first, with the barrier
///
///     κ d̂ weight · m · (b - b_0)(b - b_1) / b                                     (BarrierCollisions)
///
/// with b of the distance of the two edges, b_k of that from end k of the first edge to the second, and
/// m the edge-edge mollifier. Obstacle vertices are static.
///
/// First edges of the cloth meet sharp edges: the barrier of the cloth's vertices acts on the ends already.
/// Where an end is nearest, and over the whole of a surface up to its rim, the sum is therefore 0; while an
/// end passes beyond the rim, it grows by what that of the vertex loses. With b alone a cloth would have to
/// climb its rim's barrier before it can slide over it. A first edge of an obstacle is the axis of a
/// cylinder, whose side ends where its axis does.
struct RimContact {
  std::array<PairContact, 3> parts;  ///< of the edges, and of the first edge's ends 0 and 1

  static constexpr int columns = 2;
  std::array<int, 4> vertices() const { return {cloth_vertex(0), cloth_vertex(1), -1, -1}; }
  double gap() const { return parts[0].gap(); }
  void add_energy(const BarrierParameters& p, double& sum) const;
  static double unit(const BarrierParameters& p) { return p.stiffness; }
  void add_gradient(const BarrierParameters& p, Positions& g) const;
  static void hessians(std::span<const RimContact> contacts, const BarrierParameters& p,
                       Projection projection, ContactBlocks<2>* blocks);
  void add_normal_forces(const BarrierParameters& p, NormalForces& forces) const;
  void append_friction(const BarrierParameters& p, std::vector<FrictionContact>& all) const;

  double b(int i) const { return parts[i].barrier.value; }

 private:
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  using Matrix6d = Eigen::Matrix<double, 6, 6>;

  /// The place in part i of vertex k of the cloth's edge.
  int place(int i, int k) const { return parts[0].is_cloth(0) ? (i == 2 ? 1 - k : k) : 2 + k; }
  int cloth_vertex(int k) const { return parts[0].pair.vertices[place(0, k)]; }
  PairContact weighted(int i) const;
  Vector6d gradient_of(const PairContact& contact, int i) const;
  Matrix6d hessian(const BarrierParameters& p, const ContactBlocks<4>* blocks) const;
};

/// The rim contacts at x (cloth, n×3) of those pairs whose gap is below their d̂, in their order.
std::vector<RimContact> find_rim_contacts(const Positions& x, const Positions& obstacle_vertices,
                                          const std::vector<ContactPair>& pairs);

}  // namespace drape

#pragma once

#include "core/numerics/collision_detection/signed_distance.h"
#include "core/numerics/contact/collisions.h"

namespace drape {

/// A cloth vertex within d̂ of an obstacle whose distance is known in closed form, with the barrier
/// κ d̂ weight b(distance / d̂) (BarrierCollisions).
struct VertexContact {
  int vertex;
  int obstacle;     ///< identifies the obstacle, for friction
  double weight;    ///< the vertex's rest area [m²]
  double friction;  ///< μ
  SignedDistance nearest;
  Eigen::Vector3d touched = Eigen::Vector3d::Zero();  ///< the obstacle's nearest point, if obstacles move [m]

  static constexpr int columns = 1;
  std::array<int, 4> vertices() const { return {vertex, -1, -1, -1}; }
  double gap() const { return nearest.distance; }
  void add_energy(const BarrierParameters& p, double& sum) const { sum += weight * b(p).value; }
  static double unit(const BarrierParameters& p) { return p.stiffness * p.dhat; }
  void add_gradient(const BarrierParameters& p, Positions& g) const {
    g.row(vertex) -= force(p) * nearest.normal.transpose();
  }
  static void hessians(std::span<const VertexContact> contacts, const BarrierParameters& p,
                       Projection projection, ContactBlocks<1>* blocks);
  void add_normal_forces(const BarrierParameters& p, NormalForces& forces) const {
    forces.add(force(p), b(p).first);
  }
  void append_friction(const BarrierParameters& p, std::vector<FrictionContact>& all) const;

 private:
  Derivatives b(const BarrierParameters& p) const { return barrier(nearest.distance / p.dhat); }
  double force(const BarrierParameters& p) const { return -p.stiffness * weight * b(p).first; }  ///< [N]
};

}  // namespace drape

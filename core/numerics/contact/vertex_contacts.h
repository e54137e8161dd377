#pragma once

#include <memory>
#include <vector>

#include "core/kernel/interfaces/contact_model.h"
#include "core/numerics/collision_detection/signed_distance.h"
#include "core/numerics/contact_forces/barrier.h"

namespace drape {

/// A cloth vertex within d̂ of an obstacle whose distance is known in closed form.
struct VertexContact {
  int vertex;
  int obstacle;     ///< identifies the obstacle, for friction
  double weight;    ///< the vertex's rest area [m²]
  double friction;  ///< μ
  SignedDistance nearest;
  Eigen::Vector3d touched = Eigen::Vector3d::Zero();  ///< the obstacle's nearest point, if obstacles move [m]
};

/// The barrier potential κ d̂ Σ weight b(distance / d̂) of these contacts, and their friction. The eigenvectors
/// of its Hessian are known: normal, tangent and normal × tangent.
std::unique_ptr<Collisions> make_vertex_contacts(std::vector<VertexContact> contacts,
                                                 const BarrierParameters& parameters);

}  // namespace drape

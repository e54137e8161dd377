#pragma once

#include "core/contact/barrier.h"
#include "core/contact/pair_geometry.h"

namespace drape {

/// A pair within range at one state, and what its energy κ · weight · d̂ · m · b is made of. Not initialised:
/// there are many.
struct Contact {
  ContactPair pair;
  Closest closest;
  Eigen::Vector3d normal;      ///< r / |r|
  double distance;             ///< |r| [m]
  Eigen::Matrix3d difference;  ///< x_k - x_0, k = 1 … 3, one a column [m]
  Derivatives barrier;         ///< b by (gap / d̂)
  Derivatives mollifier;       ///< m by |u × v|²

  double gap() const { return distance - pair.offset; }
  /// Whether the edges are so near to parallel that m is not 1.
  bool mollified() const { return pair.kind == PairKind::edge_edge && mollifier.second != 0; }
  /// Energy over κ, d̂ being the barrier's range [m³].
  double value(double range) const { return pair.weight * range * mollifier.value * barrier.value; }
  /// Normal force over κ [m²].
  double pressure() const { return -pair.weight * mollifier.value * barrier.first; }

  Eigen::Vector3d first_edge() const { return difference.col(0); }
  Eigen::Vector3d second_edge() const { return difference.col(2) - difference.col(1); }
};

bool within_range(const ContactPair& pair, const PairPositions& x, double range);
Contact contact_at(const ContactPair& pair, const PairPositions& x, double range);

/// The gradient of a contact's energy over κ by vertex k, one a column.
PairPositions contact_gradient(const Contact& contact, double range);

/// The 3×3 blocks (a, b), a ≤ b, of a pair's Hessian, row-major, at place b (b + 1) / 2 + a.
struct PairBlocks {
  double block[10][9];
};

/// Hessians of a run of contacts by the vertices below cloth_count, projected as matrices of those alone; the
/// other blocks are zero. Exact: second derivatives of the distance follow from ∂c/∂t by a Schur complement.
void contact_hessians(const Contact* contacts, int count, const BarrierParameters& parameters,
                      int cloth_count, Projection projection, PairBlocks* blocks);

}  // namespace drape

#pragma once

#include "core/numerics/contact/pair_geometry.h"
#include "core/numerics/contact_forces/barrier.h"
#include "core/numerics/contact_forces/friction.h"

namespace drape {

/// A pair within its d̂ at one state, with the factors of its energy κ · weight · d̂ · m · b. Members are not
/// initialised, to save time.
struct Contact {
  ContactPair pair;
  Closest closest;
  Eigen::Vector3d normal;      ///< r / |r|
  double distance;             ///< |r| [m]
  Eigen::Matrix3d difference;  ///< columns x_k - x_0, k = 1 … 3 [m]
  Derivatives barrier;         ///< b and its derivatives by gap / d̂
  Derivatives mollifier;       ///< m and its derivatives by |u × v|²

  double gap() const { return distance - pair.offset; }
  /// Whether the edges are nearly parallel: then m is not constant 1.
  bool mollified() const { return has_two_edges(pair.kind) && mollifier.second != 0; }
  /// Energy over κ [m³].
  double value() const { return pair.weight * pair.dhat * mollifier.value * barrier.value; }
  /// Normal force over κ [m²].
  double pressure() const { return -pair.weight * mollifier.value * barrier.first; }

  Eigen::Vector3d first_edge() const { return difference.col(0); }
  Eigen::Vector3d second_edge() const { return difference.col(2) - difference.col(1); }
};

/// Whether the pair's gap at x is below its d̂.
bool is_within_dhat(const ContactPair& pair, const PairPositions& x);
/// The pair's contact at x. The primitives must not touch.
Contact contact_at(const ContactPair& pair, const PairPositions& x);

/// The gradient of a contact's energy over κ; column k is vertex k's [m²].
PairPositions contact_gradient(const Contact& contact);

/// The contact as friction needs it, with this force over κ [m²] in place of its pressure. Indices from
/// cloth_count on are obstacle vertices.
FrictionContact friction_contact(const Contact& contact, double force, double stiffness, int cloth_count);

/// The 3×3 blocks (a, b), a ≤ b, of a pair's Hessian, row-major; block (a, b) has index b (b + 1) / 2 + a.
struct PairBlocks {
  double block[10][9];
};

/// Hessians of `count` contacts with the barrier stiffness κ [Pa], with respect to vertices below
/// cloth_count, projected as matrices of those vertices; the other blocks are zero. Without projection they
/// are exact: the distance's second derivatives follow from ∂c/∂t by a Schur complement.
void contact_hessians(const Contact* contacts, int count, double stiffness, int cloth_count,
                      Projection projection, PairBlocks* blocks);

}  // namespace drape

#pragma once

#include "core/numerics/contact/candidates.h"
#include "core/numerics/contact_forces/barrier.h"

namespace drape {

// Shared by the searches for candidates.

/// Whether a pair can come within d̂: a bound from its distance and the relative motion of its primitives.
bool may_come_within_dhat(const ContactPair& pair, const LinearMotion& motion);

/// The pair of vertex v and triangle t of two surfaces, whose vertices 0 have these indices in pairs.
inline ContactPair vertex_triangle(int first, int v, const Surface& other, int first_other, int t) {
  const auto w = other.triangles.row(t);
  return {{first + v, first_other + w[0], first_other + w[1], first_other + w[2]}, PairKind::point_triangle};
}

/// The pair of edges e and f of two surfaces, whose vertices 0 have these indices in pairs.
inline ContactPair edge_edge(const Surface& own, int first, int e, const Surface& other, int first_other,
                             int f) {
  const auto v = own.edges.row(e), w = other.edges.row(f);
  ContactPair pair{{first + v[0], first + v[1], first_other + w[0], first_other + w[1]}, PairKind::edge_edge};
  pair.mollifier = mollifier_threshold * own.edge_length_squared[e] * other.edge_length_squared[f];
  return pair;
}

}  // namespace drape

#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/hierarchy/level.h"

namespace drape {

/// The change of every triangle's shape operator as a linear function of the mesh's dihedral angles: triangle
/// t has the numbers s = Σ weight (θ - θ̄) over its terms, and the bending energy ‖s‖².
struct ShapeOperators {
  struct Term {
    int hinge;               ///< row of Level::hinges
    Eigen::Vector3d weight;  ///< [√J]
  };
  std::vector<int> start;  ///< triangles + 1; terms of triangle t are start[t] … start[t + 1] - 1
  std::vector<Term> terms;

  /// For the energy Ā k ((1 - ν) tr S² + ν (tr S)²) of a triangle with rest area Ā and shape operator S,
  /// which follows from normals at its edges' middles: S = 1/Ā Σ l φ n nᵀ, where l is the edge's length, n
  /// its normal in the triangle's plane, and φ the turn about the edge from the triangle's normal to the
  /// edge's.
  ///
  /// φ is half the dihedral angle, and a correction that makes it exact for all quadratic surfaces over the
  /// rest shape, from the angles at the edge and at the other edges of its two triangles: of those that are
  /// exact, the least. Corrections with no weight above `tolerance` are left out. Where the triangles about
  /// the edge are alike there is none. φ at a border edge is what makes the triangle's energy least: no
  /// moment acts there.
  static ShapeOperators of(const Level& level, double k, double poisson_ratio, double tolerance);
};

}  // namespace drape

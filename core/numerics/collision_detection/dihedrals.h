#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "core/numerics/collision_detection/surface.h"

namespace drape {

/// Angles [rad] and curvatures [1/m] of a surface at each of its edges, or at each of its vertices.
struct Bends {
  Eigen::VectorXd angle, curvature;

  /// How far the surface protrudes through a chord of this length laid across edge or vertex i [m].
  double sagitta(int i, double length) const {
    return length / 8 * std::max(2 * angle[i], curvature[i] * length);
  }
};

/// How a surface bends.
struct Dihedrals {
  /// The angle between the normals of an edge's triangles: 0 if flat up to round-off, π on the boundary and
  /// with more than two triangles. The curvature is the angle over the triangles' mean height, of more than
  /// two over their least; 0 on the boundary.
  Bends edge;
  /// The largest of the vertex's edges. Where two of them are a rim, their own angle counts in place of those
  /// at them: a straight rim protrudes nowhere through a triangle of which no edge crosses it.
  Bends vertex;
  std::vector<char> edge_is_rim;  ///< on the boundary, or with an angle above 30°

  /// The bends of a surface with its vertices at `vertices` (n×3) [m].
  static Dihedrals of(const Surface& surface, const Positions& vertices);
};

/// Coefficients of the improved maximum operator (Li et al. 2023). Triangles have 1; the coefficients of
/// edges and vertices correct for the points that triangles share. With a function of the distance summed
/// over triangles, minus edges, plus vertices, a flat region counts once in any triangulation; the two sides
/// of a thin body are two regions. The surface may be any set of triangles: an edge of n triangles has n - 1,
/// a vertex 1 less its triangles plus what its edges have, by which every point of the surface counts once
/// (inclusion and exclusion).
struct OperatorCoefficients {
  Eigen::VectorXd edge, vertex;

  /// Reduces the coefficients of edges whose radius of curvature is below 4 d̂, to 0 at d̂: around a narrower
  /// pit the sum could become attractive. A vertex is reduced as the least reduced of its edges. The nearest
  /// feature of a point therefore has a total of at least 1. With equal coefficients the sum is the mean of
  /// those with and without the operator.
  static OperatorCoefficients of(const Surface& surface, const Dihedrals& dihedrals, double dhat);
};

}  // namespace drape

#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "core/numerics/collision_detection/surface.h"

namespace drape {

/// Dihedral angles and curvatures of a surface at its edges and vertices.
struct Dihedrals {
  /// Between the normals of each edge's triangles; 0 if flat up to round-off; π on the boundary and with more
  /// than two triangles [rad].
  Eigen::VectorXd edge_angle;
  /// Angle over the triangles' mean height, of more than two over their least; 0 on the boundary [1/m].
  Eigen::VectorXd edge_curvature;
  /// The largest of the vertex's edges. Where two of them are a rim, their own angle counts in place of those
  /// at them: a straight rim protrudes nowhere through a triangle of which no edge crosses it.
  Eigen::VectorXd vertex_angle, vertex_curvature;
  std::vector<char> edge_is_rim;  ///< on the boundary, or with an angle above 30°

  /// Of a surface with its vertices at `vertices` (n×3) [m].
  static Dihedrals of(const Surface& surface, const Positions& vertices);

  /// How far the surface protrudes through a chord of this length laid across the edge [m].
  double edge_sagitta(int e, double length) const {
    return sagitta(edge_angle[e], edge_curvature[e], length);
  }
  /// The same for a chord across the vertex [m].
  double vertex_sagitta(int v, double length) const {
    return sagitta(vertex_angle[v], vertex_curvature[v], length);
  }

 private:
  static double sagitta(double angle, double curvature, double length) {
    return length / 8 * std::max(2 * angle, curvature * length);
  }
};

/// Coefficients of the improved maximum operator (Li et al. 2023). Triangles have 1; the coefficients of
/// edges and vertices correct for the points that triangles share. With a function of the distance summed
/// over triangles, minus edges, plus vertices, a flat region counts once in any triangulation. The surface
/// may be any set of triangles: an edge of n triangles has n - 1, a vertex 1 less its triangles plus what its
/// edges have, by which every point of the surface counts once (inclusion and exclusion).
struct OperatorCoefficients {
  Eigen::VectorXd edge, vertex;

  /// Reduces the coefficients of edges whose radius of curvature is below 4 d̂, to 0 at d̂: around a narrower
  /// pit the sum could become attractive. A vertex is reduced as the least reduced of its edges. The nearest
  /// feature of a point therefore has a total of at least 1. With equal coefficients the sum is the mean of
  /// those with and without the operator.
  static OperatorCoefficients of(const Surface& surface, const Dihedrals& dihedrals, double dhat);
};

}  // namespace drape

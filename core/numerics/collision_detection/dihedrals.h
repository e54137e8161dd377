#pragma once

#include <algorithm>
#include <vector>

#include "core/numerics/collision_detection/obstacle_surface.h"

namespace drape {

/// How a surface bends at an edge or a vertex.
struct Bend {
  double angle = 0;      ///< [rad]
  double curvature = 0;  ///< [1/m]
  double area = 0;       ///< a third of the adjacent triangles' [m²]

  /// How far the surface protrudes through a chord of this length laid across the edge or vertex [m].
  double sagitta(double length) const { return length / 8 * std::max(2 * angle, curvature * length); }
};

/// How a pose of obstacles bends. A bend is computed when it is first asked for, since a cloth meets a small
/// part of a large body. Threads may ask at the same time.
class Dihedrals {
 public:
  /// Refers to the surface.
  explicit Dihedrals(const ObstacleSurface& surface);

  /// The angle between the normals of an edge's triangles: 0 if flat up to round-off, π on the boundary and
  /// with more than two triangles. The curvature is the angle over the triangles' mean height, of more than
  /// two over their least; 0 on the boundary.
  Bend edge(int e) const;
  /// The largest of the vertex's edges. Where two of them are a rim, their own angle counts in place of those
  /// at them: a straight rim protrudes nowhere through a triangle of which no edge crosses it.
  Bend vertex(int v) const;
  /// Whether an edge is on the boundary, or has an angle above 30°.
  bool edge_is_rim(int e) const;

  /// Coefficients of the improved maximum operator (Li et al. 2023). Triangles have 1; the coefficients of
  /// edges and vertices correct for the points that triangles share. With a function of the distance summed
  /// over triangles, minus edges, plus vertices, a flat region counts once in any triangulation; the two
  /// sides of a thin body are two regions. The surface may be any set of triangles: an edge of n triangles
  /// has n - 1, a vertex 1 less its triangles plus what its edges have, by which every point of the surface
  /// counts once (inclusion and exclusion).
  ///
  /// Coefficients of edges whose radius of curvature is below 4 d̂ are reduced, to 0 at d̂: around a narrower
  /// pit the sum could become attractive. A vertex is reduced as the least reduced of its edges. The nearest
  /// feature of a point therefore has a total of at least 1. With equal coefficients the sum is the mean of
  /// those with and without the operator.
  double edge_coefficient(int e, double dhat) const;
  double vertex_coefficient(int v, double dhat) const;

 private:
  Bend made_edge(int e) const;
  Bend made_vertex(int v) const;
  /// The bend of the rim that two edges are at the vertex where they meet; flat if it is straight.
  Bend rim_bend(int v, int e, int f) const;
  double triangle_area(int t) const;
  /// The triangles of an edge beyond one.
  int further(int e) const { return surface_.topology->edge_corners.size(e) - 1; }
  /// The part of an edge's coefficient that its curvature leaves.
  double unreduced(int e, double dhat) const;

  const ObstacleSurface& surface_;
  mutable std::vector<Bend> edges_, vertices_;  // their area is 0 until they are made
};

}  // namespace drape

#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "core/kernel/interfaces/element_order.h"
#include "core/kernel/interfaces/topology.h"
#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape {

/// One resolution of one cloth: its rest shape, what depends on it alone, and a softening. Immutable.
struct Level {
  int index = 0;                 ///< 0 is the coarsest
  TriangleMesh rest;             ///< positions X_l [m] and triangles; rest_corners has their shapes at rest
  Topology topology;             ///< of rest.triangles
  Eigen::VectorXd vertex_area;   ///< n, a third of the adjacent rest areas [m²]
  Stencils hinges;               ///< h×4, topology.hinges
  std::vector<int> hinge_edges;  ///< the edge of each hinge
  ElementOrder triangle_order;   ///< summation order for energies of triangles
  ElementOrder hinge_order;      ///< summation order for energies of hinges
  /// m, factors on the stiffness of a membrane's triangles [1], as a coarse level has them at lone pins
  /// (Energy::bind_buckling); empty: all are 1.
  Eigen::VectorXd softening;
  Eigen::VectorXd bound_factors;    ///< m, on the bound s of Energy::bind_buckling [1]; empty: all are 1
  std::vector<int> cloth_vertices;  ///< the cloth's own vertex that each is, on a level coarser than its mesh
  std::vector<int> own_vertices;    ///< the vertex that stands for each of the cloth's own, on such a level

  /// Builds a level from `rest`, which must have passed check_mesh.
  static Level of(int index, TriangleMesh rest);

  int vertex_count() const { return static_cast<int>(rest.vertices.rows()); }
  double bound_factor(int t) const { return bound_factors.size() > 0 ? bound_factors[t] : 1; }
  int cloth_vertex(int v) const { return cloth_vertices.empty() ? v : cloth_vertices[v]; }
  int cloth_vertex_count() const { return std::max(vertex_count(), static_cast<int>(own_vertices.size())); }
  int own_vertex(int v) const { return own_vertices.empty() ? v : own_vertices[v]; }
  int triangle_count() const { return static_cast<int>(rest.triangles.rows()); }
};

}  // namespace drape

#pragma once

#include <Eigen/Core>

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

  /// Builds a level from `rest`, which must have passed check_mesh.
  static Level of(int index, TriangleMesh rest);

  int vertex_count() const { return static_cast<int>(rest.vertices.rows()); }
  int triangle_count() const { return static_cast<int>(rest.triangles.rows()); }
};

}  // namespace drape

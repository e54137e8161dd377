#pragma once

#include <Eigen/Core>

#include "core/kernel/interfaces/level.h"
#include "core/kernel/interfaces/material.h"
#include "core/kernel/interfaces/topology.h"

namespace drape {

/// Change of every triangle's shape operator as a linear function of the mesh's dihedral angles: s = Σ weight
/// (θ - θ̄) over the terms of triangle t, with bending energy ‖s‖².
struct ShapeOperators {
  struct Term {
    int hinge;               ///< row of Level::hinges
    Eigen::Vector3d weight;  ///< [√J]
  };
  Grouped<Term> terms;  ///< of each triangle
  /// ‖s‖² [J] of each hinge's two triangles, over (θ - θ̄)², if all other angles stay at rest and no border
  /// gives way.
  Eigen::VectorXd lone_folds;

  /// For the energy Ā k ((1 - ν) tr S² + ν (tr S)²) of a triangle with rest area Ā and shape operator S, or
  /// with the material's rigidity by direction Ā (½ c11 S11² + ½ c22 S22² + c12 S11 S22 + 2 c66 S12²), from
  /// normals at its edge midpoints: S = 1/Ā Σ l φ n nᵀ, with the edge's length l, its normal n in the
  /// triangle's plane, and the angle φ about the edge from the triangle's normal to the edge's.
  ///
  /// φ is half the dihedral angle plus a correction from the angles at the edge and at the other edges of its
  /// two triangles. The correction has the smallest weights that make φ exact for all quadratic surfaces over
  /// the rest shape; it vanishes on regular meshes, and is dropped if no weight exceeds `tolerance`. φ at a
  /// border edge minimises the triangle's energy: no moment acts there.
  static ShapeOperators of(const Level& level, const Material& material, double tolerance);
};

/// Friction between the yarns of a bent cloth, as on first loading: a strip of rigidity B has the moment B κ
/// + HB κ / √(κ² + κ0²), half the width of its hysteresis loop above the elastic one (Grosberg 1966, with the
/// jump at κ = 0 spread over κ0). In other bends the friction is that of the strip with the same elastic
/// energy q: together they have the energy q + f (√(q + q0) - √q0). Not of that model: a cloth that bends
/// back loses none.
struct BendingFriction {
  double f = 0;   ///< HB √(2/B), for each √ of area [√J/m]
  double q0 = 0;  ///< B κ0²/2 [J/m²]

  /// κ0 in 1/m.
  static BendingFriction of(const Material& material, double sliding_curvature);
};

}  // namespace drape

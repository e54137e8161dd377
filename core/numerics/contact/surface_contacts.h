#pragma once

#include "core/numerics/collision_detection/dihedrals.h"
#include "core/numerics/contact/collisions.h"

namespace drape {

/// A cloth vertex and an obstacle triangle that may come within d̂.
struct VertexTriangleCandidate {
  int vertex, triangle;
};

/// A feature of the obstacles' surface (interior of a triangle, interior of an edge, or vertex) that contains
/// the point nearest to a cloth vertex p of one or more triangles, edges and vertices.
struct NearestFeature {
  std::array<int, 3> vertices;  ///< the feature's obstacle vertices, padded with -1
  Eigen::Vector3d weights;      ///< barycentric coordinates of the nearest point
  Eigen::Vector3d normal;       ///< unit vector from there to p
  Eigen::Vector3d along;        ///< unit direction of an edge; 0 for other features
  double distance;              ///< [m]
  double coefficient;           ///< sum of the coefficients with their nearest point here, never 0
  double area;                  ///< the cloth vertex's at rest [m²]
  double friction;              ///< μ
  int body;                     ///< the obstacle

  bool is_face() const { return vertices[2] >= 0; }
};

/// A cloth vertex and the nearest features within d̂ of it, at least one, with the barrier
/// κ d̂ area Σ_features coefficient · b(distance / d̂) (BarrierCollisions).
struct SurfaceContact {
  int vertex;
  std::vector<NearestFeature> features;

  static constexpr int columns = 1;
  std::array<int, 4> vertices() const { return {vertex, -1, -1, -1}; }
  int count() const { return static_cast<int>(features.size()); }
  double gap() const { return std::ranges::min(features, {}, &NearestFeature::distance).distance; }
  void add_energy(const BarrierParameters& p, double& sum) const;
  static double unit(const BarrierParameters& p) { return p.stiffness * p.dhat; }
  void add_gradient(const BarrierParameters& p, Positions& g) const;
  static void hessians(std::span<const SurfaceContact> contacts, const BarrierParameters& p,
                       Projection projection, ContactBlocks<1>* blocks);
  /// A negative coefficient takes a force away that other features of the surface count twice.
  void add_normal_forces(const BarrierParameters& p, NormalForces& forces) const;
  void append_friction(const BarrierParameters& p, std::vector<FrictionContact>& all) const;

  /// The features' normal forces over κ, non-negative [m²]. The force of a feature with a negative
  /// coefficient is subtracted from the features with the most similar normals.
  std::vector<double> pressures(double dhat) const;
};

/// The surface contacts of the cloth at x (n×3) [m]. `candidates` must be contiguous for each vertex and
/// ascending by triangle; `friction` is μ where an obstacle has none of its own. A surface has no inside: of
/// a body thinner than d̂ the faces on the far side are contacts too.
std::vector<SurfaceContact> find_surface_contacts(const Positions& x, const ObstacleSurface& obstacles,
                                                  const Dihedrals& dihedrals,
                                                  const std::vector<VertexTriangleCandidate>& candidates,
                                                  const Eigen::VectorXd& vertex_area, double friction,
                                                  double dhat);

}  // namespace drape

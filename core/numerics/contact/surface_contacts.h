#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "core/kernel/interfaces/contact_model.h"
#include "core/kernel/interfaces/topology.h"
#include "core/numerics/collision_detection/dihedrals.h"
#include "core/numerics/collision_detection/obstacle_surface.h"
#include "core/numerics/contact_forces/barrier.h"

namespace drape {

/// A cloth vertex and an obstacle triangle that may come within d̂.
struct VertexTriangleCandidate {
  int vertex, triangle;
};

/// A feature of the obstacles' surface (interior of a triangle, interior of an edge, or vertex) that contains
/// the point nearest to a cloth vertex p of one or more triangles, edges and vertices.
struct NearestFeature {
  int cloth_vertex;
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

/// The nearest features within d̂ of the cloth's vertices, a row for each vertex that has any.
using SurfaceContacts = Grouped<NearestFeature>;

/// The surface contacts of the cloth at x (n×3) [m]. `candidates` must be contiguous for each vertex and
/// ascending by triangle; `friction` is μ where an obstacle has none of its own. A surface has no inside: of
/// a body thinner than d̂ the faces on the far side are contacts too.
SurfaceContacts find_surface_contacts(const Positions& x, const ObstacleSurface& obstacles,
                                      const OperatorCoefficients& coefficients,
                                      const std::vector<VertexTriangleCandidate>& candidates,
                                      const Eigen::VectorXd& vertex_area, double friction, double dhat);

/// The normal forces over κ of one vertex's features, non-negative [m²]. The force of a feature with a
/// negative coefficient is subtracted from the features with the most similar normals.
std::vector<double> pressures_of(std::span<const NearestFeature> features, double dhat);

/// The barrier κ d̂ Σ_vertices area Σ_features coefficient · b(distance / d̂). Its Hessian has one 3×3 block
/// per vertex, which is projected.
std::unique_ptr<Collisions> make_surface_contacts(SurfaceContacts contacts,
                                                  const BarrierParameters& parameters);

}  // namespace drape

#pragma once

#include <memory>
#include <vector>

#include "core/kernel/interfaces/contact_model.h"
#include "core/numerics/contact/nearest_features.h"
#include "core/numerics/contact_forces/barrier.h"

namespace drape {

/// A cloth vertex in contact with the obstacles' surface.
struct SurfaceContact {
  int vertex;
  double weight;    ///< the vertex's rest area [m²]
  int first, last;  ///< range [first, last) of its features
};

/// The cloth vertices within d̂ of the obstacles, with their nearest features.
struct SurfaceContacts {
  std::vector<SurfaceContact> contacts;
  std::vector<NearestFeature> features;

  /// Those of the cloth at x (n×3) [m]. `candidates` must be contiguous for each vertex and ascending by
  /// triangle; `friction` is μ where an obstacle has none of its own.
  static SurfaceContacts of(const Positions& x, const ObstacleSurface& obstacles,
                            const OperatorCoefficients& coefficients,
                            const std::vector<VertexTriangleCandidate>& candidates,
                            const Eigen::VectorXd& vertex_area, double friction, double dhat);

  /// A contact's normal forces over κ, per feature and non-negative [m²]. The force of a feature with a
  /// negative coefficient is subtracted from the features with the most similar normals.
  std::vector<double> pressures(const SurfaceContact& contact, double dhat) const;
};

/// The barrier κ d̂ Σ_contacts weight Σ_features coefficient · b(distance / d̂). Its Hessian has one 3×3 block
/// per vertex, which is projected.
std::unique_ptr<Collisions> make_surface_contacts(SurfaceContacts contacts,
                                                  const BarrierParameters& parameters);

}  // namespace drape

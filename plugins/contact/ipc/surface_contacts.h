#pragma once

#include <memory>
#include <vector>

#include "core/contact/pair_contacts.h"
#include "plugins/contact/ipc/nearest_features.h"

namespace drape {

/// The features of one vertex of the cloth.
struct SurfaceContact {
  int vertex;
  double weight;    ///< its area [m²]
  int first, last;  ///< its features are [first, last)
};

/// Cloth vertices within range of the obstacles, and what they see of them.
struct SurfaceContacts {
  std::vector<SurfaceContact> contacts;
  std::vector<NearestFeature> features;

  /// `near` is ascending by triangle for each vertex, whose entries follow each other.
  static SurfaceContacts of(const Positions& x, const Obstacles& obstacles,
                            const OperatorCoefficients& coefficients, const std::vector<NearTriangle>& near,
                            const Eigen::VectorXd& vertex_area, double friction, double range);

  /// A contact's normal forces over κ, by feature, none below 0 [m²]: what a feature with a negative
  /// coefficient takes away is taken from those whose normals are most like its own.
  std::vector<double> pressures(const SurfaceContact& contact, double range) const;
};

/// The barrier κ d̂ Σ_contacts weight Σ_features coefficient · b(distance / d̂). Its Hessian is a 3×3 block a
/// vertex, projected as a whole.
std::unique_ptr<ContactSet> make_surface_contacts(SurfaceContacts contacts,
                                                  const BarrierParameters& parameters);

}  // namespace drape

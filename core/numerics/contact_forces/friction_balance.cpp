#include "core/numerics/contact_forces/friction_balance.h"

#include <algorithm>
#include <cmath>

namespace drape {

namespace {

using Eigen::Vector3d;

/// Sweeps over the contacts after which the lower bound decides.
constexpr int max_sweeps = 2000;
/// Over-relaxation: forces that pass through layers of cloth need fewer sweeps.
constexpr double relaxation = 1.5;

/// One contact's friction force, which changes the forces of its free vertices.
struct FrictionForce {
  const FrictionContact& contact;
  double squares;                     // Σ c_k² over its free vertices
  Vector3d force = Vector3d::Zero();  // on the side where c is positive [N]

  /// The part in the tangent plane of Σ c_k r_k: the derivative of ½ ‖r‖² by `force` [N].
  Vector3d slope(const Positions& r) const {
    Vector3d sum = Vector3d::Zero();
    for (int k = 0; k < 4; ++k)
      if (const int v = contact.vertices[k]; v >= 0) sum += contact.c[k] * r.row(v).transpose();
    return sum - contact.normal.dot(sum) * contact.normal;
  }

  /// Moves `force` to the one in its disc with the smallest ‖r‖, and beyond by the over-relaxation.
  void relax(const std::vector<char>& fixed, Positions& r) {
    Vector3d next = force - relaxation / squares * slope(r);
    if (const double length = next.norm(); length > contact.force) next *= contact.force / length;
    for (int k = 0; k < 4; ++k)
      if (const int v = contact.vertices[k]; v >= 0 && !fixed[v])
        r.row(v) += contact.c[k] * (next - force).transpose();
    force = next;
  }
};

}  // namespace

double norm_beyond_friction(const std::vector<FrictionContact>& contacts, Positions forces,
                            const std::vector<char>& fixed, double enough) {
  for (Eigen::Index v = 0; v < forces.rows(); ++v)
    if (fixed[v]) forces.row(v).setZero();
  std::vector<FrictionForce> frictions;
  for (const FrictionContact& contact : contacts) {
    double squares = 0;
    for (int k = 0; k < 4; ++k)
      if (const int v = contact.vertices[k]; v >= 0 && !fixed[v]) squares += contact.c[k] * contact.c[k];
    if (contact.force > 0 && squares > 0) frictions.push_back({contact, squares});
  }
  double at_least = 0;  // the minimum is not below this, by the duality gap of the convex problem
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    const double norm = forces.norm();
    if (!(norm > enough)) return norm;
    double gap = 0;
    for (const FrictionForce& f : frictions) {
      const Vector3d slope = f.slope(forces);
      gap += f.force.dot(slope) + f.contact.force * slope.norm();
    }
    at_least = std::sqrt(std::max(0.0, norm * norm - 2 * gap));
    if (at_least > enough) return norm;
    for (FrictionForce& f : frictions) f.relax(fixed, forces);
  }
  return at_least;
}

}  // namespace drape

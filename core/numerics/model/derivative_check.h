#pragma once

#include <algorithm>
#include <string>

#include "core/kernel/interfaces/energy.h"

namespace drape {

/// The largest difference between a derivative and its finite difference, and where it is.
struct DerivativeError {
  double error = 0;  ///< relative to the largest entry of the finite differences [1]; +∞ where not finite
  int row = 0;       ///< 3 i + c: coordinate c of vertex i
  int column = 0;    ///< as `row`; 0 for gradients
};

struct DerivativeCheck {
  DerivativeError gradient;  ///< against differences of value()
  DerivativeError hessian;   ///< against differences of add_gradient(), without projection
  double asymmetry = 0;      ///< of a finite Hessian's diagonal blocks, relative to its largest entry [1]

  /// The largest of the three.
  double worst() const { return std::max({gradient.error, hessian.error, asymmetry}); }
  bool agrees() const { return worst() <= 1e-5; }
  /// Two lines that say how large the errors are, and at which vertices.
  std::string text() const;
};

/// The level on which an energy is checked unless there is another: four flat square cells of 1 cm.
Level checked_level();
/// The level's rest shape stretched, sheared and bent (n×3) [m].
Positions checked_state(const Level& level);

/// Compares an energy's derivatives at x (n×3) [m] with central differences of fourth order, step h [m].
/// Takes 24 n evaluations and (3n)² numbers: for small meshes. A gradient that is not finite at x differs,
/// and leaves the Hessian unchecked. Throws std::runtime_error if the energy is not finite at x or near it,
/// if add_gradient does not add, or if it returns another number than value().
DerivativeCheck check_derivatives(const BoundEnergy& energy, const Positions& x, double h);

/// Checks the energy on the checked level with a step of 1e-5 m. Where the derivatives do not agree, repeats
/// that with a tenth and a hundredth of it, since differences of a law that curves strongly need short steps,
/// and returns the best. Throws as the function above does.
DerivativeCheck check_derivatives(const Energy& energy, const Material& material);

/// The largest force of the energy at the checked level's rest shape, over that at the checked state [1]; 0
/// but for round-off of an energy that the rest shape is an equilibrium of.
double relative_force_at_rest(const Energy& energy, const Material& material);

}  // namespace drape

#pragma once

#include "core/kernel/model/energy.h"

namespace drape {

/// The largest difference between a derivative and its finite difference, and where it is.
struct DerivativeError {
  double error = 0;  ///< relative to the largest entry of the finite differences [1]
  int row = 0;       ///< 3 i + c: coordinate c of vertex i
  int column = 0;    ///< likewise; of Hessians alone
};

struct DerivativeCheck {
  DerivativeError gradient;  ///< against differences of value()
  DerivativeError hessian;   ///< against differences of add_gradient(), without projection
  double asymmetry = 0;      ///< of the Hessian's diagonal blocks, relative to its largest entry [1]
};

/// Compares an energy's derivatives at x (n×3) [m] with central differences of fourth order, step h [m].
/// Takes 24 n evaluations and (3n)² numbers: for small meshes. Throws std::runtime_error if the energy is not
/// finite near x, if add_gradient does not add, or if it returns another number than value().
DerivativeCheck check_derivatives(const BoundEnergy& energy, const Positions& x, double h);

}  // namespace drape

#pragma once

#include <memory>

#include "core/numerics/elements/jet.h"
#include "plugins/energy/formula/law.h"
#include "plugins/energy/formula/program.h"

namespace drape::formula {

/// What a triangle's formula is derived by.
enum class TriangleVariables {
  strains,    ///< g11, g22, g12; for formulas without principal stretches
  stretches,  ///< s1, s2, of which strains along the principal axes are functions too; for buckling
  both        ///< all five; for formulas with principal stretches
};

/// The programs of a formula. Outputs: `value` has the energy [J]; `gradient` the energy, then its
/// derivatives by the variables; `hessian` the first derivatives, then the second, ordered as in Jet; `all`
/// the energy, then those.
struct Programs {
  Program value, gradient, hessian, all;
  bool is_linear = false;  ///< all second derivatives are 0
};

/// Compiles a triangle's formula. Throws std::length_error for one that is too large.
Programs compile_triangle(const Law& law, const Material& material, TriangleVariables variables);
/// A hinge's, derived by `bend`.
Programs compile_hinge(const Law& law, const Material& material);
/// A vertex's, derived by x, y and z.
Programs compile_vertex(const Law& law, const Material& material);

}  // namespace drape::formula

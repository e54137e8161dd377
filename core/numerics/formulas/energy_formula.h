#pragma once

#include "core/kernel/plugin/plugin.h"
#include "core/numerics/formulas/element_formula.h"
#include "core/numerics/formulas/fold_formula.h"
#include "core/numerics/formulas/membrane_formula.h"
#include "core/numerics/formulas/vertex_formula.h"

// An energy is a formula. One file with one of these is a plugin (docs/extend/add-an-energy.md):
//
//     DRAPE_MEMBRANE(stvk, "St. Venant–Kirchhoff membrane.") {
//       return thickness * (mu * (g11 * g11 + g22 * g22 + 2 * g12 * g12) + lambda / 2 * square(g11 + g22));
//     }
//
// Derivatives, projection, role, midpoint factor and buckling follow. The body is evaluated on jets of SIMD
// packs: no `if` on a symbol of the element but select(condition, a, b), min, max; functions are those of
// core/numerics/elements/jet_functions.h. A third argument is the struct of the energy's parameters, whose
// members the body uses by their names. The material's symbols are those of MaterialSymbols.

/// A membrane: returns the energy of a unit of rest area [J/m²] by Green strains g11, g22 (along warp and
/// weft) and g12, or by the principal stretches s1 ≥ s2, and by J, the ratio of areas; `area` [m²] and the
/// centroid u, v, w [m] are the triangle's at rest.
#define DRAPE_MEMBRANE(name, summary, ...)                                                                  \
  DRAPE_FORMULA(MembraneFormula, name, summary,                                                             \
                ([[maybe_unused]] const S& g11, [[maybe_unused]] const S& g22,                              \
                 [[maybe_unused]] const S& g12, [[maybe_unused]] const S& s1, [[maybe_unused]] const S& s2, \
                 [[maybe_unused]] const drape::AreaRatio<S>& J, [[maybe_unused]] const T& area,             \
                 [[maybe_unused]] const T& u, [[maybe_unused]] const T& v, [[maybe_unused]] const T& w),    \
                __VA_ARGS__)

/// A bending energy: returns the energy of an inner edge [J] by its angle `theta` and `bend`, the turn from
/// `rest`, the angle at rest; `length`, heights h1 and h2 [m], `area` [m²] of both triangles and the midpoint
/// u, v, w [m] are at rest.
#define DRAPE_FOLD(name, summary, ...)                                                                       \
  DRAPE_FORMULA(FoldFormula, name, summary,                                                                  \
                ([[maybe_unused]] const S& theta, [[maybe_unused]] const S& bend,                            \
                 [[maybe_unused]] const T& rest, [[maybe_unused]] const T& length,                           \
                 [[maybe_unused]] const T& h1, [[maybe_unused]] const T& h2, [[maybe_unused]] const T& area, \
                 [[maybe_unused]] const T& u, [[maybe_unused]] const T& v, [[maybe_unused]] const T& w),     \
                __VA_ARGS__)

/// A load: returns the energy of a vertex [J] by its position x, y, z [m]; u, v, w [m] is its rest position,
/// `area` [m²] a third of the rest area around it, `mass` [kg] the mass of that.
#define DRAPE_VERTEX(name, summary, ...)                                                                \
  DRAPE_FORMULA(VertexFormula, name, summary,                                                           \
                ([[maybe_unused]] const S& x, [[maybe_unused]] const S& y, [[maybe_unused]] const S& z, \
                 [[maybe_unused]] const T& u, [[maybe_unused]] const T& v, [[maybe_unused]] const T& w, \
                 [[maybe_unused]] const T& area, [[maybe_unused]] const T& mass),                       \
                __VA_ARGS__)

/// An energy of `shape`, which is edges, triangles or hinges: returns J of an element by d[i], the vectors
/// from its first vertex to its others [m]; rest[i] are those at rest. Both are Eigen's: d[0].norm(),
/// d[0].cross(d[1]), d[0].dot(rest[0]). A triangle has two; a hinge three, to the other end of its edge and
/// to the two vertices opposite it.
#define DRAPE_ELEMENT(name, shape, summary, ...)                                          \
  DRAPE_FORMULA(ElementFormulaOf<drape::elements::shape>::Energy, name, summary,          \
                ([[maybe_unused]] const drape::Vectors<S, drape::elements::shape>& d,     \
                 [[maybe_unused]] const drape::Vectors<T, drape::elements::shape>& rest), \
                __VA_ARGS__)

#define DRAPE_FORMULA(energy, name, summary, symbols, ...)                             \
  namespace drape::formulas {                                                          \
  struct name : FormulaLaw<__VA_ARGS__> {                                              \
    using FormulaLaw<__VA_ARGS__>::FormulaLaw;                                         \
    template <class S, class T>                                                        \
    S operator() symbols const;                                                        \
  };                                                                                   \
  }                                                                                    \
  DRAPE_PLUGIN(registry) {                                                             \
    registry.add<drape::Energy, drape::energy<drape::formulas::name>>(#name, summary); \
  }                                                                                    \
  template <class S, class T>                                                          \
  inline S drape::formulas::name::operator() symbols const

/// Where the bodies of formulas stand: what they call for plain numbers, and vectors of S or T.
namespace drape::formulas {
using std::abs, std::acos, std::asin, std::atan, std::atan2, std::cos, std::cosh, std::exp, std::expm1,
    std::log, std::log1p, std::max, std::min, std::pow, std::sin, std::sinh, std::sqrt, std::tan, std::tanh;
template <class T>
using Vector = Eigen::Matrix<T, 3, 1>;
}  // namespace drape::formulas

#include "core/numerics/formulas/energy_formula.h"

// docs/theory/method.md, section 5. +∞ if a triangle degenerates.
DRAPE_MEMBRANE(neo_hookean, "Neo-Hookean membrane in plane stress; resists collapse of triangles.") {
  const S log_j = log(J);
  return thickness * (mu * (g11 + g22 - log_j) + lambda / 2 * log_j * log_j);
}

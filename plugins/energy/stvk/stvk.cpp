#include "core/numerics/formulas/energy_formula.h"

// docs/theory/method.md, section 5. Finite everywhere.
DRAPE_MEMBRANE(stvk,
               "St. Venant–Kirchhoff membrane; cheap, right for small strains, weak under compression.") {
  return thickness * (mu * (g11 * g11 + g22 * g22 + 2 * g12 * g12) + lambda / 2 * square(g11 + g22));
}

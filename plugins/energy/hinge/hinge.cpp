#include "core/numerics/formulas/energy_formula.h"

// Discrete shells (docs/theory/method.md, section 5), with `rest` from the rest shape.
DRAPE_FOLD(hinge, "Bending by the angles between triangles, any rest shape.") {
  return 3 * k * length * length / area * bend * bend;
}

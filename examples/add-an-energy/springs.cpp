#include "core/numerics/formulas/energy_formula.h"

DRAPE_PARAMETERS(Springs, (stiffness, 20, "N", 0, 1e9, "force that doubles the length"));

DRAPE_ELEMENT(springs, edges, "Springs along the edges of the mesh.", Springs) {
  const T length = rest[0].norm();
  return 0.5 * stiffness * length * square(d[0].norm() / length - 1);
}

#include "core/numerics/formulas/energy_formula.h"

struct Springs {
  double stiffness = 20;
  static void declare(drape::Declaration<Springs>& d) {
    d.add("stiffness", &Springs::stiffness)
        .unit("N")
        .at_least(0)
        .at_most(1e9)
        .description("force that doubles the length");
  }
};

DRAPE_ELEMENT(springs, edges, "Springs along the edges of the mesh.", Springs) {
  const T length = rest[0].norm();
  return 0.5 * stiffness * length * square(d[0].norm() / length - 1);
}

#include "core/numerics/formulas/energy_formula.h"

struct SpringToPlane {
  static constexpr auto role = drape::EnergyRole::position;
  double stiffness = 100, height = 0;
  static void declare(drape::Declaration<SpringToPlane>& d) {
    d.add("stiffness", &SpringToPlane::stiffness, "spring constant of a unit of mass")
        .unit("1/s²")
        .above(0)
        .at_most(1e9);
    d.add("height", &SpringToPlane::height, "z of the plane").unit("m").between(-1e3, 1e3);
  }
};

DRAPE_VERTEX(spring_to_plane, "Springs to a horizontal plane.", SpringToPlane) {
  return 0.5 * stiffness * mass * square(z - height);
}

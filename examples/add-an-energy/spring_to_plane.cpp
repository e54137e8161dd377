#include "core/numerics/formulas/energy_formula.h"

struct SpringToPlane {
  static constexpr auto role = drape::EnergyRole::position;
  double stiffness = 100, height = 0;
  static void declare(drape::Declaration<SpringToPlane>& d) {
    d.add("stiffness", &SpringToPlane::stiffness)
        .unit("1/s²")
        .above(0)
        .at_most(1e9)
        .description("spring constant of a unit of mass");
    d.add("height", &SpringToPlane::height)
        .unit("m")
        .at_least(-1e3)
        .at_most(1e3)
        .description("z of the plane");
  }
};

DRAPE_VERTEX(spring_to_plane, "Springs to a horizontal plane.", SpringToPlane) {
  return 0.5 * stiffness * mass * square(z - height);
}

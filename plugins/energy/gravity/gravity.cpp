#include "core/numerics/formulas/energy_formula.h"

struct Gravity {
  Eigen::Vector3d acceleration{0, 0, -9.81};
  static void declare(drape::Declaration<Gravity>& d) {
    d.add("acceleration", &Gravity::acceleration, "acceleration of free fall")
        .unit("m/s²")
        .between(-1e7, 1e7)
        .source("standard gravity, rounded; z is up");
  }
};

DRAPE_VERTEX(gravity, "Weight of the cloth.", Gravity) {
  return -mass * (acceleration.x() * x + acceleration.y() * y + acceleration.z() * z);
}

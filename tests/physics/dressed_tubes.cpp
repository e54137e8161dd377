// A tube that is dressed on a cylinder wider than itself: tension, pressure and stretch in closed form.

#include "core/numerics/elements/orthotropic_stiffness.h"
#include "core/numerics/elements/stretch.h"
#include "tests/support/known_answers.h"
#include "tests/support/solve.h"
#include "tests/support/tube_dress.h"

using namespace drape;

namespace {

/// Means over the tube without its borders.
struct Worn {
  double around = 0, along = 0;  ///< stretches
  double pressure = 0;           ///< on the body [Pa]
  double radius = 0;             ///< of the cloth [m]
};

Worn measured(const Solved& s, const TubeDress& tube) {
  Worn worn;
  const Level& level = s.level();
  double area = 0;
  const auto is_inner = [&](int v) { return std::abs(level.rest.vertices(v, 2)) < tube.height / 4; };
  for (int t = 0; t < level.triangle_count(); ++t) {
    const auto v = level.rest.triangles.row(t);
    if (!is_inner(v[0]) || !is_inner(v[1]) || !is_inner(v[2])) continue;
    const PrincipalStretch<double> stretch = RestTriangle::of(level, t).stretch(
        s.x().row(v[1]) - s.x().row(v[0]), s.x().row(v[2]) - s.x().row(v[0]));
    const double own = 1;  // all are equal at rest
    worn.around += own * stretch.largest, worn.along += own * stretch.smallest, area += own;
  }
  worn.around /= area, worn.along /= area;
  const LevelModel model = s.model().with_stiffness(s.levels.back().contact_stiffness);
  const Eigen::VectorXd pressure = model.contact_pressure(s.x());
  double of_vertices = 0;
  for (int v = 0; v < level.vertex_count(); ++v)
    if (is_inner(v)) {
      const double own = level.vertex_area[v];
      worn.pressure += own * pressure[v] / (worn.around * worn.along);
      worn.radius += own * std::hypot(s.x()(v, 0), s.x()(v, 1)), of_vertices += own;
    }
  worn.pressure /= of_vertices, worn.radius /= of_vertices;
  return worn;
}

}  // namespace

TEST_CASE("A tube dressed on a cylinder has the stretch, the tension and the pressure of the closed form") {
  table("Tube on a cylinder", "cloth", "stretch around", "along", "pressure [Pa]", "closed form", "error");
  const TubeDress tube{.columns = 32, .rows = 13};
  for (const bool woven : {false, true}) {
    const Scratch folder;
    tube.write(folder,
               woven ? "material: {density: 300, thickness: 5e-4, warp_stiffness: 500, weft_stiffness: "
                       "200, shear_stiffness: 60, poisson_ratio: 0.2, warp_bending: 1e-6}\n"
                       "energies: [woven, hinge, {type: gravity, acceleration: [0, 0, -0.2]}]\n"
                     : "material: {density: 300, thickness: 5e-4, membrane_modulus: 4e5, poisson_ratio: "
                       "0.3, bending_modulus: 1e5}\n"
                       "energies: [stvk, hinge, {type: gravity, acceleration: [0, 0, -0.2]}]\n");
    const Solved s = solved(experiment_in(folder / "e.yaml"));
    INFO(s.levels[0].message);
    REQUIRE(s.levels[0].outcome == Outcome::converged);
    for (const auto& contact : s.model().contacts()) CHECK(contact->intersections(s.x()).empty());
    const Worn worn = measured(s, tube);
    // Around, the cloth is as long as the circle that it lies on. Along, it is free: no stress but
    // friction's.
    const double around = 2 * M_PI * worn.radius / (2 * tube.width);
    const double strain = (around * around - 1) / 2;
    const Material& m = s.model().material();
    const double weft = woven ? membrane_stiffness(m).strip(M_PI / 2) : m.membrane_modulus * m.thickness;
    const double tension = around * weft * strain / worn.along;  // per length of the worn tube [N/m]
    CHECK(worn.around == Approx(around).epsilon(0.01));
    CHECK(worn.pressure == Approx(tension / worn.radius).epsilon(0.01));
    row(woven ? "woven" : "stvk", worn.around, worn.along, worn.pressure, tension / worn.radius,
        worn.pressure * worn.radius / tension - 1);
  }
}

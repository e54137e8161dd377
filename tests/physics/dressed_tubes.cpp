// A tube that is dressed on a cylinder wider than itself: tension, pressure and stretch in closed form.

#include "core/app/run/garment_pieces.h"
#include "core/app/view/surface_fields.h"
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
      worn.pressure += own * pressure[v];
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

TEST_CASE("Each piece of a dressed tube has its own stretch and the pressure of its tension") {
  table("Stiff and soft panel on a cylinder", "piece", "stretch around [%]", "closed form", "pressure [kPa]",
        "T / R");
  const TubeDress tube{.columns = 32, .rows = 13};
  const Scratch folder;
  tube.write(folder,
             "material: {density: 300, thickness: 5e-4, warp_stiffness: 2000, weft_stiffness: 200, "
             "shear_stiffness: 60, poisson_ratio: 0, warp_bending: 1e-6}\n"
             "energies: [woven, hinge, {type: gravity, acceleration: [0, 0, -0.2]}]\n");
  // Warp runs around in the back.
  const Solved s = solved(experiment_in(
      folder / "e.yaml",
      {{"cloth.grain_regions", "[{lower: [-1, 0, -1], upper: [1, 1, 1], grain: 90}]"}, {"friction", "0"}}));
  INFO(s.levels[0].message);
  REQUIRE(s.levels[0].outcome == Outcome::converged);
  const LevelModel model = s.model().with_stiffness(s.levels.back().contact_stiffness);
  const Json pieces =
      garment_pieces(s.level(), s.x(), garment_fields_at(s.level(), s.x(), model.obstacles()).back().values,
                     model.contact_pressure(s.x()));
  // The stiff panel by the share e of the soft one's tension Y e (1 + e / 2) (1 + e): both together are as
  // long as the circle on which they lie.
  const double ease = pieces[0]["ease"].get<double>() / 1000, radius = tube.radius + ease;
  const auto tension = [](double y, double e) { return y * e * (1 + e / 2) * (1 + e); };
  const auto bisected = [](const auto& f) {  // f rises
    double low = 0, high = 1;
    while (high - low > 1e-12) (f((low + high) / 2) < 0 ? low : high) = (low + high) / 2;
    return low;
  };
  const auto stiff_of = [&](double soft) {
    return bisected([&](double e) { return tension(2000, e) - tension(200, soft); });
  };
  const double soft =
      bisected([&](double e) { return tube.width * (2 + e + stiff_of(e)) - 2 * M_PI * radius; });
  REQUIRE(soft > 0.15);
  const double expected = tension(200, soft) / radius / 1000;
  for (const auto& [piece, field, stretch] :
       {std::tuple(pieces[0], "stretch_weft", soft), {pieces[1], "stretch_warp", stiff_of(soft)}}) {
    row(piece["piece"].get<std::string>(), piece[field].get<double>(), 100 * stretch,
        piece["pressure"].get<double>(), expected);
    CHECK(piece[field].get<double>() == Approx(100 * stretch).epsilon(0.01));
    CHECK(piece["pressure"].get<double>() == Approx(expected).epsilon(0.01));
    CHECK(piece["largest_" + std::string(field)].get<double>() < 102 * stretch);  // none of the other panel's
    CHECK(piece[std::string(field) + "_95"] < piece["largest_" + std::string(field)]);
  }
}

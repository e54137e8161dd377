// Ends are minima: what buckles, wrinkles or snaps does so from a start that hides it, an exactly symmetric
// one without noise.

#include <catch2/catch.hpp>

#include "tests/support/any_threads.h"
#include "tests/support/keeping_observer.h"
#include "tests/support/symmetric_scenes.h"

using namespace drape;

namespace {

/// Euler's column under a fraction of its critical load π² D w / 4L², exactly straight: D = L = 1.
std::string column(double fraction) {
  const ClampedStrip strip{64, 2};
  const double width = strip.across * strip.cell(), load = fraction * M_PI * M_PI / 4 * width;
  return strip.yaml(width, filled("triangulation: criss_cross, columns: $, rows: 3", strip.cells + 1),
                    filled("membrane_modulus: 1e8, bending_modulus: $, poisson_ratio: 0",
                           12 / std::pow(ClampedStrip::thickness, 3)),
                    "neo_hookean, midedge_bending, " + end_load(strip.length(), width, {-load, 0, 0}),
                    newton_to(1e-6, 2000));
}

/// A plate of ν = 0 between two clamped ends, pushed together to a fraction of the strain at which it
/// buckles, 4π² D / (E d L²). Clamped by pairs of columns: the free length is between their middles.
std::string pushed_plate(double fraction) {
  const int cells = 64;
  const double length = 0.1, cell = length / (cells - 1), thickness = 5e-4, modulus = 1e6, bending = 1e6;
  const double strain = 4 * M_PI * M_PI * bending * thickness * thickness / 12 / modulus / (length * length);
  const double whole = cells * cell;
  return experiment(
      R"(cloth: {shape: rectangle, size: [$, 0.05], triangulation: criss_cross, columns: $, rows: 33}
material: {density: 1000, thickness: $, membrane_modulus: $, bending_modulus: $, poisson_ratio: 0}
pins:
  - {region: box, lower: [-1, -1, -1], upper: [$, 1, 1]}
  - {region: box, lower: [$, -1, -1], upper: [1, 1, 1], translate: [$, 0, 0]}
energies: [neo_hookean, midedge_bending]
$)",
      whole, cells + 1, thickness, modulus, bending, 1.01 * cell, whole - 1.01 * cell,
      -fraction * strain * (whole - 2 * cell), newton_to(1e-6, 2000));
}

/// A strip on its edge, clamped at one end, under a fraction of the weight at which it buckles sideways
/// (Timoshenko), Γ = ρ g d L³ / D = 12.854 (1 − ν) √(2 (1 + ν)). Theory is for a line that does not bend in
/// its plane: at a hundred times its height and this membrane the strip carries 0.996 of the load.
std::string edge_strip(double fraction) {
  const int cells = 200, across = 2;
  const double cell = 1 / (cells - 0.5), nu = 0.25, thickness = 1e-3;
  const double critical = 12.854 * (1 - nu) * std::sqrt(2 * (1 + nu));
  return experiment(
      R"(cloth: {shape: rectangle, size: [$, $], triangulation: equilateral, vertices: $}
material: {density: 1000, thickness: $, membrane_modulus: 4e10, bending_modulus: $, poisson_ratio: $}
pins: [{region: box, lower: [-1, -1, -1], upper: [$, 1, 1]}]
energies: [neo_hookean, midedge_bending, {type: gravity, acceleration: [0, $, 0]}]
$)",
      cells * cell, across * cell, (cells + 1) * (across + 1), thickness,
      12 * (1 - nu * nu) / std::pow(thickness, 3), nu, 1.01 * cell, -fraction * critical / 1000 / thickness,
      newton_to(1e-5, 2000));
}

/// The experiment of tension field theory: pulled by 10 %, wrinkles of 0.31 to 0.36 mm.
std::string pulled_sheet(const std::string& mesh, double noise, int steps) {
  return filled(R"(name: scene
cloth: {shape: rectangle, size: [0.25, 0.1], triangulation: criss_cross, $}
levels: 2
material: {density: 1000, thickness: 1e-4, membrane_modulus: 1e6, bending_modulus: 1e6, poisson_ratio: 0.49}
start: {perturbation: $, perturbation_wavelength: 0.03}
pins: [)" + ends_of(0.25) +
                    R"(, translate: [0, 0, 0]}]
energies: [neo_hookean, midedge_bending]
methods: {pcs: {}, cascadic: {}, newton: {}}
)" + one_key("pins.1.translate", "[[0, 0, 0], [0.025, 0, 0]]", steps),
                mesh, noise);
}

}  // namespace

TEST_CASE(
    "What buckles stays flat just below its critical load, and buckles just above it, from an exactly flat "
    "start") {
  using Made = std::string (*)(double);
  table("Largest deflection [m] and lowest eigenvalue [1/s²] just below and above the critical load", "scene",
        "fraction", "deflection", "1/s²", "exits");
  struct Buckling {
    std::string name;
    Made yaml;
    double eigenvalue;  // beyond it [1/s²], solved to rounding
  };
  for (const auto& [name, yaml, eigenvalue] : {Buckling{"Euler's column", column, 0.02686},
                                               {"a pushed plate", pushed_plate, 2.335},
                                               {"a strip on its edge", edge_strip, 0.811}})
    for (const double fraction : {0.99, 1.01}) {
      INFO(name << ", " << fraction);
      const Solved s = converged(solve_yaml(yaml(fraction)));
      const double deflection = largest_entry(s.x().col(2));
      row(name, fraction, deflection, stability_of(s).lowest_eigenvalue, s.levels.back().saddles_left);
      CHECK(stability_of(s).verdict == Stability::stable);
      CHECK((s.levels.back().saddles_left > 0) == (fraction > 1));
      if (fraction < 1) {
        CHECK(deflection < 1e-9);
        continue;
      }
      CHECK(stability_of(s).lowest_eigenvalue == Approx(eigenvalue).epsilon(0.01));
      CHECK(deflection > 3e-4 * bounding_box_diagonal(s.rest()));
    }
}

TEST_CASE("A pressed dome snaps at its limit point, and its ends are minima before and after") {
  const double radius = 0.05, height = 0.006, sphere = (radius * radius + height * height) / (2 * height);
  std::string dome = rings(24, 6, true, [&](int j, double a) {
    const double r = radius * (6 - j) / 6;
    return Eigen::Vector3d(r * std::cos(a), r * std::sin(a),
                           std::sqrt(sphere * sphere - r * r) - (sphere - height));
  });
  dome += filled("v 0 0 $\n", height);
  for (int i = 0; i < 24; ++i) dome += filled("f $ $ 145\n", 121 + i, 121 + (i + 1) % 24);
  const Scratch folder;
  folder.write("dome.obj", dome);
  bool was_up = true;
  int snaps = 0;
  for (const double pressure : {1., 4., 8., 16., 32., 64.}) {
    folder.write(
        "e.yaml",
        experiment(
            "cloth: {shape: file, file: dome.obj}\n" + std::string(thin) +
                "pins: [{region: border}]\nenergies: [neo_hookean, hinge, {type: pressure, pressure: $}]\n",
            -pressure));
    const Solved s = solved(experiment_in(folder / "e.yaml"));
    INFO(pressure << " Pa");
    CHECK(s.levels.back().outcome == Outcome::converged);
    CHECK(stability_of(s).verdict == Stability::stable);
    const double top = s.x()(144, 2);
    const bool is_up = top > 0;
    CHECK((is_up ? top > 0.5 * height : top < -0.5 * height));  // never near the unstable state between
    snaps += was_up && !is_up;
    CHECK((was_up || !is_up));
    was_up = is_up;
  }
  CHECK(snaps == 1);
}

TEST_CASE("A cloth that is free to slide or to turn is at rest, and stable") {
  for (const std::string& held :
       {std::string("start: {translate: [0, 0, 0.002]}\ncontact: {type: shapes, dhat: 0.001}\n"
                    "obstacles: [{name: floor, shape: half_space}]\n"),
        std::string("pins: [{region: nearest, point: [0, 0, 0]}]\nstart: {rotate: [90, 0, 0], perturbation: "
                    "1e-4}\n")})
    for (const double tolerance : {1e-3, 1e-6}) {
      INFO(held << tolerance);
      const Solved s = converged(solve_yaml(
          experiment("cloth: {shape: square, side: 0.1, columns: 9, rows: 9, triangulation: criss_cross}\n" +
                         std::string(thin) + "energies: [neo_hookean, hinge, gravity]\n" + held + "$",
                     newton_to(tolerance))));
      CHECK(stability_of(s).verdict == Stability::stable);
      CHECK(s.levels.back().saddles_left == 0);
    }
}

TEST_CASE("A pulled sheet has its wrinkles whatever the method, the noise and the schedule") {
  double lowest = 1, highest = 0;
  table("Wrinkles of a pulled sheet", "method", "noise [m]", "increments", "from [m]", "to [m]",
        "energy [J]");
  for (const double noise : {0., 2e-5, 1e-3})
    for (const int steps : {1, 10})
      for (const std::string method : {"pcs", "cascadic", "newton"}) {
        if (steps == 1 && noise > 0) continue;
        const Solved s = converged(solve_yaml(pulled_sheet("columns: 51, rows: 21", noise, steps), method));
        const double energy = s.model().energy(s.x()), low = s.x().col(2).minCoeff(),
                     high = s.x().col(2).maxCoeff();
        row(method, noise, steps, low, high, energy);
        CAPTURE(method, noise, steps);
        CHECK(stability_of(s).verdict == Stability::stable);
        CHECK(std::max(high, -low) > 3.05e-4);
        CHECK(std::max(high, -low) < 3.6e-4);
        CHECK(largest_entry(s.levels[0].x.col(2)) > 2e-4);  // the preview
        lowest = std::min(lowest, energy), highest = std::max(highest, energy);
      }
  CHECK(highest < lowest * (1 + 1e-6));
}

TEST_CASE("A pulled sheet has its wrinkles on a finer mesh, whose triangles are alike") {
  double lowest = 1, highest = 0;
  table("Wrinkles of a pulled sheet, 9211 vertices", "method", "refiner", "noise [m]", "from [m]", "to [m]",
        "energy [J]");
  const auto amplitude = [&](const char* method, const char* refiner, double noise) {
    const std::string keys = filled("refiner: $\n$", std::string(refiner), newton_to(1e-6));
    const Solved s = converged(solve_yaml(pulled_sheet("columns: 76, rows: 31", noise, 1) + keys, method));
    const double energy = s.model().energy(s.x()), low = s.x().col(2).minCoeff(),
                 high = s.x().col(2).maxCoeff();
    row(method, refiner, noise, low, high, energy);
    CHECK(stability_of(s).verdict != Stability::unstable);  // wrinkles that slide across are nearly neutral
    lowest = std::min(lowest, energy), highest = std::max(highest, energy);
    return std::max(high, -low);
  };
  for (const auto& [method, noise] :
       {std::pair("pcs", 0.), {"pcs", 1e-3}, {"cascadic", 0.}, {"newton", 0.}}) {
    CAPTURE(method, noise);
    const double a = amplitude(method, "midpoint", noise);
    CHECK(a > 3.1e-4);
    CHECK(a < 3.6e-4);
  }
  CHECK(highest < lowest * (1 + 1e-6));
  // Loop makes small triangles beside large ones of this pattern, on which folds as short as these are
  // stiffer.
  CHECK(amplitude("pcs", "loop", 0) < 2.5e-4);
}

TEST_CASE("A saddle is reported where it is not to be left, and is no convergence") {
  const Solved left = scene_from(column(1.2), {{"newton.stability", "report"}});
  Observer silent;
  const LevelResult r = left.experiment.methods[0].second->solve(*left.scene, silent).back();
  CHECK(r.outcome == Outcome::saddle);
  CHECK_FALSE(has_converged(r.outcome));
  REQUIRE(r.stability);
  CHECK(r.stability->verdict == Stability::unstable);
  // A load P takes its part P / P_critical of the column's bending stiffness.
  CHECK(r.stability->curvature_ratio == Approx(-0.2).epsilon(0.03));
  CHECK_THAT(r.message,
             Catch::Contains("forces balance at a saddle") && Catch::Contains("newton.stability: leave"));
  CHECK(largest_entry(r.x.col(2)) < 1e-9);
}

TEST_CASE("Multigrid and factors judge alike, also a small stiff plate beside a large soft one") {
  // The soft plate's motions are a thousandth as stiff: iterations find them first.
  std::ostringstream obj;
  obj.precision(17);
  std::ostringstream faces;
  int vertices = 0;
  const auto add_plate = [&](int columns, int rows, double length, double width, double y) {
    const int first = vertices + 1;
    for (int j = 0; j <= rows; ++j)
      for (int i = 0; i <= columns; ++i, ++vertices)
        obj << "v " << length * i / columns << ' ' << y + width * j / rows << " 0\n";
    for (int j = 0; j < rows; ++j)
      for (int i = 0; i < columns; ++i) {
        const int a = first + j * (columns + 1) + i, b = a + 1, d = b + columns + 1, e = a + columns + 1,
                  c = ++vertices;
        obj << "v " << length * (i + 0.5) / columns << ' ' << y + width * (j + 0.5) / rows << " 0\n";
        for (const auto& [p, q] : {std::pair(a, b), {b, d}, {d, e}, {e, a}})
          faces << "f " << p << ' ' << q << ' ' << c << '\n';
      }
  };
  add_plate(32, 6, 0.4, 0.15, 0);
  add_plate(12, 4, 0.05, 0.015, 1);
  const double thickness = 2e-3;
  const auto push = [&](double length, double fraction) {  // to this fraction of the critical strain, clamped
    return -fraction * 4 * M_PI * M_PI * thickness * thickness / 12 / length;
  };
  table("Two plates, judged by factors and with multigrid", "small plate", "solver", "ratio", "1/s²");
  for (const double fraction : {0.9, 1.02})
    for (const char* solver : {"mixed", "multigrid"}) {
      const Scratch folder(filled(R"(name: two
levels: 2
cloth: {shape: file, file: two.obj}
material: {density: 1000, thickness: $, membrane_modulus: 1e6, bending_modulus: 1e6, poisson_ratio: 0}
pins:
  - {region: box, lower: [-1, -0.5, -1], upper: [0.0126, 0.5, 1]}
  - {region: box, lower: [0.3874, -0.5, -1], upper: [1, 0.5, 1], translate: [$, 0, 0]}
  - {region: box, lower: [-1, 0.5, -1], upper: [0.0042, 1.5, 1]}
  - {region: box, lower: [0.0458, 0.5, -1], upper: [1, 1.5, 1], translate: [$, 0, 0]}
energies: [neo_hookean, midedge_bending]
newton: {force_tolerance: 1e-6, stability: report, linear_solver: $}
methods: {newton: {}}
)",
                                  thickness, push(0.375, 0.5), push(0.05 * 10 / 12, fraction),
                                  std::string(solver)));
      folder.write("two.obj", obj.str() + faces.str());
      const Solved s = solved(experiment_in(folder / "e.yaml"));
      INFO(solver << ", " << fraction);
      const Stability& stability = stability_of(s);
      row(fraction, solver, stability.curvature_ratio, stability.lowest_eigenvalue);
      CHECK(stability.by_factorisation == (solver == std::string("mixed")));
      CHECK(stability.verdict == (fraction < 1 ? Stability::stable : Stability::unstable));
      CHECK((stability.curvature_ratio < 0) == (fraction > 1));
      CHECK((stability.lowest_eigenvalue < 0) == (fraction > 1));
      CHECK(stability.curvature_ratio == Approx(fraction < 1 ? 0.0348 : -0.0938).epsilon(0.03));
    }
}

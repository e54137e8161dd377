#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/equilibrium.h"
#include "tests/support/meshes.h"
#include "tests/support/strip.h"

using namespace drape;

namespace {

using std::numbers::pi;

constexpr double edge = 0.05;    // of the coarse level [m]
constexpr int levels_below = 3;  // of the finest level

/// Cloth that buckles at a strain of 2.5e-4 between clamps one coarse edge apart.
const Material fabric = [] {
  Material m;
  m.thickness = 0.005 * edge;
  m.membrane_modulus = m.bending_modulus = 1e6;
  m.poisson_ratio = 0;
  return m;
}();

/// D of the hinge energy on a grid [J].
const double plate_stiffness = fabric.bending_modulus * std::pow(fabric.thickness, 3) / 4;

/// A strip of `cells` coarse cells between clamps, which are a cell wide at either end.
struct ClampedStrip {
  int cells;
  double strain;
  Hierarchy hierarchy =
      Hierarchy::of(grid({(cells + 2) * edge, 2 * edge}, cells + 3, 3, Diagonals::criss_cross),
                    *make_plugin_from<Refiner>("midpoint"), levels_below + 1);

  double length() const { return cells * edge; }
  /// Energy of the buckled strip by Euler's load of a column with clamped ends [J].
  double euler() const { return 4 * pi * pi * plate_stiffness / length() * strain * 2 * edge; }

  /// The right clamp moved to the left, and a wave in between.
  Positions start(const Level& level) const {
    Positions x = level.rest.vertices;
    const double height = 2 * length() * std::sqrt(strain) / pi;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const double along = std::clamp(x(i, 0) - edge, 0.0, length());
      x(i, 0) -= strain * along;
      x(i, 2) = height * std::pow(std::sin(pi * along / length()), 2);
    }
    return x;
  }

  LevelModel model(int index, const std::string& membrane) const {
    const Level& level = hierarchy.levels[index];
    const Positions x = start(level);
    std::vector<DirichletVertex> clamped;
    for (int i = 0; i < level.vertex_count(); ++i) {
      const double along = level.rest.vertices(i, 0) - edge;
      if (along < 1e-9 || along > length() - 1e-9)
        clamped.push_back({i, Eigen::Vector3d(x(i, 0), x(i, 1), 0)});
    }
    return {level, fabric, named_energies({membrane, "hinge"}), clamped};
  }

  double solved(const LevelModel& model) const {
    return model.value(equilibrium_of(model, start(model.level()), 1e-5, 0.01));
  }
};

}  // namespace

TEST_CASE("A coarse strip between clamps has about the energy of the buckled cloth", "[physics]") {
  row("\nEnergy of a strip compressed by 5 %% between clamps, over Euler's; coarse edges h, finest h/8");
  row("%12s %10s %10s %14s %14s", "membrane", "length/h", "finest", "coarse, plain", "coarse, buckling");
  for (const std::string membrane : {"neo_hookean", "stvk"})
    for (const int cells : {1, 2, 4, 8, 16}) {
      const ClampedStrip strip{cells, 0.05};
      const LevelModel plain = strip.model(0, membrane);
      const double finest = strip.solved(strip.model(levels_below, membrane)) / strip.euler(),
                   coarse = strip.solved(plain) / strip.euler(),
                   buckling = strip.solved(plain.with_effective_membranes(levels_below)) / strip.euler();
      row("%12s %10d %10.3f %14.3f %14.3f", membrane.c_str(), cells, finest, coarse, buckling);
      INFO(membrane << ", " << cells << " coarse edges");
      // Hinges bend over half a cell on either side, so a strip with clamps is longer by a cell: 1/8 of h on
      // the finest level and h on the coarse one, which halves the load of short strips that buckle there.
      CHECK(finest == Approx(std::pow(cells / (cells + 0.125), 2)).epsilon(0.1));
      CHECK(buckling <= coarse * (1 + 1e-9));
      CHECK(buckling < 4 * finest);
      CHECK(buckling > 0.25 * finest);
      if (cells == 1) CHECK(coarse > 50 * finest);
    }
}

TEST_CASE("A strip that hangs or bends under its weight is the same with a membrane that buckles",
          "[physics]") {
  // Heavy and soft enough to stretch and to bend visibly, with a compressive stress below the bound.
  const Level level = Level::of(0, grid({0.4, 0.1}, 9, 3, Diagonals::criss_cross));
  Material m = fabric;
  m.density = 1000;
  m.bending_modulus = 1e8;
  for (const bool hangs : {true, false}) {
    const std::string gravity = hangs ? "{type: gravity, acceleration: [9.81, 0, 0]}" : "gravity";
    std::vector<DirichletVertex> clamped;
    for (int i = 0; i < level.vertex_count(); ++i)
      if (level.rest.vertices(i, 0) < (hangs ? 1e-9 : 0.051))
        clamped.push_back({i, level.rest.vertices.row(i).transpose()});
    const LevelModel plain(level, m, named_energies({"neo_hookean", "hinge", gravity}), clamped),
        buckling = plain.with_effective_membranes(2);
    const Positions expected = equilibrium_of(plain, level.rest.vertices, 1e-8),
                    found = equilibrium_of(buckling, level.rest.vertices, 1e-8);
    const double moved = (expected - level.rest.vertices).rowwise().norm().maxCoeff();
    row("%s: largest displacement %.3g m, difference %.1e", hangs ? "Hanging strip" : "Cantilever", moved,
        (found - expected).rowwise().norm().maxCoeff());
    CHECK(moved > 1e-4);
    CHECK((found - expected).rowwise().norm().maxCoeff() < 1e-4 * moved);
  }
}

TEST_CASE("The membrane energy of a rolled sheet falls with h as of chords, up to the bound", "[physics]") {
  constexpr double radius = 0.03, side = 0.1;
  row("\nMembrane energy of a sheet rolled to a radius of 30 mm, per area [J/m²]");
  row("%10s %12s %12s %12s %12s", "h [mm]", "plain", "E d e²/2", "buckling", "s e/area");
  double last = std::numeric_limits<double>::infinity();
  for (const int cells : {2, 4, 8, 16, 32, 64}) {
    const double h = side / cells;
    const TriangleMesh flat = grid({side, side}, cells + 1, cells + 1, Diagonals::criss_cross);
    const Level level = Level::of(0, flat);
    const Positions x = rolled(flat.vertices, radius);
    const double chord = 2 * radius * std::sin(h / (2 * radius)) / h, strain = (1 - chord * chord) / 2;
    const double stiffness = fabric.membrane_modulus * fabric.thickness;
    const double bound = 4 * pi * pi * plate_stiffness / (h * h * (1 - std::pow(4.0, -levels_below)));
    const auto density = [&](const LevelModel& model) {
      return model.value(x, Roles{EnergyRole::membrane}) / (side * side);
    };
    const LevelModel model(level, fabric, named_energies({"stvk", "hinge"}), {});
    const double plain = density(model), buckling = density(model.with_effective_membranes(levels_below));
    const double elastic = stiffness * strain * strain / 2;
    const double wrinkled =
        bound >= stiffness * strain ? elastic : bound * strain - bound * bound / (2 * stiffness);
    row("%10.2f %12.3e %12.3e %12.3e %12.3e", 1e3 * h, plain, elastic, buckling, wrinkled);
    CHECK(plain == Approx(elastic).epsilon(1e-9));
    const double remainder = 0.01;
    CHECK(buckling == Approx((1 - remainder) * wrinkled + remainder * elastic).epsilon(1e-9));
    CHECK(buckling < last);
    last = buckling;
  }
}

TEST_CASE("A sheared panel carries the stress of a tension field", "[physics]") {
  // Wrinkles run at 45°: along them E ε with ε = γ/2, across them -σ (Wong and Pellegrino 2006, section 3).
  row("\nShear stress over E gamma of a panel sheared by gamma = 0.005; without wrinkles 1 / 2(1 + nu)");
  row("%12s %6s %10s %10s %10s", "membrane", "nu", "plain", "buckling", "theory");
  constexpr double shear = 0.005, step = 1e-6;
  for (const std::string membrane : {"neo_hookean", "stvk"})
    for (const double nu : {0.0, 0.3}) {
      Material m = fabric;
      m.poisson_ratio = nu;
      const Level level = Level::of(0, grid({0.4, 0.2}, 9, 5, Diagonals::one_way));
      const LevelModel plain(level, m, named_energies({membrane, "hinge"}), {}),
          buckling = plain.with_effective_membranes(levels_below);
      const auto stress = [&](const LevelModel& model) {
        const auto energy = [&](double gamma) {
          Positions x = level.rest.vertices;
          x.col(0) += gamma * x.col(1);
          return model.value(x, {EnergyRole::membrane});
        };
        return (energy(shear + step) - energy(shear - step)) / (2 * step * 0.4 * 0.2 * m.thickness);
      };
      const double h = 0.05, modulus = m.membrane_modulus;
      const double sigma = 4 * pi * pi * make_plugin_from<Energy>("hinge")->plate_stiffness(m) /
                           (m.thickness * h * h * (1 - std::pow(4.0, -levels_below)));
      const double theory = (modulus * shear / 2 + (1 - nu) * sigma) / 2;
      const double own = stress(plain), wrinkled = stress(buckling);
      row("%12s %6g %10.4f %10.4f %10.4f", membrane.c_str(), nu, own / (modulus * shear),
          wrinkled / (modulus * shear), theory / (modulus * shear));
      INFO(membrane << ", nu = " << nu);
      CHECK(own == Approx(modulus * shear / (2 * (1 + nu))).epsilon(0.02));
      CHECK(wrinkled == Approx(theory).epsilon(0.03));
    }
}

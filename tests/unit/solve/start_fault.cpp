// Messages about starts without finite energy or forces.

#include "core/numerics/solve/start_fault.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/numerics/elements/linear_energy.h"
#include "core/numerics/patterns/generate.h"
#include "core/numerics/solve/newton.h"
#include "tests/support/test_energies.h"

using namespace drape;

namespace {

constexpr double inf = std::numeric_limits<double>::infinity();

const TriangleMesh sheet = grid({1, 1}, 3, 3, Diagonals::one_way);

/// An energy of triangles with a constant value and constant forces.
struct Given : NoEnergy {
  Given(double value, double force) : energy(value), force(force) {}
  double value(const Positions&) const override { return energy; }
  double add_gradient(const Positions&, Positions& g) const override {
    g.array() += force;
    return energy;
  }
  Stencils stencils() const override { return sheet.triangles; }
  double energy, force;
};

/// The message of a minimisation that cannot start, after its first words.
std::string fault(const std::vector<NamedEnergy>& energies, const Positions& start) {
  const Level level = Level::of(0, sheet);
  const LevelModel model(level, Material(), energies, {});
  PlainObjective objective(model);
  Observer observer;
  const LevelResult r = minimise(objective, start, NewtonParameters(), {Stopwatch(), observer});
  CHECK(r.outcome == Outcome::infeasible);
  CHECK_FALSE(std::isfinite(r.force_residual));
  const std::string first = "energy or forces at the start are not finite: ";
  REQUIRE(r.message.starts_with(first));
  return r.message.substr(first.size());
}

std::shared_ptr<const Energy> given(double value, double force) { return energy_of(Given(value, force)); }

}  // namespace

TEST_CASE("what is not finite at the start is named: the energy, the triangle, the load or the forces") {
  const Positions& rest = sheet.vertices;
  const std::string units = "; are the moduli, the density and the loads in SI units?";
  for (const double none : {inf, std::nan("")}) {
    CHECK(fault({{"soft", given(1, 1)}, {"stiff", given(none, 1)}}, rest) ==
          "energy stiff is not, though no triangle is degenerate" + units);
    CHECK(fault({{"stiff", given(1, none)}}, rest) == "the forces at vertex 0 are not" + units);
  }
  CHECK(fault({{"stiff", given(1e200, 1e200)}}, rest) ==
        "the forces are too large to be computed with" + units);
  CHECK(fault({{"soft", given(1, 1)},
               {"wind", energy_of(LinearEnergy(Positions::Constant(9, 3, 1e200)), EnergyRole::external)}},
              rest) == "the load is too large to be computed with" + units);

  Positions start = rest;
  start.row(4) = start.row(3);
  CHECK(fault({{"stiff", given(inf, 1)}}, start) ==
        "energy stiff is not, as triangle 1 (0, 4, 3) has no area there; change the start");
  CHECK(fault({{"stiff", given(1, inf)}}, start) ==
        "triangle 1 (0, 4, 3) has no area there; change the start");
  start = 1e-200 * rest;  // small, but no triangle is degenerate
  CHECK(fault({{"stiff", given(inf, 1)}}, start) ==
        "energy stiff is not, though no triangle is degenerate" + units);
  start.row(2)[1] = std::nan("");
  CHECK(fault({{"stiff", given(inf, 1)}}, start) == "vertex 2 has no finite position; change the start");
}

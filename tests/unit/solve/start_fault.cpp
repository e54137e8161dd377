// Messages about starts without finite energy or forces.

#include "core/numerics/solve/start_fault.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/numerics/elements/linear_energy.h"
#include "core/numerics/patterns/generate.h"
#include "core/numerics/solve/newton.h"
#include "tests/support/registry.h"
#include "tests/support/test_energies.h"

using namespace drape;

namespace {

const TriangleMesh nine_vertices = grid({1, 1}, 3, 3, Diagonals::one_way);

/// An energy of triangles with a constant value and constant forces.
struct GivenEnergy : NoEnergy {
  GivenEnergy(double value, double force) : energy(value), force(force) {}
  double value(const Positions&) const override { return energy; }
  double add_gradient(const Positions&, Positions& g) const override {
    g.array() += force;
    return energy;
  }
  Stencils stencils() const override { return nine_vertices.triangles; }
  double energy, force;
};

NamedEnergy given(const std::string& name, double value, double force) {
  return {name, energy_of(GivenEnergy(value, force))};
}

/// The message of a minimisation that cannot start, after its first words.
std::string fault(const std::vector<NamedEnergy>& energies, const Positions& start,
                  const std::vector<DirichletVertex>& pins = {}) {
  const Level level = Level::of(0, nine_vertices);
  const LevelModel model(level, Material(), energies, pins);
  PlainObjective objective(model);
  Observer observer;
  const LevelResult r = minimise(objective, start, NewtonParameters(), {Stopwatch(), observer});
  CHECK(r.outcome == Outcome::infeasible);
  CHECK_FALSE(std::isfinite(r.force_residual));
  const std::string first = "energy or forces at the start are not finite: ";
  REQUIRE(r.message.starts_with(first));
  return r.message.substr(first.size());
}

}  // namespace

TEST_CASE("what is not finite at the start is named: the energy, the triangle, the load or the forces") {
  const Positions& rest = nine_vertices.vertices;
  const std::string units = "; are the moduli, the density and the loads in SI units?",
                    not_degenerate = "energy stiff is not, though no triangle is degenerate" + units;
  const double inf = std::numeric_limits<double>::infinity();
  for (const double none : {inf, std::nan("")}) {
    CHECK(fault({given("soft", 1, 1), given("stiff", none, 1)}, rest) == not_degenerate);
    CHECK(fault({given("stiff", 1, none)}, rest) == "the forces at vertex 0 are not" + units);
  }
  CHECK(fault({given("stiff", 1e200, 1e200)}, rest) ==
        "the forces are too large to be computed with" + units);
  const LinearEnergy storm(Positions::Constant(9, 3, 1e200));
  CHECK(fault({given("soft", 1, 1), {"wind", energy_of(storm, EnergyRole::external)}}, rest) ==
        "the load is too large to be computed with" + units);

  Positions start = rest;
  start.row(4) = start.row(3);
  const std::string no_area = "triangle 1 (0, 4, 3) has no area there; change the start";
  CHECK(fault({given("stiff", inf, 1)}, start) == "energy stiff is not, as " + no_area);
  CHECK(fault({given("stiff", 1, inf)}, start) == no_area);
  start = 1e-200 * rest;  // small, but no triangle is degenerate
  CHECK(fault({given("stiff", inf, 1)}, start) == not_degenerate);
  start.row(2)[1] = std::nan("");
  CHECK(fault({given("stiff", inf, 1)}, start) == "vertex 2 has no finite position; change the start");
}

TEST_CASE("A start beyond the strain limit is named, and what to do about it") {
  const NamedEnergy limit{"limit", make_plugin_from<Energy>("{type: strain_limit, limit: 1.1}")};
  Positions start = nine_vertices.vertices;
  start.col(0) *= 1.2;
  const std::string message =
      "triangle 0, stretched to 1.2 (limit 1.1) and 7 more; start nearer to the rest "
      "shape, or raise the limit";
  CHECK(fault({limit}, start) == message);
  CHECK(fault({limit}, start, {{0, start.row(0), 0}}) ==
        message + "; pinned vertices begin at their targets: a schedule moves pins far");
}

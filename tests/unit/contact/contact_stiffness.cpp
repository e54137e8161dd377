#include "core/numerics/contact_forces/contact_stiffness.h"

#include <catch2/catch.hpp>
#include <limits>

#include "core/numerics/model/level_model.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/closed_meshes.h"
#include "tests/support/command.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// The barrier stiffness of contact models on this mesh under an energy [Pa].
ContactStiffness bound_stiffness(const TriangleMesh& mesh, const Material& material,
                                 const std::string& energy, const std::vector<std::string>& contacts) {
  std::vector<std::shared_ptr<ContactModel>> models;
  for (const std::string& contact : contacts) models.push_back(make_plugin_from<ContactModel>(contact));
  const Level level = Level::of(0, mesh);
  const LevelModel model(level, material, {{"load", make_plugin_from<Energy>(energy)}}, {}, models);
  return stiffness_of(model.contacts());
}

const std::string a_half_space =
    "{type: shapes, obstacles: [{name: floor, shape: half_space, translate: [0, 0, -1]}]}";

}  // namespace

TEST_CASE("The default stiffness is ten times the weight per area, of any material") {
  Material cotton;
  CHECK(contact_stiffness(cotton) == Approx(10 * 9.81 * cotton.density * cotton.thickness));
  Material nothing = cotton, lead = cotton;
  nothing.density = 0;
  lead.density = 1e30;
  CHECK(contact_stiffness(nothing) == Approx(9.81e-5));
  CHECK(contact_stiffness(lead) == Approx(9.81e7));
}

TEST_CASE("The stiffness for a load is the weight's times a power of four, up to ten times the pressure") {
  for (const double weight : {1e-4, 14.7, 9.81e7}) {
    CHECK(stiffness_for_load(weight, 0) == weight);
    CHECK(stiffness_for_load(weight, 0.1 * weight) == weight);
    CHECK(stiffness_for_load(weight, 0.399 * weight) == weight);
    CHECK(stiffness_for_load(weight, 0.401 * weight) == 4 * weight);
    for (const double pressure : {10 * weight, 123 * weight, 1e6 * weight}) {
      const double stiffness = stiffness_for_load(weight, pressure);
      CHECK(stiffness <= 10 * pressure);
      CHECK(stiffness > 2.5 * pressure);
      const double power = std::log(stiffness / weight) / std::log(4.0);
      CHECK(power == Approx(std::round(power)));
      // Loads that nearly agree have the same.
      CHECK(stiffness_for_load(weight, pressure * (1 + 1e-9)) == stiffness);
    }
  }
  CHECK(stiffness_for_load(0, 100) == 0);  // no barrier
}

TEST_CASE("A load that is infinite on the rest shape leaves the weight's stiffness") {
  CHECK(stiffness_for_load(14.7, std::numeric_limits<double>::infinity()) == 14.7);
  CHECK(stiffness_for_load(14.7, std::numeric_limits<double>::max()) == 14.7);
  const std::string lift =
      "{type: formula, per: vertex, constants: {c: {value: 1, unit: m^2/s^2}, h: {value: 1, unit: m}}, "
      "energy: "
      "\"-c*mass*log(z/h)\"}";
  const TriangleMesh flat = grid({0.1, 0.1}, 3, 3, Diagonals::one_way);
  CHECK(bound_stiffness(flat, Material(), lift, {"ipc"})[0] == contact_stiffness(Material()));
}

TEST_CASE("The stiffness is raised by four above a mean pressure of fifty times it, up to a bound") {
  CHECK(raised_stiffness(10, 0, 1e6) == 10);
  CHECK(raised_stiffness(10, 50, 1e6) == 10);
  CHECK(raised_stiffness(10, 51, 1e6) == 40);
  CHECK(raised_stiffness(10, 1e12, 1e6) == 40);
  CHECK(raised_stiffness(10, 51, 25) == 25);
  CHECK(raised_stiffness(10, 51, 5) == 10);  // never lowered
}

TEST_CASE("The mean pressure weights each contact by its force") {
  NormalForces forces;
  CHECK(forces.mean_pressure() == 0);
  forces.add(3, -10);
  forces.add(1, -50);
  CHECK(forces.mean_pressure() == Approx((3 * 10 + 50) / 4.0));
  NormalForces others;
  others.add(4, -20);
  forces.add(others);
  CHECK(forces.mean_pressure() == Approx(20));
}

TEST_CASE("A pressure in a light cushion gives its barrier about ten times that stiffness at first") {
  Material foil;
  foil.density = 1000;
  foil.thickness = 1e-5;
  const TriangleMesh cushion = cushion_mesh(0.1, 24, 4, 1e-3);
  const double at_rest = bound_stiffness(cushion, foil, "gravity", {"ipc"})[0];
  CHECK(at_rest == contact_stiffness(foil));
  for (const double pressure : {50.0, 500.0}) {
    const double stiffness = bound_stiffness(
        cushion, foil, "{type: pressure, pressure: " + std::to_string(pressure) + "}", {"ipc"})[0];
    CHECK(stiffness <= 10 * pressure);
    CHECK(stiffness > 2 * pressure);
  }
}

TEST_CASE("A stiffness that the experiment gives stays, while that of another model follows the load") {
  const TriangleMesh sheet = grid({0.1, 0.1}, 4, 4, Diagonals::one_way);
  for (const std::string& given : {std::string("{type: ipc, stiffness: 3}"),
                                   replaced(a_half_space, "shapes,", "shapes, stiffness: 3,")}) {
    CAPTURE(given);
    const ContactStiffness stiffness = bound_stiffness(
        sheet, Material(), "{type: constant_load, force_density: [0, 0, -1000]}", {given, a_half_space});
    CHECK(stiffness[0] == 3);
    CHECK(stiffness[1] > 2500);
    CHECK(stiffness[1] <= 10000);
    const auto contact = make_plugin_from<ContactModel>(given)->bind(Level::of(0, sheet), Material());
    CHECK(contact->stiffness() == 3);
    CHECK(contact->with_stiffness(12) == nullptr);
  }
}

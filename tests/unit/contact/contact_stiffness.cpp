#include "core/numerics/contact_forces/contact_stiffness.h"

#include <catch2/catch.hpp>
#include <limits>

#include "core/numerics/contact/vertex_contacts.h"
#include "core/numerics/model/level_model.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/registry.h"

using namespace drape;

namespace {

Level small_patch() { return Level::of(0, grid({0.1, 0.1}, 4, 4, Diagonals::one_way)); }

/// The barrier stiffness of contact models under an energy [Pa].
ContactStiffness bound_stiffness(const std::string& energy, const std::vector<std::string>& contacts) {
  std::vector<std::shared_ptr<ContactModel>> models;
  for (const std::string& contact : contacts) models.push_back(make_plugin_from<ContactModel>(contact));
  const Level level = small_patch();
  const LevelModel model(level, Material(), {{"load", make_plugin_from<Energy>(energy)}}, {}, models);
  return stiffness_of(model.contacts());
}

}  // namespace

TEST_CASE("The default stiffness is ten times the weight per area, of any material") {
  for (const auto& [density, expected] :
       {std::pair(1500.0, 10 * 9.81 * 1500 * 3e-4), {0.0, 9.81e-5}, {1e30, 9.81e7}}) {
    Material material;
    material.density = density;
    material.thickness = 3e-4;
    CHECK(contact_stiffness(material) == Approx(expected));
  }
}

TEST_CASE("The stiffness for a load is the weight's times a power of four, up to ten times the pressure") {
  for (const double weight : {1e-4, 14.7, 9.81e7}) {
    for (const double part : {0.0, 0.1, 0.399}) CHECK(stiffness_for_load(weight, part * weight) == weight);
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

TEST_CASE("A load of its own weight, or that is infinite on the rest shape, leaves the weight's stiffness") {
  CHECK(stiffness_for_load(14.7, std::numeric_limits<double>::infinity()) == 14.7);
  CHECK(stiffness_for_load(14.7, std::numeric_limits<double>::max()) == 14.7);
  const std::string lift =
      "{type: formula, per: vertex, constants: {c: {value: 1, unit: m^2/s^2}, h: {value: 1, unit: m}}, "
      "energy: \"-c*mass*log(z/h)\"}";
  for (const std::string& load : {lift, std::string("gravity")})
    CHECK(bound_stiffness(load, {"ipc"}) == ContactStiffness{contact_stiffness(Material())});
}

TEST_CASE("The stiffness is raised by four above a mean pressure of fifty times it, up to a bound") {
  for (const auto& [pressure, bound, expected] :
       {std::tuple(0.0, 1e6, 10.0), {50, 1e6, 10}, {51, 1e6, 40}, {1e12, 1e6, 40}, {51, 25, 25}, {51, 5, 10}})
    CHECK(raised_stiffness(10, pressure, bound) == expected);
  // Each contact counts by its force, |b'| times its weight here.
  const BarrierParameters unit{1, 1};
  CHECK(make_collisions<VertexContact>(unit, {})->mean_pressure() == 0);
  const auto contact = [](double weight, double gap) { return VertexContact{0, 0, weight, 0, {gap}}; };
  const double near = std::abs(barrier(0.1).first), far = std::abs(barrier(0.5).first);
  const auto collisions = make_collisions<VertexContact>(unit, {contact(2, 0.1), contact(3, 0.5)});
  CHECK(collisions->mean_pressure() == Approx((2 * near * near + 3 * far * far) / (2 * near + 3 * far)));
}

TEST_CASE("A stiffness that the experiment gives stays, while that of another model follows the load") {
  const std::string floor = "obstacles: [{name: floor, shape: half_space, translate: [0, 0, -1]}]}";
  for (const std::string& given :
       {std::string("{type: ipc, stiffness: 3}"), "{type: shapes, stiffness: 3, " + floor}) {
    CAPTURE(given);
    const ContactStiffness stiffness = bound_stiffness("{type: constant_load, force_density: [0, 0, -1000]}",
                                                       {given, "{type: shapes, " + floor});
    CHECK(stiffness[0] == 3);
    CHECK(stiffness[1] > 2500);
    CHECK(stiffness[1] <= 10000);
    const auto contact = make_plugin_from<ContactModel>(given)->bind(small_patch(), Material());
    CHECK(contact->stiffness() == 3);
    CHECK(contact->with_stiffness(12) == nullptr);
  }
}

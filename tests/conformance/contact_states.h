#pragma once

#include <catch2/catch.hpp>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/contact_model.h"
#include "core/numerics/model/required.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/conformance.h"
#include "tests/support/meshes.h"

// Models of contact, and states that they act in.

namespace contact_states {

using namespace drape;

/// Settings of every contact model that declares them: a d̂ comparable to the triangles of these tests' cloth,
/// and friction.
inline const std::vector<std::pair<std::string, std::string>> common = {
    {"dhat", "0.02"}, {"stiffness", "50"}, {"friction", "0.3"}, {"friction_smoothing_distance", "1e-3"}};

/// Two sheets, side by side at rest.
inline Level two_sheets(int vertices) {
  const TriangleMesh one = random_triangulation({0.5, 0.4}, vertices, 1),
                     other = random_triangulation({0.5, 0.4}, vertices, 2);
  return Level::of(0, both_of(one, other, {1, 0, 0}));
}

inline Positions raised(Positions x, double height) {
  x.col(2).array() += height;
  return x;
}

/// The vertices of the upper sheet.
inline auto upper(Positions& x) { return x.bottomRows(x.rows() - x.rows() / 2); }

/// Raised by this height, the upper sheet by twice as much.
inline Positions raised_apart(Positions x, double height) {
  upper(x).col(2).array() += height;
  return raised(x, height);
}

/// One sheet above the other, the lower one at z = 0; neither is quite flat.
inline Positions stacked(const Level& level, double gap, unsigned seed) {
  Positions x = level.rest.vertices + noise(level.vertex_count(), 0.1 * gap, seed);
  upper(x).col(0).array() -= 1;
  upper(x).col(2).array() += gap;
  return x;
}

/// Pushes the cloth down with noise, as far as gaps stay above 3 mm.
inline Positions pressed(const BoundContact& contact, Positions x, unsigned seed) {
  for (unsigned step = 0; step < 12; ++step) {
    const Positions to = raised(x + noise(x.rows(), 0.01, 100 * seed + step), -0.01);
    const auto candidates = contact.build_candidates(x, to);
    double part = candidates->max_step().fraction;
    while (part > 1e-3 && candidates->build_collisions(x + part * (to - x))->smallest_gap() < 3e-3)
      part *= 0.7;
    if (part > 1e-3) x += part * (to - x);
  }
  return x;
}

struct NamedModel {
  std::string name;
  std::shared_ptr<ContactModel> model;
  bool has_friction;
};

/// Every registered contact model except those without contact: all of them with the obstacles of their
/// conformance.yaml, or those that declare self-contact without obstacles.
inline std::vector<NamedModel> registered_models(bool with_obstacles) {
  std::vector<NamedModel> all;
  for (const RegistryEntry* entry : test_registry().of_kind("contact")) {
    if (!with_obstacles && !declares(*entry, "self_contact")) continue;
    const std::string own = with_obstacles ? conformance_parameters(*entry)["conformance"] : "";
    const auto model = make_plugin_from<ContactModel>(conformance_config(*entry, own, common));
    if (model->bind(two_sheets(20), Material()))
      all.push_back({entry->name, model, declares(*entry, "friction")});
  }
  REQUIRE(all.size() >= (with_obstacles ? 2u : 1u));
  return all;
}
inline std::vector<NamedModel> all_models() { return registered_models(true); }
inline std::vector<NamedModel> self_contact_models() { return registered_models(false); }

/// The height by which to raise x so that it clears the obstacles by 5 to 10 mm; 0 if it has no
/// intersections.
inline double clearance(const BoundContact& contact, const Positions& x) {
  double height = 0;
  for (; !contact.intersections(raised(x, height)).empty(); height += 5e-3) REQUIRE(height < 10);
  return height > 0 ? height + 5e-3 : 0;
}

/// The sheets one above the other, above the obstacles.
inline Positions stacked(const Level& level, const BoundContact& contact, double gap, unsigned seed) {
  const Positions x = stacked(level, gap, seed);
  return raised(x, clearance(contact, x));
}

/// Runs the body at random states of every model with many contacts.
template <class Body>
void for_each_state(const std::vector<NamedModel>& models, const Body& body) {
  const Level level = two_sheets(40);
  const unsigned states = DRAPE_SANITIZED ? 1 : 3;
  for (const NamedModel& named : models) {
    const auto contact = named.model->bind(level, Material());
    for (unsigned seed = 1; seed <= states; ++seed) {
      INFO(named.name << ", state " << seed);
      const Positions x = pressed(*contact, stacked(level, *contact, 0.015, seed), seed);
      REQUIRE(contact->intersections(x).empty());
      REQUIRE(collisions_at(*contact, x)->contact_count() >= 20);
      body(*contact, x);
    }
  }
}

/// Runs the body on every model, bound with obstacles and without.
template <class Body>
void for_each_model(const Body& body) {
  const Level level = two_sheets(40);
  for (const auto& models : {all_models(), self_contact_models()})
    for (const NamedModel& named : models) {
      INFO(named.name);
      body(level, *named.model->bind(level, Material()));
    }
}

}  // namespace contact_states

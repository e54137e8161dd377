#include "core/numerics/model/active_contacts.h"

#include <catch2/catch.hpp>

#include "core/numerics/contact_forces/barrier.h"
#include "core/numerics/contact_forces/contact_stiffness.h"
#include "core/numerics/model/required.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/evaluate.h"
#include "tests/support/meshes.h"
#include "tests/support/registry.h"

using namespace drape;

namespace {

constexpr double dhat = 1e-3, stiffness = 100, mu = 0.3, epsilon = 1e-4;

/// A contact model with friction and these obstacles; both are YAML.
std::shared_ptr<ContactModel> model_with(const std::string& type, const std::string& obstacles) {
  return make_plugin_from<ContactModel>("{type: " + type + ", friction: 0.3, obstacles: [" + obstacles +
                                        "]}");
}

/// The half-space below this height.
std::shared_ptr<ContactModel> a_floor(double height = 0, const std::string& name = "floor",
                                      const std::string& type = "shapes, stiffness: 100") {
  return model_with(
      type, "{name: " + name + ", shape: half_space, translate: [0, 0, " + std::to_string(height) + "]}");
}

/// A box whose top is z = 0, larger than the sheet.
std::shared_ptr<ContactModel> a_plate(double x) {
  return model_with("shapes, stiffness: 100", "{name: plate, shape: box, size: [1, 1, 0.2], translate: [" +
                                                  std::to_string(x) + ", 0, -0.1]}");
}

/// A sheet of 0.1 m × 0.1 m.
const Level& patch_at_rest() {
  static const Level level = Level::of(0, grid({0.1, 0.1}, 4, 4, Diagonals::one_way));
  return level;
}

BoundContacts bound(const std::vector<std::shared_ptr<ContactModel>>& models,
                    const Level& level = patch_at_rest()) {
  BoundContacts all;
  for (const auto& model : models) all.push_back(model->bind(level, Material()));
  return all;
}

Positions at(double x, double height) {
  return patch_at_rest().rest.vertices.rowwise() + Eigen::RowVector3d(x, 0, height);
}

constexpr double sliding_height = 0.4 * dhat;
Positions slid(double x) { return at(x, sliding_height); }

/// Normal force of the sheet at this height [N].
double normal_force(double height) { return -stiffness * barrier(height / dhat).first * 0.01; }

/// The friction potential of the sheet at a tangential displacement u [J].
double potential(double u, double height = sliding_height) {
  const double q = u / epsilon;
  return normal_force(height) * mu * (q < 1 ? u * q * (1 - q / 3) : u - epsilon / 3);
}

/// Two steps: one begins at x0, the next at x1.
void step_between(ActiveContacts& contacts, const Positions& x0, const Positions& x1) {
  contacts.begin_step(x0);
  contacts.max_step(x0, x1);
  contacts.begin_step(x1);
}

}  // namespace

TEST_CASE("Friction keeps the normal forces of the step's start until update_lagging") {
  const double slide = 20 * epsilon, high = 0.5 * dhat, low = 0.3 * dhat;
  const Positions x0 = at(0, high), x1 = at(slide, low);
  REQUIRE(normal_force(low) > 1.5 * normal_force(high));
  ActiveContacts contacts(bound({a_floor()}));
  contacts.begin_step(x0);
  CHECK(contacts.has_friction());
  CHECK(contacts.friction(x0) == 0);
  REQUIRE(contacts.max_step(x0, x1).fraction == 1);
  CHECK(contacts.friction(x1) == Approx(potential(slide, high)));
  contacts.update_lagging(x1);  // the reference is still x0
  CHECK(contacts.friction(x1) == Approx(potential(slide, low)));
  Positions g = Positions::Zero(x1.rows(), 3);
  CHECK(contacts.add_gradient(x1, g) == Approx(contacts.barrier(x1) + contacts.friction(x1)));
  CHECK(g.col(0).sum() == Approx(mu * normal_force(low)));
  CHECK(-g.col(2).sum() == Approx(normal_force(low)));

  // Both have the Hessians of their forces, at any state.
  const Positions x = x1 + 0.05 * dhat * Positions::Random(x1.rows(), 3);
  const auto forces = [&](const Positions& y) {
    REQUIRE(contacts.max_step(x, y).fraction == 1);
    Positions f = Positions::Zero(y.rows(), 3);
    contacts.add_gradient(y, f);
    return f;
  };
  const Eigen::MatrixXd expected = differences(forces, x, 1e-8);
  REQUIRE(contacts.energies(x).size() == 2);
  const Eigen::MatrixXd h = dense(hessian_of(contacts.energies(x), x, Projection::none));
  CHECK((h - expected).norm() <= 1e-5 * h.norm());
}

TEST_CASE("After a reset, contacts at a state do not depend on the states before it") {
  ActiveContacts contacts(
      bound({model_with("ipc, stiffness: 100",
                        "{name: plate, meshed_shape: box, size: [1, 1, 0.2], translate: [0, 0, -0.1]}")}));
  contacts.begin_step(at(0, 0.5));
  REQUIRE(contacts.count() == 0);
  for (const Positions& x : {slid(0), slid(20 * epsilon)}) {
    contacts.reset();
    contacts.begin_step(x);
    CHECK(contacts.count() > 0);
    CHECK(contacts.barrier(x) > 0);
    CHECK(contacts.friction(x) == 0);
  }
}

TEST_CASE("Tangential displacements persist between steps, limited to the smoothing distance") {
  ActiveContacts contacts(bound({a_floor()}));
  double from = 0;
  const auto friction_at = [&](double to) {  // both in units of ε
    step_between(contacts, slid(from * epsilon), slid(to * epsilon));
    from = to;
    return contacts.friction(slid(to * epsilon));
  };
  // Sticking: three steps of 0.3 ε add up.
  for (const double to : {0.3, 0.6, 0.9}) CHECK(friction_at(to) == Approx(potential(to * epsilon)));
  // Sliding: a displacement of ε is kept, where friction is at its maximum.
  CHECK(friction_at(7) == Approx(potential(epsilon)));
  CHECK(friction_at(6.5) == Approx(potential(0.5 * epsilon)));  // back by ε / 2
  // After a loss of contact nothing is kept.
  const Positions up = at(6.5 * epsilon, 5 * dhat), elsewhere = at(50 * epsilon, 5 * dhat);
  step_between(contacts, slid(6.5 * epsilon), up);
  step_between(contacts, up, elsewhere);
  CHECK_FALSE(contacts.has_friction());
  step_between(contacts, elsewhere, slid(50 * epsilon));
  CHECK(contacts.has_friction());
  CHECK(contacts.friction(slid(50 * epsilon)) == Approx(0).margin(1e-12));
}

TEST_CASE("Ten layers that stick to each other do not creep") {
  constexpr int layers = 10, n = 16;
  TriangleMesh rest;
  Positions x0(layers * n, 3), x1(layers * n, 3);
  for (int i = 0; i < layers; ++i) {
    const Eigen::RowVector3d above(1e-3 * i, 2e-3 * i, 0.3 * dhat * i),
        motion(0.4 * epsilon * i, 0.1 * epsilon * (i % 3), 0);
    rest = both_of(rest, patch_at_rest().rest, {1.0 * i, 0, 0});
    x0.middleRows(i * n, n) = patch_at_rest().rest.vertices.rowwise() + above;
    x1.middleRows(i * n, n) = x0.middleRows(i * n, n).rowwise() + motion;
  }
  const Level level = Level::of(0, rest);
  const auto beside_a_box = [&](const std::string& place) {
    const std::string box = "{name: box, meshed_shape: box, translate: " + place + "}";
    return bound({model_with("ipc, stiffness: 100", box)}, level);
  };
  BoundContacts models = beside_a_box("[0, 9, 0]");
  ActiveContacts contacts(models);
  contacts.begin_step(x0);
  REQUIRE(contacts.max_step(x0, x1).fraction == 1);
  contacts.update_lagging(x1);
  const auto friction = [&](const Positions& x) {
    Positions both = Positions::Zero(x.rows(), 3);
    contacts.add_gradient(x, both);
    return Positions(both - gradient_of(*collisions_at(*models[0], x), x));
  };
  const Positions f = friction(x1);
  REQUIRE(f.bottomRows(n).norm() > 1e-3 * f.norm());
  for (int step = 0; step < 20; ++step) {
    contacts.max_step(x1, x0);
    contacts.barrier(x0);
    contacts.begin_step(x1);  // its candidates come from another motion than before
    CHECK((friction(x1) - f).norm() <= 1e-9 * f.norm());
  }
  // Nor under a common translation, while an obstacle elsewhere moves.
  models = beside_a_box("[0, 9.1, 0]");
  const Positions x2 = x1.rowwise() + Eigen::RowVector3d(0.02, -0.01, 0.03);
  contacts.update_obstacles(models, x1, x2);
  CHECK((friction(x2) - f).norm() <= 1e-9 * f.norm());
}

TEST_CASE("Tangential displacements are relative to an obstacle that moves") {
  struct Move {
    double plate, cloth;  // to here [ε]
  };
  // Under a cloth that rests, in two moves; with the cloth, and less far than it.
  for (const auto& moves : {std::vector<Move>{{-0.2, 0.3}, {-0.4, 0.3}}, {{7, 7.3}}, {{5, 7.3}}}) {
    ActiveContacts contacts(bound({a_plate(0)}));
    Positions x = slid(0.3 * epsilon);
    step_between(contacts, slid(0), x);
    CHECK(contacts.friction(x) == Approx(potential(0.3 * epsilon)));
    double u = 0;
    for (const Move& move : moves) {
      const Positions before = std::exchange(x, slid(move.cloth * epsilon));
      contacts.update_obstacles(bound({a_plate(move.plate * epsilon)}), before, x);
      u = (move.cloth - move.plate) * epsilon;
      CHECK(contacts.advected());
      CHECK(contacts.friction(x) == Approx(potential(u)));
    }
    const auto again = [&] {
      contacts.update_obstacles(bound({a_plate(moves.back().plate * epsilon)}), x, x);
    };
    again();
    CHECK(contacts.advected());
    for (const double kept : {u, std::min(u, epsilon)}) {  // the next step limits it
      contacts.begin_step(x);
      CHECK_FALSE(contacts.advected());
      CHECK(contacts.friction(x) == Approx(potential(kept)));
    }
    again();  // another model, as of another material
    CHECK_FALSE(contacts.advected());
    CHECK(contacts.friction(x) == Approx(potential(std::min(u, epsilon))));
  }
}

TEST_CASE("Tangential displacements on a static obstacle are the cloth's own, and zero for a new contact") {
  const auto on_floor = [](double far) {  // in one model, and in two
    const std::string floor =
        "{name: floor, shape: box, size: [4, 4, 0.2], rotate: [0, 0, 33], translate: [0.7, 0.3, -0.1]}, ";
    const std::string ball =
        "{name: ball, shape: sphere, radius: 0.1, translate: [0, " + std::to_string(far) + ", 3]}";
    return std::array{bound({model_with("shapes, stiffness: 100", floor + ball)}),
                      bound({a_floor(), a_plate(far)})};
  };
  const Positions x1 = slid(0.3 * epsilon), x2 = slid(2.3 * epsilon);
  for (int k = 0; k < 2; ++k) {
    const BoundContacts before = on_floor(5)[k];
    ActiveContacts contacts(before);
    step_between(contacts, slid(0), x1);
    BoundContacts models = on_floor(5.5)[k];
    if (k == 1) models[0] = before[0];
    contacts.update_obstacles(models, x1, x2);
    CHECK(contacts.friction(x2) == Approx(potential(2.3 * epsilon)));

    ActiveContacts far(models);
    far.begin_step(at(0, 3 * dhat));
    far.update_obstacles(on_floor(6)[k], at(0, 3 * dhat), x2);
    CHECK(far.count() > 0);
    CHECK(far.friction(x2) == 0);
  }
}

TEST_CASE("The smallest of several models' steps counts, and their collisions add up") {
  const auto low = a_floor(-0.0002, "low"), high = a_floor(0, "high");
  for (const auto& order : {std::vector{low, high}, std::vector{high, low}}) {
    const auto models = bound(order);
    ActiveContacts contacts(models);
    const StepLimit limit = contacts.max_step(at(0, 0.01), at(0, -0.01));
    CHECK(limit.fraction == Approx(0.5 * 0.9));
    CHECK_THAT(limit.by, Catch::StartsWith("cloth triangle ") && Catch::EndsWith(" and high: half_space"));
    const Positions x = at(0, 0.3 * dhat);
    REQUIRE(contacts.max_step(at(0, 0.5 * dhat), x).fraction == 1);
    const auto first = collisions_at(*models[0], x), second = collisions_at(*models[1], x);
    CHECK(contacts.barrier(x) == Approx(first->value(x) + second->value(x)).epsilon(1e-12));
    CHECK(contacts.count() == first->contact_count() + second->contact_count());
    CHECK(contacts.smallest_gap() == Approx(0.3 * dhat));
    CHECK(contacts.energies(x).size() == 2);
  }
}

TEST_CASE("Between steps the stiffness rises of those models alone whose contacts press") {
  // The sheet is close above the first, half of d̂ above the second, and the third's stiffness is given.
  const auto three_floors = [] {
    return bound({a_floor(0, "floor", "shapes"), a_floor(-0.5 * dhat, "floor", "shapes"), a_floor()});
  };
  const BoundContacts models = three_floors();
  const double own = contact_stiffness(Material());
  const Positions x = at(epsilon / 2, 0.005 * dhat);
  ActiveContacts contacts(models);
  step_between(contacts, at(0, 0.005 * dhat), x);
  const double barrier_before = contacts.barrier(x), friction_before = contacts.friction(x);
  REQUIRE(friction_before > 0);
  CHECK(contacts.stiffness() == ContactStiffness{own, own, stiffness});
  CHECK(contacts.raise_stiffness(x, 1e9));
  CHECK(contacts.stiffness() == ContactStiffness{4 * own, own, stiffness});
  CHECK(contacts.barrier(x) == Approx(barrier_before + 3 * collisions_at(*models[0], x)->value(x)));
  // Lagged again, with the displacements kept; the second model's friction is small.
  CHECK(contacts.friction(x) ==
        Approx(friction_before * (4 * own + stiffness) / (own + stiffness)).epsilon(0.01));

  // Up to the bound.
  CHECK(contacts.raise_stiffness(x, 5 * own));
  CHECK_FALSE(contacts.raise_stiffness(x, 5 * own));
  CHECK(contacts.stiffness()[0] == 5 * own);

  // Kept when the obstacles move, and where it is only a lower bound.
  contacts.update_obstacles(three_floors(), x, x);
  CHECK(contacts.stiffness() == ContactStiffness{5 * own, own, stiffness});
  contacts.set_stiffness({2 * own, 2 * own, 2 * stiffness});
  CHECK(contacts.stiffness() == ContactStiffness{5 * own, 2 * own, stiffness});

  contacts.fix_stiffness();
  CHECK_FALSE(contacts.raise_stiffness(x, 1e9));
}

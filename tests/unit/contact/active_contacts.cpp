#include "core/numerics/model/active_contacts.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/numerics/contact_forces/barrier.h"
#include "core/numerics/contact_forces/contact_stiffness.h"
#include "core/numerics/model/required.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/evaluate.h"
#include "tests/support/meshes.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

constexpr double dhat = 1e-3, stiffness = 100, mu = 0.3, epsilon = 1e-4;

/// A contact model with friction and these obstacles; both are YAML.
std::shared_ptr<ContactModel> model_with(const std::string& type, const std::string& obstacles) {
  return make_plugin_from<ContactModel>("{type: " + type + ", friction: 0.3, obstacles: [" + obstacles +
                                        "]}");
}

/// The half-space below this height.
std::shared_ptr<ContactModel> a_floor(const std::string& name = "floor", double height = 0,
                                      const std::string& type = "shapes, stiffness: 100") {
  return model_with(
      type, "{name: " + name + ", shape: half_space, translate: [0, 0, " + std::to_string(height) + "]}");
}

/// A half-space whose stiffness the experiment leaves open.
std::shared_ptr<ContactModel> an_open_floor(double height) { return a_floor("floor", height, "shapes"); }

/// A box whose top is z = 0, larger than the sheet.
std::shared_ptr<ContactModel> a_plate(double x) {
  return model_with("shapes, stiffness: 100", "{name: plate, shape: box, size: [1, 1, 0.2], translate: [" +
                                                  std::to_string(x) + ", 0, -0.1]}");
}

Level sheet() { return Level::of(0, grid({0.1, 0.1}, 4, 4, Diagonals::one_way)); }

BoundContacts bound(const Level& level, const std::vector<std::shared_ptr<ContactModel>>& models) {
  BoundContacts all;
  for (const auto& model : models) all.push_back(model->bind(level, Material()));
  return all;
}

Positions at(const Level& level, double x, double height) {
  return level.rest.vertices.rowwise() + Eigen::RowVector3d(x, 0, height);
}

/// Normal force of the sheet of 0.1 m × 0.1 m at this height [N].
double normal_force(double height) { return -stiffness * barrier(height / dhat).first * 0.01; }

/// The friction potential at a tangential displacement u, over the normal force [m].
double potential(double u) {
  const double q = u / epsilon;
  return mu * (q < 1 ? u * q * (1 - q / 3) : u - epsilon / 3);
}

/// Two steps: one begins at x0, the next at x1.
void step_between(ActiveContacts& contacts, const Positions& x0, const Positions& x1) {
  contacts.begin_step(x0);
  contacts.max_step(x0, x1);
  contacts.begin_step(x1);
}

}  // namespace

TEST_CASE("Friction keeps the normal forces of the step's start until update_lagging") {
  const Level level = sheet();
  ActiveContacts contacts(bound(level, {a_floor()}));
  const Positions x0 = at(level, 0, 0.5 * dhat), x1 = at(level, 20 * epsilon, 0.3 * dhat);
  REQUIRE(normal_force(0.3 * dhat) > 1.5 * normal_force(0.5 * dhat));
  contacts.begin_step(x0);
  CHECK(contacts.has_friction());
  CHECK(contacts.friction(x0) == 0);
  REQUIRE(contacts.max_step(x0, x1).fraction == 1);
  CHECK(contacts.friction(x1) == Approx(normal_force(0.5 * dhat) * potential(20 * epsilon)));
  contacts.update_lagging(x1);  // the reference is still x0
  CHECK(contacts.friction(x1) == Approx(normal_force(0.3 * dhat) * potential(20 * epsilon)));
  Positions g = Positions::Zero(x1.rows(), 3);
  const double sum = contacts.add_gradient(x1, g);
  CHECK(sum == Approx(contacts.barrier(x1) + contacts.friction(x1)));
  CHECK(g.col(0).sum() == Approx(mu * normal_force(0.3 * dhat)));
  CHECK(-g.col(2).sum() == Approx(normal_force(0.3 * dhat)));
}

TEST_CASE("After a reset, contacts at a state do not depend on the states before it") {
  const Level level = sheet();
  const Positions far = at(level, 0, 0.5), x0 = at(level, 0, 0.5 * dhat),
                  x1 = at(level, 20 * epsilon, 0.5 * dhat);
  ActiveContacts contacts(bound(
      level, {model_with("ipc, stiffness: 100",
                         "{name: plate, meshed_shape: box, size: [1, 1, 0.2], translate: [0, 0, -0.1]}")}));
  contacts.begin_step(far);
  REQUIRE(contacts.count() == 0);
  for (const Positions& x : {x0, x1}) {
    contacts.reset();
    contacts.begin_step(x);
    CHECK(contacts.count() > 0);
    CHECK(contacts.barrier(x) > 0);
    CHECK(contacts.friction(x) == 0);
  }
}

TEST_CASE("Tangential displacements persist between steps, limited to the smoothing distance") {
  const Level level = sheet();
  ActiveContacts contacts(bound(level, {a_floor()}));
  const double height = 0.4 * dhat, force = normal_force(height);
  const auto step_to = [&](double from, double to) {
    REQUIRE(contacts.max_step(at(level, from, height), at(level, to, height)).fraction == 1);
    contacts.begin_step(at(level, to, height));
    return contacts.friction(at(level, to, height)) / force;
  };
  contacts.begin_step(at(level, 0, height));
  // Sticking: three steps of 0.3 ε add up.
  CHECK(step_to(0, 0.3 * epsilon) == Approx(potential(0.3 * epsilon)));
  CHECK(step_to(0.3 * epsilon, 0.6 * epsilon) == Approx(potential(0.6 * epsilon)));
  CHECK(step_to(0.6 * epsilon, 0.9 * epsilon) == Approx(potential(0.9 * epsilon)));
  // Sliding: a displacement of ε is kept, where friction is at its maximum.
  CHECK(step_to(0.9 * epsilon, 7 * epsilon) == Approx(potential(epsilon)));
  Positions g = Positions::Zero(level.vertex_count(), 3);
  contacts.add_gradient(at(level, 7 * epsilon, height), g);
  CHECK(g.col(0).sum() == Approx(mu * force));
  // Back by ε / 2.
  CHECK(step_to(7 * epsilon, 6.5 * epsilon) == Approx(potential(0.5 * epsilon)));
  // After a loss of contact nothing is kept.
  const Positions up = at(level, 6.5 * epsilon, 5 * dhat), elsewhere = at(level, 50 * epsilon, 5 * dhat);
  contacts.max_step(at(level, 6.5 * epsilon, height), up);
  contacts.begin_step(up);
  contacts.max_step(up, elsewhere);
  contacts.begin_step(elsewhere);
  CHECK_FALSE(contacts.has_friction());
  contacts.max_step(elsewhere, at(level, 50 * epsilon, height));
  contacts.begin_step(at(level, 50 * epsilon, height));
  CHECK(contacts.has_friction());
  CHECK(contacts.friction(at(level, 50 * epsilon, height)) == Approx(0).margin(1e-12));
}

TEST_CASE("Ten layers that stick to each other do not creep") {
  constexpr int layers = 10, columns = 4, n = columns * columns;
  TriangleMesh rest;
  const TriangleMesh one = grid({0.1, 0.1}, columns, columns, Diagonals::one_way);
  Positions x0(layers * n, 3), x1(layers * n, 3);
  for (int i = 0; i < layers; ++i) {
    const Eigen::RowVector3d apart(i, 0, 0), above(1e-3 * i, 2e-3 * i, 0.3 * dhat * i),
        slid(0.4 * epsilon * i, 0.1 * epsilon * (i % 3), 0);
    rest = both_of(rest, one, apart);
    x0.middleRows(i * n, n) = one.vertices.rowwise() + above;
    x1.middleRows(i * n, n) = x0.middleRows(i * n, n).rowwise() + slid;
  }
  const Level level = Level::of(0, rest);
  const auto beside_a_box = [&](const std::string& place) {
    return bound(level, {model_with("ipc, stiffness: 100",
                                    "{name: box, meshed_shape: box, translate: " + place + "}")});
  };
  BoundContacts models = beside_a_box("[0, 9, 0]");
  ActiveContacts contacts(models);
  contacts.begin_step(x0);
  REQUIRE(contacts.max_step(x0, x1).fraction == 1);
  contacts.update_lagging(x1);
  const auto friction = [&](const Positions& x) {
    Positions both = Positions::Zero(x.rows(), 3), barrier = both;
    contacts.add_gradient(x, both);
    collisions_at(*models[0], x)->add_gradient(x, barrier);
    return Positions(both - barrier);
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

TEST_CASE("Tangential displacements are advected by obstacle motion") {
  const Level level = sheet();
  const double height = 0.4 * dhat, force = normal_force(height);
  const Positions x0 = at(level, 0, height), x1 = at(level, 0.3 * epsilon, height);
  // The sheet slides on a plate, which then moves in the opposite direction, twice by 0.2 ε.
  ActiveContacts contacts(bound(level, {a_plate(0)}));
  step_between(contacts, x0, x1);
  CHECK(contacts.friction(x1) == Approx(force * potential(0.3 * epsilon)));
  for (const double moved : {-0.2 * epsilon, -0.4 * epsilon}) {
    contacts.update_obstacles(bound(level, {a_plate(moved)}), x1, x1);
    CHECK(contacts.advected());
    CHECK(contacts.friction(x1) == Approx(force * potential(0.3 * epsilon - moved)));
  }
  contacts.update_obstacles(bound(level, {a_plate(-0.4 * epsilon)}), x1, x1);  // the same again
  CHECK(contacts.advected());
  contacts.begin_step(x1);  // the cloth has not moved yet
  CHECK_FALSE(contacts.advected());
  CHECK(contacts.friction(x1) == Approx(force * potential(0.7 * epsilon)));
  contacts.begin_step(x1);
  CHECK(contacts.friction(x1) == Approx(force * potential(0.7 * epsilon)));
  contacts.update_obstacles(bound(level, {a_plate(-0.4 * epsilon)}), x1,
                            x1);  // another model, as of another material
  CHECK_FALSE(contacts.advected());
  CHECK(contacts.friction(x1) == Approx(force * potential(0.7 * epsilon)));
}

TEST_CASE("A moving cloth's tangential displacements are relative to the obstacle") {
  const Level level = sheet();
  const double height = 0.4 * dhat, force = normal_force(height);
  const Positions x0 = at(level, 0, height), x1 = at(level, 0.3 * epsilon, height);
  for (const auto& [obstacle_motion, expected] :
       {std::pair(7 * epsilon, 0.3 * epsilon), std::pair(5 * epsilon, 2.3 * epsilon)}) {
    ActiveContacts contacts(bound(level, {a_plate(0)}));
    step_between(contacts, x0, x1);
    const Positions x2 = at(level, 7.3 * epsilon, height);
    contacts.update_obstacles(bound(level, {a_plate(obstacle_motion)}), x1, x2);
    CHECK(contacts.friction(x2) == Approx(force * potential(expected)));
    contacts.begin_step(x2);
    CHECK(contacts.friction(x2) == Approx(force * potential(expected)));
  }
}

TEST_CASE("Tangential displacements on a static obstacle are the cloth's own, and zero for a new contact") {
  const Level level = sheet();
  const double height = 0.4 * dhat, force = normal_force(height);
  const auto on_floor = [&](double far) {  // in one model, and in two
    return std::array{
        bound(level,
              {model_with("shapes, stiffness: 100",
                          "{name: floor, shape: box, size: [4, 4, 0.2], rotate: [0, 0, 33], translate: [0.7, "
                          "0.3, -0.1]}, {name: ball, shape: sphere, radius: 0.1, translate: [0, " +
                              std::to_string(far) + ", 3]}")}),
        bound(level, {a_floor(), a_plate(far)})};
  };
  const Positions x1 = at(level, 0.3 * epsilon, height), x2 = at(level, 2.3 * epsilon, height);
  for (int k = 0; k < 2; ++k) {
    const BoundContacts before = on_floor(5)[k];
    ActiveContacts contacts(before);
    step_between(contacts, at(level, 0, height), x1);
    BoundContacts models = on_floor(5.5)[k];
    if (k == 1) models[0] = before[0];
    contacts.update_obstacles(models, x1, x2);
    CHECK(contacts.friction(x2) == Approx(force * potential(2.3 * epsilon)));

    ActiveContacts far(models);
    far.begin_step(at(level, 0, 3 * dhat));
    far.update_obstacles(on_floor(6)[k], at(level, 0, 3 * dhat), x2);
    CHECK(far.count() > 0);
    CHECK(far.friction(x2) == 0);
  }
}

TEST_CASE("The smallest of several models' steps counts, and their collisions add up") {
  const Level level = sheet();
  const auto low = a_floor("low", -0.0002), high = a_floor("high", 0);
  for (const auto& order : {std::vector{low, high}, std::vector{high, low}}) {
    const auto models = bound(level, order);
    ActiveContacts contacts(models);
    const Positions x0 = at(level, 0, 0.01), x1 = at(level, 0, -0.01);
    const StepLimit limit = contacts.max_step(x0, x1);
    CHECK(limit.fraction == Approx(0.5 * 0.9));
    CHECK_THAT(limit.by, Catch::StartsWith("cloth triangle ") && Catch::EndsWith(" and high: half_space"));
    const Positions x = at(level, 0, 0.3 * dhat);
    REQUIRE(contacts.max_step(at(level, 0, 0.5 * dhat), x).fraction == 1);
    double expected = 0;
    int count = 0;
    for (const auto& model : models) {
      const auto collisions = collisions_at(*model, x);
      expected += collisions->value(x);
      count += collisions->contact_count();
    }
    CHECK(contacts.barrier(x) == Approx(expected).epsilon(1e-12));
    CHECK(contacts.count() == count);
    CHECK(contacts.smallest_gap() == Approx(0.3 * dhat));
    CHECK(contacts.energies(x).size() == 2);
  }
}

TEST_CASE("The objective's derivatives with limits, contact and friction") {
  // A sheet rolled over a ball until its ends are within d̂ of each other's layer below.
  const Solved s = scene_from(R"(
name: all
cloth: {shape: rectangle, size: [0.3, 0.2], triangulation: random, vertices: 30}
levels: 1
material: {thickness: 1e-3, membrane_modulus: 1e3, bending_modulus: 1e6}
start: {translate: [-0.15, -0.1, 0.109], perturbation: 3e-3}
energies: [neo_hookean, hinge, {type: strain_limit, limit: 1.3, stiffness: 100}, gravity]
contact:
  - {type: ipc, dhat: 0.02, stiffness: 20, friction_smoothing_distance: 1e-3}
  - {type: shapes, dhat: 0.02, stiffness: 20, friction_smoothing_distance: 1e-3}
obstacles:
  - {name: shelf, meshed_shape: box, size: [0.05, 0.3, 0.1], translate: [0.12, 0, 0.05]}
  - {name: ball, shape: sphere, radius: 0.1}
friction: 0.4
methods: {newton: {}}
)");
  const LevelModel& model = s.model();
  REQUIRE(model.contacts().size() == 2);
  REQUIRE(model.limits().size() == 1);
  PlainObjective objective(model);
  const Positions& start = s.scene->starts[0];
  Positions x = start;
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    x.row(i) += Eigen::RowVector3d(0.04 * x(i, 0) + 2e-3, 0.1 * x(i, 1), -1e-3 * std::sin(40.0 * i));
  objective.contacts().begin_step(start);
  REQUIRE(objective.max_step(start, x).fraction == 1);
  REQUIRE(objective.contacts().friction(x) > 0);
  REQUIRE(objective.contacts().barrier(x) > 0);
  for (const auto& contact : model.contacts()) REQUIRE(collisions_at(*contact, x)->contact_count() > 3);
  REQUIRE(model.limits()[0]->value(x) > 0);

  const auto value = [&](const Positions& y) {
    REQUIRE(objective.max_step(x, y).fraction == 1);
    return value_of(objective, y);
  };
  const auto gradient = [&](const Positions& y) {
    REQUIRE(objective.max_step(x, y).fraction == 1);
    Positions g;
    objective.gradient(y, g);
    return g;
  };
  const Positions g = gradient(x);
  const Eigen::MatrixXd h = dense(objective.matrix(x, Projection::none));
  REQUIRE(g.norm() > 0);
  CHECK((differences(value, x, 1e-6) - flat(g).transpose()).norm() <= 1e-6 * g.norm());
  CHECK((differences(gradient, x, 1e-6) - h).norm() <= 1e-5 * h.norm());
  // All parts are in it: leaving one out is noticed.
  CHECK(objective.plain_energy(x) == Approx(value_of(objective, x) - objective.contacts().friction(x)));
  BlockMatrix smooth(model.pattern());
  model.hessian(x, Projection::none, smooth);
  CHECK((dense(smooth) - h).norm() > 1e-2 * h.norm());
}

TEST_CASE("A start beyond the strain limit is named, and what to do about it") {
  const auto solved = [](const std::string& start) {
    return solve_yaml(start + R"(
name: stretched
cloth: {shape: square, side: 0.1, columns: 3, rows: 3}
levels: 1
energies: [neo_hookean, {type: strain_limit, limit: 1.1}, gravity]
methods: {newton: {}}
)")
        .levels.back();
  };
  const LevelResult scaled = solved("start: {scale: [1.2, 1, 1]}");
  CHECK(scaled.outcome == Outcome::infeasible);
  CHECK(scaled.message ==
        "energy or forces at the start are not finite: triangle 0, stretched to 1.2 (limit 1.1) and 7 more; "
        "start nearer to the rest shape, or raise the limit");
  CHECK_THAT(solved("pins: [{point: [0, 0, 0], translate: [-0.1, 0, 0]}]").message,
             Catch::EndsWith("; pinned vertices begin at their targets: a schedule moves pins far"));
}

TEST_CASE("Between steps the stiffness rises of those models alone whose contacts press") {
  const Level level = sheet();
  // The sheet is close above the first, half of d̂ above the second, and the third's stiffness is given.
  const BoundContacts models = bound(level, {an_open_floor(0), an_open_floor(-0.5 * dhat), a_floor()});
  const double own = contact_stiffness(Material());
  const Positions x0 = at(level, 0, 0.005 * dhat), x1 = at(level, epsilon / 2, 0.005 * dhat);
  ActiveContacts contacts(models);
  step_between(contacts, x0, x1);
  const double barrier_before = contacts.barrier(x1), friction_before = contacts.friction(x1),
               first = collisions_at(*models[0], x1)->value(x1);
  REQUIRE(friction_before > 0);
  CHECK(contacts.stiffness() == ContactStiffness{own, own, stiffness});
  CHECK(contacts.raise_stiffness(x1, 1e9));
  CHECK(contacts.stiffness() == ContactStiffness{4 * own, own, stiffness});
  CHECK(contacts.barrier(x1) == Approx(barrier_before + 3 * first));
  // Lagged again, with the displacements kept; the second model's friction is small.
  CHECK(contacts.friction(x1) ==
        Approx(friction_before * (4 * own + stiffness) / (own + stiffness)).epsilon(0.01));

  // Up to the bound.
  CHECK(contacts.raise_stiffness(x1, 5 * own));
  CHECK_FALSE(contacts.raise_stiffness(x1, 5 * own));
  CHECK(contacts.stiffness()[0] == 5 * own);

  // Kept when the obstacles move, and where it is only a lower bound.
  contacts.update_obstacles(bound(level, {an_open_floor(0), an_open_floor(-0.5 * dhat), a_floor()}), x1, x1);
  CHECK(contacts.stiffness() == ContactStiffness{5 * own, own, stiffness});
  contacts.set_stiffness({2 * own, 2 * own, 2 * stiffness});
  CHECK(contacts.stiffness() == ContactStiffness{5 * own, 2 * own, stiffness});

  contacts.fix_stiffness();
  CHECK_FALSE(contacts.raise_stiffness(x1, 1e9));
}

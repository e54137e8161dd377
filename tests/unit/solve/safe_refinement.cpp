#include "core/numerics/solve/safe_refinement.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/numerics/contact_forces/friction.h"
#include "core/numerics/model/stretch_limit.h"
#include "core/numerics/patterns/generate.h"
#include "core/numerics/solve/newton_state.h"
#include "core/numerics/solve/progression.h"
#include "tests/support/registry.h"
#include "tests/support/test_energies.h"

using namespace drape;

namespace {

using Plugins = std::vector<std::string>;

/// A cloth on two levels, refined by Loop's weights, with pins, contact and limits on both.
struct TwoLevels : Problem {
  Hierarchy levels;
  std::vector<NamedEnergy> energies_;
  std::vector<std::shared_ptr<ContactModel>> contacts_;

  TwoLevels(const TriangleMesh& coarse, const Plugins& contacts, const Plugins& energies = {},
            const std::vector<int>& pins = {})
      : Problem{levels, {}, {}, nullptr},
        levels(Hierarchy::of(coarse, *make_plugin_from<Refiner>("loop"), 2)) {
    for (const std::string& energy : energies)
      energies_.push_back({energy, make_plugin_from<Energy>(energy)});
    for (const std::string& contact : contacts) contacts_.push_back(make_plugin_from<ContactModel>(contact));
    for (const Level& level : hierarchy.levels) {
      std::vector<DirichletVertex> dirichlet;
      for (const int v : pins) dirichlet.push_back({v, level.rest.vertices.row(v), 0});
      models.push_back(
          std::make_shared<const LevelModel>(level, Material(), energies_, std::move(dirichlet), contacts_));
      starts.push_back(level.rest.vertices);
    }
  }
  /// Replaces the Dirichlet vertices of the finer level.
  void prescribe(std::vector<DirichletVertex> dirichlet) {
    models[1] = std::make_shared<const LevelModel>(hierarchy.levels[1], Material(), energies_,
                                                   std::move(dirichlet), contacts_);
  }

  Positions target(const Positions& x) const { return hierarchy.prolongations[0] * x; }
  Positions midpoint(const Positions& x) const { return hierarchy.midpoints[0] * x; }

  LevelResult refine(const Positions& x) const {
    Observer silent;
    return refine_safely(*this, 0, x, hierarchy.prolongations[0], Stopwatch(), silent);
  }
  /// The refined state, which is to be free of intersections and violations.
  Positions refined(const Positions& x) const {
    const LevelResult result = refine(x);
    CAPTURE(result.message);
    CHECK(result.message.empty());
    CHECK(intersections(1, result.x) == 0);
    CHECK(violations(1, result.x) == 0);
    return result.x;
  }
  std::size_t intersections(int level, const Positions& x) const {
    std::size_t count = 0;
    for (const auto& contact : models[level]->contacts()) count += contact->intersections(x).size();
    return count;
  }
  std::size_t violations(int level, const Positions& x) const {
    std::size_t count = 0;
    for (const BoundEnergy* limit : models[level]->limits())
      count += limit->stretch_limit()->violations(x).size();
    return count;
  }
};

double largest_distance(const Positions& x, const Positions& y) {
  return (x - y).rowwise().norm().maxCoeff();
}

const std::string ball_contact = "{type: shapes, obstacles: [{name: ball, shape: sphere, radius: 0.3}]}";

TriangleMesh square(double side, int n) { return grid({side, side}, n, n, Diagonals::one_way); }

/// A square that lies on a dome around the ball, as low as its triangles can without touching it.
Positions over_the_ball(const TwoLevels& cloth) {
  const Positions& rest = cloth.hierarchy.levels[0].rest.vertices;
  const Eigen::RowVector3d centroid = rest.colwise().mean();
  const auto dome = [&](double radius) {
    Positions x(rest.rows(), 3);
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const Eigen::RowVector3d from_centroid = rest.row(i) - centroid;
      const double along = from_centroid.norm() / 0.32;  // an angle: the sheet is wrapped, not pressed flat
      x.row(i) = radius * std::sin(along) * from_centroid.normalized();
      x(i, 2) = radius * std::cos(along);
    }
    return x;
  };
  double low = 0.3, high = 0.4;
  for (int k = 0; k < 40; ++k) {
    const double radius = 0.5 * (low + high);
    (cloth.intersections(0, dome(radius)) > 0 ? low : high) = radius;
  }
  return dome(high + 1e-4);
}

/// A sheet along y whose x–z profile is a tent, then goes back below it and up to just under its ridge.
Positions tent_over_its_own_end(const Positions& rest, double gap) {
  const double profile[13][2] = {{-.3, 0},  {-.2, .1}, {-.1, .2}, {0, .3}, {.1, .2}, {.2, .1},     {.3, 0},
                                 {.2, -.1}, {.1, -.1}, {0, 0},    {0, .1}, {0, .2},  {0, .3 - gap}};
  Positions x = rest;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const auto column = static_cast<int>(std::lround(rest(i, 0) / 0.1));
    x(i, 0) = profile[column][0];
    x(i, 2) = profile[column][1];
  }
  return x;
}

TriangleMesh thirteen_columns() { return grid({1.2, 0.4}, 13, 5, Diagonals::one_way); }

/// Pins the corner of a sheet of 9×9 vertices on the finer level, and the midpoint of an edge there, which
/// has no vertex on the coarse level; returns the midpoint.
int pin_beside_the_corner(TwoLevels& cloth) {
  const Positions& fine = cloth.starts[1];
  int midpoint = 0;
  while (fine.row(midpoint) != Eigen::RowVector3d(1.0 / 16, 0, 0)) REQUIRE(++midpoint < fine.rows());
  cloth.prescribe({{0, fine.row(0), 0}, {midpoint, fine.row(midpoint), 0}});
  return midpoint;
}

/// Both levels, each under its own energy.
std::vector<LevelResult> cascaded(const TwoLevels& cloth, Observer&& observer = Observer()) {
  Progression cascade;
  cascade.newton.max_steps = 50;
  return cascade.solve(cloth, observer);
}

}  // namespace

TEST_CASE("If contact and limits allow, the refined state is the prolonged one, with pins at their targets") {
  for (const auto& [contacts, energy] :
       {std::pair(Plugins(), "neo_hookean"), {{ball_contact, "ipc"}, "{type: strain_limit, limit: 1.5}"}}) {
    TwoLevels cloth(square(0.6, 5), contacts, {energy}, {7});
    Positions x = cloth.starts[0];
    for (Eigen::Index i = 0; i < x.rows(); ++i) x(i, 2) = 0.5 + 0.02 * std::sin(3.0 * i);  // over the ball
    Positions expected = cloth.target(x);
    REQUIRE(largest_distance(expected, cloth.midpoint(x)) > 1e-3);
    expected(7, 2) += 0.01;
    cloth.prescribe({{7, expected.row(7), 0}});
    const LevelResult refined = cloth.refine(x);
    CHECK(refined.message.empty());
    CHECK(refined.iterations == 0);
    // Up to round-off of coordinates of a metre: the sums may round otherwise than the library's.
    CHECK(largest_distance(refined.x, expected) < 1e-15);
  }
}

TEST_CASE("A sheet around a ball is refined without touching it") {
  const TwoLevels cloth(square(0.6, 9), {ball_contact});
  const Positions x = over_the_ball(cloth), target = cloth.target(x);
  REQUIRE(cloth.intersections(0, x) == 0);
  REQUIRE(cloth.intersections(1, target) > 20);
  // No vertex is further from its target than the ball and d̂ require.
  double deepest = 0;
  for (const auto& t : cloth.hierarchy.levels[1].rest.triangles.rowwise())
    deepest = std::max(deepest, 0.3 - (target.row(t[0]) + target.row(t[1]) + target.row(t[2])).norm() / 3);
  REQUIRE(deepest > 5e-4);
  const double away = largest_distance(cloth.refined(x), target);
  CHECK(away < deepest + 2e-3);
  CHECK(away < largest_distance(cloth.midpoint(x), target));
}

TEST_CASE("A fold that would be smoothed through another layer is refined beside it") {
  const TwoLevels cloth(thirteen_columns(), {"ipc"});
  const Positions x = tent_over_its_own_end(cloth.starts[0], 2e-3), target = cloth.target(x);
  REQUIRE(cloth.intersections(0, x) == 0);
  REQUIRE(cloth.intersections(1, target) > 5);
  const Positions refined = cloth.refined(x);
  const Positions& rest = cloth.hierarchy.levels[1].rest.vertices;
  // Away from the ridge and the end below it, nothing keeps the sheet from its target.
  double near = 0, far = 0;
  for (Eigen::Index i = 0; i < rest.rows(); ++i) {
    const bool at_ridge = std::abs(rest(i, 0) - 0.3) < 0.06 || rest(i, 0) > 1.14;
    double& away = at_ridge ? near : far;
    away = std::max(away, (refined.row(i) - target.row(i)).norm());
  }
  CHECK(far < 2e-4);
  CHECK(near > 2e-3);  // contact pushes it away
  CHECK(near < 0.03);
}

TEST_CASE("Friction does not act during refinement") {
  const std::string with_friction = "{type: ipc, friction: 1}";
  const TwoLevels slippery(thirteen_columns(), {"ipc"}), rough(thirteen_columns(), {with_friction});
  const Positions x = tent_over_its_own_end(slippery.starts[0], 0.9e-3);
  const auto& contact = rough.models[0]->contacts().at(0);
  REQUIRE(lagged_friction(*contact->build_candidates(x, x)->build_collisions(x), x, {}));
  CHECK(slippery.refine(x).x == rough.refine(x).x);
}

TEST_CASE("A stretched disc is refined within its strain limit, although refinement rounds its border") {
  const TwoLevels cloth(disc(0.3, 60), {}, {"{type: strain_limit, limit: 1.06}"});
  Positions x = 1.04 * cloth.starts[0];
  for (Eigen::Index i = 0; i < x.rows(); ++i) x(i, 2) = 0.01 * std::sin(8 * x(i, 0)) * std::cos(7 * x(i, 1));
  REQUIRE(cloth.violations(0, x) == 0);
  REQUIRE(cloth.violations(1, cloth.midpoint(x)) > 5);
  const double away = largest_distance(cloth.refined(x), cloth.target(x));
  CHECK(away < 2e-3);
  CHECK(away < 0.5 * largest_distance(cloth.midpoint(x), cloth.target(x)));
}

TEST_CASE("Triangles that cannot be within the strain limit are named, and the level starts anew") {
  // Fine vertices 0 and 1 are two fine edges apart; their targets 1.5 times as far.
  TwoLevels cloth(square(0.4, 5), {}, {"{type: strain_limit, limit: 1.1}"}, {0, 1});
  const Eigen::Vector3d pin_target(0.15, 0, 0);
  cloth.prescribe({{0, cloth.starts[1].row(0), 0}, {1, pin_target, 1}});
  const LevelResult refined = cloth.refine(cloth.starts[0]);
  CHECK(refined.x.row(1) == pin_target.transpose());
  REQUIRE(cloth.violations(1, refined.x) > 0);
  const auto& limit = *cloth.models[1]->limits()[0]->stretch_limit();
  const std::string violates = "the refined state violates the strain limit: ";
  CHECK_THAT(refined.message, Catch::StartsWith(violates + to_string(limit.violations(refined.x)[0], 1.1)));

  const std::vector<LevelResult> results = cascaded(cloth);
  REQUIRE(results.size() == 2);
  CHECK(results[0].message.empty());
  CHECK_FALSE(results[1].from_initial_state);       // the attempt counts as cost
  CHECK(results[1].outcome != Outcome::converged);  // the pins still tear at it
  CHECK_THAT(results[1].message,
             Catch::Matches(violates + "triangle .*; the level starts from the scene's start instead; .*"));
  CHECK(cloth.violations(1, results[1].x) == 0);

  struct Stopped : Observer {
    void level_started(int level) override { stop = level == 1; }
    bool stop_requested() override { return stop; }
    bool stop = false;
  };
  const LevelResult attempt = cascaded(cloth, Stopped()).at(1);  // what it factorises counts as its level's
  CHECK(attempt.iterations == 0);
  CHECK(attempt.factorisations > 0);
  CHECK(attempt.analyses > 0);
  CHECK(attempt.flops > 1000);
}

TEST_CASE("A refinement whose steps are cut to nothing fails after few of them") {
  TwoLevels cloth(square(1, 5), {}, {"{type: strain_limit, limit: 1.06}"});
  cloth.energies_.push_back({"jam", energy_of(Limiter(1e-5), EnergyRole::limit)});
  cloth.prescribe({});
  const LevelResult refined = cloth.refine(1.5 * cloth.starts[0]);
  CHECK(refined.iterations > 10);
  CHECK(refined.iterations < 60);
  CHECK_THAT(refined.message, Catch::StartsWith("the refined state violates the strain limit: "));
}

TEST_CASE("The cloth follows a vertex that is pinned on the finer level alone, within its strain limit") {
  for (const double degrees : {10.0, 40.0, 70.0}) {
    CAPTURE(degrees);
    TwoLevels cloth(square(1, 9), {}, {"{type: strain_limit, limit: 1.0608}"}, {0});
    const int midpoint = pin_beside_the_corner(cloth);
    const Eigen::AngleAxisd turn(-degrees * M_PI / 180, Eigen::Vector3d::UnitZ());
    const Positions refined = cloth.refined(cloth.starts[0] * turn.matrix());
    CHECK(refined.row(midpoint) == cloth.starts[1].row(midpoint));
  }
}

TEST_CASE("A pin that cannot reach its target moves there as far as contact allows") {
  TwoLevels cloth(square(0.4, 5), {ball_contact}, {}, {12});
  for (Positions& start : cloth.starts) start.rowwise() += Eigen::RowVector3d(-0.2, -0.2, 0.31);
  Eigen::Vector3d target = cloth.starts[1].row(12);
  target.z() = 0.2;
  cloth.prescribe({{12, target, 0}});
  const double height = cloth.refined(cloth.starts[0])(12, 2);
  CHECK(height > 0.3);
  CHECK(height < 0.31 - 1e-3);
}

TEST_CASE("A level whose prolonged state an energy does not allow starts from the scene's start") {
  TwoLevels cloth(
      square(1, 9), {},
      {"neo_hookean", "hinge", "gravity",
       "{type: formula, density: \"-log(1 - max(s1-1,0)^2/0.36) - log(1 - max(s2-1,0)^2/0.36)\"}"},
      {0});
  pin_beside_the_corner(cloth);
  const LevelResult finer = cascaded(cloth).at(1);
  CHECK(finer.outcome != Outcome::infeasible);
  CHECK_THAT(finer.message,
             Catch::StartsWith("the refined state is outside the domain of an energy; the level starts"));
}

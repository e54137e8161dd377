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

using namespace drape;

namespace {

/// A cloth on two levels, refined by Loop's weights, with pins, contact and limits on both.
struct TwoLevels : Problem {
  Hierarchy levels;
  std::vector<NamedEnergy> energies_;
  std::vector<std::shared_ptr<ContactModel>> contacts_;

  TwoLevels(const TriangleMesh& coarse, const std::vector<std::string>& contacts,
            const std::vector<std::string>& energies = {}, const std::vector<int>& pins = {})
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

/// A contact model that lets the cloth move by no more than a hundred-thousandth of any step, and counts
/// them.
class Jam : public ContactModel {
 public:
  struct Candidates : CollisionCandidates {
    std::unique_ptr<CollisionCandidates> own;
    StepLimit max_step() const override { return {1e-5, "the jam"}; }
    std::unique_ptr<Collisions> build_collisions(const Positions& x) const override {
      return own->build_collisions(x);
    }
  };
  struct Bound : BoundContact {
    std::unique_ptr<BoundContact> own;
    std::shared_ptr<int> motions;
    std::unique_ptr<CollisionCandidates> build_candidates(const Positions& x0,
                                                          const Positions& x1) const override {
      ++*motions;
      auto candidates = std::make_unique<Candidates>();
      candidates->own = own->build_candidates(x0, x1);
      return candidates;
    }
    std::vector<Intersection> intersections(const Positions& x) const override {
      return own->intersections(x);
    }
    std::vector<TriangleMesh> obstacles() const override { return {}; }
  };

  std::unique_ptr<BoundContact> bind(const Level& level, const Material& material) const override {
    auto bound = std::make_unique<Bound>();
    bound->own = make_plugin_from<ContactModel>("ipc")->bind(level, material);
    bound->motions = motions_;
    return bound;
  }
  int motions() const { return *motions_; }

 private:
  std::shared_ptr<int> motions_ = std::make_shared<int>(0);
};

double largest_distance(const Positions& x, const Positions& y) {
  return (x - y).rowwise().norm().maxCoeff();
}

/// Of coordinates of a metre [m]: the tests' sums may round otherwise than the library's.
constexpr double rounding = 1e-15;

const std::string ball_contact = "{type: shapes, obstacles: [{name: ball, shape: sphere, radius: 0.3}]}";

/// A square that lies on a dome around the ball, as low as its triangles can without touching it.
Positions over_the_ball(const TwoLevels& cloth) {
  const Positions& rest = cloth.hierarchy.levels[0].rest.vertices;
  const Eigen::RowVector3d centroid = rest.colwise().mean();
  const auto dome = [&](double radius) {
    Positions x(rest.rows(), 3);
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const Eigen::RowVector3d from_centroid = rest.row(i) - centroid;
      const double along = from_centroid.norm() / 0.32;  // an angle: the sheet is wrapped, not pressed flat
      x.row(i) = radius * (along > 0 ? std::sin(along) / from_centroid.norm() : 0) * from_centroid;
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

TEST_CASE("Without contact and limits the refined state is the prolonged one, with pins at their targets") {
  TwoLevels cloth(grid({1, 1}, 5, 5, Diagonals::one_way), {}, {"neo_hookean"}, {7});
  Eigen::Vector3d target = cloth.starts[1].row(7);
  target.z() = 0.25;
  cloth.prescribe({{7, target, 0}});
  Positions x = cloth.starts[0];
  for (Eigen::Index i = 0; i < x.rows(); ++i) x(i, 2) = std::sin(3.0 * i);
  const LevelResult refined = cloth.refine(x);
  CHECK(refined.message.empty());
  CHECK(refined.iterations == 0);
  Positions expected = cloth.target(x);
  REQUIRE(expected(7, 2) != 0.25);
  expected(7, 2) = 0.25;
  CHECK(largest_distance(refined.x, expected) < rounding);
}

TEST_CASE("If contact and limits allow, the refined state is the prolonged one") {
  const TwoLevels cloth(grid({0.6, 0.6}, 5, 5, Diagonals::one_way), {ball_contact, "ipc"},
                        {"{type: strain_limit, limit: 1.5}"});
  Positions x = cloth.starts[0];
  for (Eigen::Index i = 0; i < x.rows(); ++i) x(i, 2) = 0.5 + 0.02 * std::sin(3.0 * i);  // over the ball
  REQUIRE(largest_distance(cloth.target(x), cloth.midpoint(x)) > 1e-3);
  REQUIRE(cloth.violations(1, cloth.target(x)) == 0);
  const LevelResult refined = cloth.refine(x);
  CHECK(refined.message.empty());
  CHECK(refined.iterations == 0);
  CHECK(largest_distance(refined.x, cloth.target(x)) < rounding);
}

TEST_CASE("A sheet around a ball is refined without touching it") {
  const TwoLevels cloth(grid({0.6, 0.6}, 9, 9, Diagonals::one_way), {ball_contact});
  const Positions x = over_the_ball(cloth), target = cloth.target(x);
  REQUIRE(cloth.intersections(0, x) == 0);
  REQUIRE(cloth.intersections(1, target) > 20);
  const LevelResult refined = cloth.refine(x);
  CHECK(refined.message.empty());
  CHECK(refined.iterations > 0);
  CHECK(cloth.intersections(1, refined.x) == 0);
  // No vertex is further from its target than the ball and d̂ require.
  double deepest = 0;
  for (const auto& t : cloth.hierarchy.levels[1].rest.triangles.rowwise())
    deepest = std::max(deepest, 0.3 - (target.row(t[0]) + target.row(t[1]) + target.row(t[2])).norm() / 3);
  REQUIRE(deepest > 5e-4);
  CHECK(largest_distance(refined.x, target) < deepest + 2e-3);
  CHECK(largest_distance(refined.x, target) < largest_distance(cloth.midpoint(x), target));
}

TEST_CASE("A fold that would be smoothed through another layer is refined beside it") {
  const TwoLevels cloth(thirteen_columns(), {"ipc"});
  const Positions x = tent_over_its_own_end(cloth.starts[0], 2e-3), target = cloth.target(x);
  REQUIRE(cloth.intersections(0, x) == 0);
  REQUIRE(cloth.intersections(1, target) > 5);
  const LevelResult refined = cloth.refine(x);
  CHECK(refined.message.empty());
  CHECK(cloth.intersections(1, refined.x) == 0);
  // Away from the ridge and the end below it, nothing keeps the sheet from its target.
  const Positions& rest = cloth.hierarchy.levels[1].rest.vertices;
  double near = 0, far = 0;
  for (Eigen::Index i = 0; i < rest.rows(); ++i) {
    const double away = (refined.x.row(i) - target.row(i)).norm();
    const bool at_ridge = std::abs(rest(i, 0) - 0.3) < 0.06 || rest(i, 0) > 1.14;
    (at_ridge ? near : far) = std::max(at_ridge ? near : far, away);
  }
  CHECK(far < 2e-4);
  CHECK(near > 2e-3);  // contact pushes it away
  CHECK(near < 0.03);
}

TEST_CASE("Friction does not act during refinement") {
  const TwoLevels slippery(thirteen_columns(), {"ipc"}),
      rough(thirteen_columns(), {"{type: ipc, friction: 1}"});
  const Positions x = tent_over_its_own_end(slippery.starts[0], 0.9e-3);
  const auto model = make_plugin_from<ContactModel>("{type: ipc, friction: 1}");
  const auto contact = model->bind(rough.hierarchy.levels[0], Material());
  REQUIRE(lagged_friction(*contact->build_candidates(x, x)->build_collisions(x), x, {}));
  CHECK(slippery.refine(x).x == rough.refine(x).x);
}

TEST_CASE("A stretched disc is refined within its strain limit, although refinement rounds its border") {
  const TwoLevels cloth(disc(0.3, 60), {}, {"{type: strain_limit, limit: 1.06}"});
  Positions x = 1.04 * cloth.starts[0];
  for (Eigen::Index i = 0; i < x.rows(); ++i) x(i, 2) = 0.01 * std::sin(8 * x(i, 0)) * std::cos(7 * x(i, 1));
  REQUIRE(cloth.violations(0, x) == 0);
  REQUIRE(cloth.violations(1, cloth.midpoint(x)) > 5);
  const LevelResult refined = cloth.refine(x);
  CHECK(refined.message.empty());
  CHECK(cloth.violations(1, refined.x) == 0);
  CHECK(largest_distance(refined.x, cloth.target(x)) < 2e-3);
  CHECK(largest_distance(refined.x, cloth.target(x)) <
        0.5 * largest_distance(cloth.midpoint(x), cloth.target(x)));
}

namespace {

/// Fine vertices 0 and 1 are two fine edges apart; their targets 1.5 times as far.
struct TornApart : TwoLevels {
  const Eigen::Vector3d pin_target{0.15, 0, 0};
  TornApart()
      : TwoLevels(grid({0.4, 0.4}, 5, 5, Diagonals::one_way), {}, {"{type: strain_limit, limit: 1.1}"},
                  {0, 1}) {
    prescribe({{0, starts[1].row(0), 0}, {1, pin_target, 1}});
  }
};

}  // namespace

TEST_CASE("Triangles that cannot be within the strain limit are named") {
  const TornApart cloth;
  const LevelResult refined = cloth.refine(cloth.starts[0]);
  CHECK(refined.x.row(1) == cloth.pin_target.transpose());
  REQUIRE(cloth.violations(1, refined.x) > 0);
  CHECK_THAT(refined.message,
             Catch::Matches("the refined state violates the strain limit: triangle [0-9]+, stretched to "
                            "[12]\\.[0-9]+ \\(limit 1\\.1\\).*"));
  const auto& limit = *cloth.models[1]->limits()[0]->stretch_limit();
  const std::string first = to_string(limit.violations(refined.x)[0], 1.1);
  CHECK_THAT(refined.message, Catch::Contains(": " + first));
}

TEST_CASE("A refinement that contact cuts to nothing fails after few steps") {
  TwoLevels cloth(grid({1, 1}, 5, 5, Diagonals::one_way), {}, {"{type: strain_limit, limit: 1.06}"});
  const auto jam = std::make_shared<Jam>();
  cloth.contacts_ = {jam};
  cloth.prescribe({});
  const Positions x = 1.5 * cloth.starts[0];
  const LevelResult refined = cloth.refine(x);
  CHECK(refined.iterations > 10);
  CHECK(refined.iterations < 60);
  CHECK(jam->motions() < 150);
  CHECK_THAT(refined.message, Catch::StartsWith("the refined state violates the strain limit: "));
}

TEST_CASE("If refinement fails, the level starts from the scene's start, and its message says so") {
  const TornApart cloth;
  const std::vector<LevelResult> results = cascaded(cloth);
  REQUIRE(results.size() == 2);
  CHECK(results[0].message.empty());
  CHECK_FALSE(results[1].from_initial_state);       // the attempt counts as cost
  CHECK(results[1].outcome != Outcome::converged);  // the pins still tear at it
  CHECK_THAT(results[1].message,
             Catch::Matches("the refined state violates the strain limit: triangle .*; the level starts "
                            "from the scene's start instead; .*"));
  CHECK(cloth.violations(1, results[1].x) == 0);
}

TEST_CASE("What refinement factorises counts as its level's") {
  struct Stopped : Observer {
    void level_started(int level) override { stop = level == 1; }
    bool stop_requested() override { return stop; }
    bool stop = false;
  };
  const std::vector<LevelResult> results = cascaded(TornApart(), Stopped());
  REQUIRE(results.size() == 2);
  CHECK(results[1].iterations == 0);
  CHECK(results[1].factorisations > 0);
  CHECK(results[1].analyses > 0);
  CHECK(results[1].flops > 1000);
}

TEST_CASE("The cloth follows a vertex that is pinned on the finer level alone, within its strain limit") {
  const TriangleMesh sheet = grid({1, 1}, 9, 9, Diagonals::one_way);
  for (const double degrees : {10.0, 40.0, 70.0}) {
    TwoLevels cloth(sheet, {}, {"{type: strain_limit, limit: 1.0608}"}, {0});
    const int midpoint = pin_beside_the_corner(cloth);
    const double angle = degrees * M_PI / 180;
    const Positions turned = sheet.vertices * Eigen::AngleAxisd(-angle, Eigen::Vector3d::UnitZ()).matrix();
    const LevelResult refined = cloth.refine(turned);
    CAPTURE(degrees, refined.message, refined.iterations);
    CHECK(refined.message.empty());
    CHECK(cloth.violations(1, refined.x) == 0);
    CHECK(refined.x.row(midpoint) == cloth.starts[1].row(midpoint));
  }
}

TEST_CASE("A pin that cannot reach its target moves there as far as contact allows") {
  TwoLevels cloth(grid({0.4, 0.4}, 5, 5, Diagonals::one_way), {ball_contact}, {}, {12});
  for (Positions& start : cloth.starts) start.rowwise() += Eigen::RowVector3d(-0.2, -0.2, 0.31);
  const Positions x = cloth.starts[0];
  Eigen::Vector3d target = cloth.starts[1].row(12);
  target.z() = 0.2;
  cloth.prescribe({{12, target, 0}});
  const LevelResult refined = cloth.refine(x);
  CHECK(refined.message.empty());
  CHECK(refined.x(12, 2) > 0.3);
  CHECK(refined.x(12, 2) < 0.31 - 1e-3);
  CHECK(cloth.intersections(1, refined.x) == 0);
}

TEST_CASE("A level whose prolonged state an energy does not allow starts from the scene's start") {
  TwoLevels cloth(
      grid({1, 1}, 9, 9, Diagonals::one_way), {},
      {"neo_hookean", "hinge", "gravity",
       "{type: formula, density: \"-log(1 - max(s1-1,0)^2/0.36) - log(1 - max(s2-1,0)^2/0.36)\"}"},
      {0});
  pin_beside_the_corner(cloth);
  const LevelResult finer = cascaded(cloth).at(1);
  CHECK(finer.outcome != Outcome::infeasible);
  CHECK_THAT(finer.message,
             Catch::StartsWith("the refined state is outside the domain of an energy; the level starts"));
}

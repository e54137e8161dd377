// Drapes on hierarchies under a given mesh.

#include <catch2/catch.hpp>

#include "core/kernel/threads/parallel.h"
#include "core/numerics/model/stretch_limit.h"
#include "core/numerics/solve/lift_off_folds.h"
#include "core/numerics/solve/within_limits.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

/// A limp square of a random mesh that falls over a ball.
std::string over_a_ball(const std::string& more = "") {
  return R"(
name: coarsened
cloth: {shape: square, side: 1, triangulation: random, vertices: 1500}
hierarchy: {coarsen: 2}
material: {density: 472.6, thickness: 3.18e-4, membrane_modulus: 8e4, bending_modulus: 8e4, poisson_ratio: 0.243}
start: {translate: [-0.5, -0.5, 0.21], perturbation: 1e-3}
energies: [neo_hookean, hinge, {type: strain_limit, limit: 1.0608}, gravity]
contact: [ipc, shapes]
obstacles: [{shape: sphere, radius: 0.2}]
friction: 0.1
methods: {pcs: {newton: {force_tolerance: 1e-2}}, newton: {}}
)" + more;
}

std::size_t intersections(const LevelModel& model, const Positions& x) {
  std::size_t count = 0;
  for (const auto& contact : model.contacts()) count += contact->intersections(x).size();
  return count;
}

}  // namespace

TEST_CASE(
    "Coarsened levels: pcs goes from level to level without an intersection, on any number of threads") {
  std::vector<Positions> ends;
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    const Solved s = solve_yaml(over_a_ball(), "pcs");
    set_thread_count(0);
    REQUIRE(s.levels.size() == 3);
    for (const LevelResult& level : s.levels) {
      INFO(level.message);
      CHECK(level.outcome == Outcome::converged);
      CHECK(level.from_initial_state == (level.level == 0));
      CHECK(intersections(*s.scene->models[level.level], level.x) == 0);
    }
    ends.push_back(s.x());
  }
  CHECK(ends[0] == ends[1]);
}

TEST_CASE("Interpolation between levels that stretches triangles is brought within the limit") {
  const Solved s = scene_from(over_a_ball("pins: [{region: vertices, vertices: [0]}]\n"));
  const Hierarchy& hierarchy = s.scene->hierarchy;
  const LevelModel& model = s.model();
  Positions folded = hierarchy.levels[1].rest.vertices;  // sharp pleats
  for (Eigen::Index v = 0; v < folded.rows(); ++v) {
    const double along = folded(v, 0) * 12, fold = along - std::floor(along);
    folded(v, 0) = 0.6 * folded(v, 0);
    folded(v, 2) = 0.8 / 12 * std::min(fold, 1 - fold);
  }
  const Positions start = hierarchy.linear[1] * folded;
  const auto beyond = [&](const Positions& x) {
    std::size_t count = 0;
    for (const BoundEnergy* limit : model.limits()) count += limit->stretch_limit()->violations(x).size();
    return count;
  };
  REQUIRE(beyond(start) > 5);
  const Positions mended = within_limits(model, start);
  CHECK(beyond(mended) == 0);
  CHECK(mended.row(0) == start.row(0));  // the pin
  CHECK((mended - start).rowwise().norm().maxCoeff() < 0.5 / std::sqrt(1500.0));
  CHECK(within_limits(model, mended) == mended);
}

TEST_CASE("Coarsened levels: pins, starts and files name the cloth's own vertices") {
  const Solved s =
      scene_from(over_a_ball("pins: [{region: vertices, vertices: [0, 700]}, {point: [1, 1, 0]}]\n"));
  const Hierarchy& hierarchy = s.scene->hierarchy;
  REQUIRE(hierarchy.cloth == 2);
  CHECK(hierarchy.levels[2].vertex_count() == 1500);
  CHECK(s.experiment.parameters.levels == 1);
  for (const Level& level : hierarchy.levels) {
    const auto& dirichlet = s.scene->models[level.index]->dirichlet();
    REQUIRE(dirichlet.size() == 3);
    for (const DirichletVertex& d : dirichlet) {
      const int same = level.cloth_vertex(d.vertex);
      if (same != 0 && d.pin == 0) CHECK(level.own_vertex(700) == d.vertex);
      if (d.pin == 1) CHECK(level.rest.vertices.row(d.vertex) == Eigen::RowVector3d(1, 1, 0));
    }
  }
}

TEST_CASE("Coarsened levels: a refiner without coarser levels, and curved cloth, are refused") {
  CHECK_THROWS_WITH(scene_from(over_a_ball("refiner: loop\n")),
                    Catch::Contains("write \"refiner: coarsen\""));
}

TEST_CASE("Layers whose sharp folds pierce each other are drawn apart") {
  const Solved s = scene_from(R"(
name: pierced
cloth: {shape: square, side: 1, triangulation: random, vertices: 1500}
levels: 1
energies: [neo_hookean, hinge, gravity]
contact: ipc
pins: [{region: vertices, vertices: [0]}]
methods: {newton: {}}
)");
  const LevelModel& model = s.model();
  constexpr double gap = 0.06, bend = 0.5 * M_PI * gap;  // of the layers, and the bend between them
  Positions x = model.level().rest.vertices;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const double along = x(v, 0) - 0.5, across = x(v, 1) - 0.5;
    const auto ridge = [&](double distance) {
      return (gap / 2 + 0.004) * std::max(0.0, 1 - std::abs(distance) / 0.1);
    };
    if (along < -bend / 2) {
      x.row(v) << along + bend / 2, across, ridge(along + 0.3);
    } else if (along > bend / 2) {
      x.row(v) << bend / 2 - along, across, gap - (along > 0.15 ? ridge(across) : 0);
    } else {
      const double angle = M_PI * along / bend;
      x.row(v) << gap / 2 * std::cos(angle), across, gap / 2 * (1 + std::sin(angle));
    }
  }
  REQUIRE(intersections(model, x) > 0);
  const std::optional<Positions> apart = lifted_off_folds(model, x);
  REQUIRE(apart);
  CHECK(intersections(model, *apart) == 0);
  CHECK((*apart - x).rowwise().norm().maxCoeff() < 1 / std::sqrt(1500.0));  // an edge
}

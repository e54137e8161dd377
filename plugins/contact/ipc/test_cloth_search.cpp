#include <catch2/catch.hpp>
#include <limits>

#include "core/numerics/patterns/generate.h"
#include "plugins/contact/ipc/cloth_search.h"
#include "tests/support/any_threads.h"
#include "tests/support/meshes.h"
#include "tests/support/moving_obstacles.h"
#include "tests/support/random.h"

using namespace drape;
using namespace drape::ipc;

namespace {

constexpr double dhat = 5e-3;
constexpr long unlimited = std::numeric_limits<long>::max();

/// A sheet beside a ball and a box, which move by steps of any size.
struct Scene {
  Level level = square_sheet(15, 0.4);
  Surface surface = Surface::of(level.rest, level.topology);
  Bodies bodies{ball(3, {0, 0, -0.06}, 0.05), box({0.1, 0.1, 0.1}, {0.1, 0.1, -0.06})};
  ObstacleMeshes meshes[2] = {ObstacleMeshes::of(bodies[0], 0), ObstacleMeshes::of(bodies[1], 1)};
  std::shared_ptr<const ObstacleTopology> topology =
      std::make_shared<const ObstacleTopology>(topology_of(placed()));
  PoseTrees trees{BroadPhaseKind::bvh};

  std::vector<Obstacle> placed() const {
    return {Obstacle::of(bodies[0], 0, meshes[0]), Obstacle::of(bodies[1], 1, meshes[1])};
  }
  ObstacleTree pose() {
    return {std::make_shared<const Obstacles>(Obstacles::of(placed(), topology)), dhat, trees};
  }
};

struct Found {
  long rows;
  std::vector<std::array<int, 4>> pairs;
};

std::vector<std::array<int, 4>> vertices_of(const std::vector<ObstaclePair>& pairs) {
  std::vector<std::array<int, 4>> all;
  for (const ObstaclePair& pair : pairs) all.push_back(pair.vertices);
  return all;
}

Found found_anew(const Surface& cloth, const LinearMotion& motion, const ObstacleTree& pose,
                 const SweptBoxes& swept) {
  ClothSearch search(cloth, false, BroadPhaseKind::bvh);
  const auto tree = make_broad_phase(BroadPhaseKind::bvh);
  tree->update(swept.triangles);
  search.update(motion.x0, motion.x1, 0.5 * dhat, pose.origin);
  REQUIRE(search.tree->overlaps(*tree, unlimited, search.rows));
  REQUIRE(find_obstacle_pairs(search.boxes, swept, search.rows, motion, unlimited, search.pairs));
  return {std::ssize(search.rows.items), vertices_of(search.pairs)};
}

}  // namespace

TEST_CASE("ipc: pairs found in a skin are those of a search among all boxes, in their order") {
  const long served = same_with_any_threads([] {
    Scene scene;
    RandomNumbers random(5);
    ClothSearch search(scene.surface, false, BroadPhaseKind::bvh);
    Positions x0 = scene.level.rest.vertices;
    long count = 0, refused = 0, pairs = 0;
    for (int k = 0; k < 200; ++k) {
      // Slow for a while, then fast, then the ball alone between poses.
      const bool rests = k % 50 >= 40;
      const double step = k % 50 < 30 ? 1e-4 : 4e-3;
      scene.bodies[0].translate += random.vector(step);
      const ObstacleTree pose = scene.pose();
      Positions x1 = x0, after = pose.obstacles->vertices;
      for (auto v : x1.rowwise()) v += random.vector(rests ? 0 : step).transpose();
      // Every third motion is one of the ball, on a curve.
      const bool of_ball = !rests && k % 3 == 0;
      const double chord_error = of_ball ? 0.1 * step : 0;
      if (of_ball)
        after.topRows(scene.meshes[0].frames[0]->mesh.vertices.rows()).rowwise() +=
            random.vector(step).transpose();
      const LinearMotion motion{x0, of_ball ? x0 : x1, dhat + chord_error, pose.obstacles->vertices,
                                of_ball ? after : pose.obstacles->vertices};
      SweptBoxes swept(*scene.topology);
      swept.update(motion.obstacles0, motion.obstacles1, 0.5 * dhat + chord_error, pose.origin);
      const Found expected = found_anew(scene.surface, motion, pose, swept);
      CHECK_FALSE(search.find_in_skin(motion, swept, pose, dhat, expected.rows - 1));
      if (search.find_in_skin(motion, swept, pose, dhat, unlimited)) {
        ++count;
        CHECK(vertices_of(search.pairs) == expected.pairs);
        pairs += std::ssize(search.pairs);
      } else {
        ++refused;
      }
      x0 = 0.5 * (x0 + x1);
      if (!rests) x0.col(2) *= 0.9;  // stays near the bodies
    }
    CHECK(refused > 20);
    CHECK(pairs > 1000);
    return count;
  });
  CHECK(served > 50);
}

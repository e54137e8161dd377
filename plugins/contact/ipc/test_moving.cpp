#include <catch2/catch.hpp>

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/any_threads.h"
#include "tests/support/command.h"
#include "tests/support/evaluate.h"
#include "tests/support/moving_obstacles.h"
#include "tests/support/random.h"

using namespace drape;
using namespace drape::ipc;
using Vector = Eigen::Vector3d;

namespace {

RandomNumbers uniform(11);

Positions wavy(const Level& level, double height) {
  Positions x = level.rest.vertices;
  const double a = uniform(-20, 20), b = uniform(-20, 20);
  for (auto vertex : x.rowwise()) vertex[2] = height * std::sin(a * vertex[0] + b * vertex[1]);
  return x;
}

/// The part of the motion that a cloth allows.
StepLimit limit_of(const Bodies& from, const Bodies& to, const Level& level, const Positions& x) {
  return bound(to, level)->max_step(*bound(from, level), x);
}

}  // namespace

TEST_CASE("ipc: an obstacle may grow up to a tenth of dhat, and slides freely") {
  const Level level = square_sheet(9, 0.4);
  const auto limit = [&](const ObstacleParameters& from, const ObstacleParameters& to) {
    return limit_of({from}, {to}, level, level.rest.vertices).fraction;
  };
  CHECK(limit(box({0.1, 0.1, 0.1}, {0, 0, -0.06}), box({0.1, 0.1, 0.2}, {0, 0, -0.06})) ==
        Approx((0.01 - 1e-4) / 0.05).epsilon(1e-3));
  const ObstacleParameters plate = box({1, 1, 0.01}, {0, 0, -0.0051});  // a tenth of a millimetre below
  ObstacleParameters turned = plate;
  turned.translate.x() += 0.2;
  turned.rotate.z() = 200;
  CHECK(limit(plate, turned) == 1);
}

TEST_CASE("ipc: an edge that is highest during a rotation does not pass through the cloth") {
  const Level level = square_sheet(5, 0.2);
  const Positions& x = level.rest.vertices;
  const double apex = 0.1 / std::sqrt(2.0), lower = apex * (1 - std::cos(2 * M_PI / 180));  // 4.3e-5 m
  for (const bool passes : {true, false}) {
    Bodies from = {box({0.1, 0.1, 0.1}, {0, 0, -apex + (passes ? -1.1e-4 : 0.5 * lower)})}, to = from;
    from[0].rotate.y() = 43;
    to[0].rotate.y() = 47;
    REQUIRE(bound(to, level)->intersections(x).empty());
    const double fraction = limit_of(from, to, level, x).fraction;
    CHECK(fraction > 0.01);
    CHECK((fraction == 1) == passes);
    CHECK(fraction < (passes ? 2 : 0.2));
  }
}

TEST_CASE("ipc: rotating obstacles keep gaps below a micrometre") {
  const Level level = square_sheet(5, 0.2);
  const Positions& x = level.rest.vertices;
  for (const double gap : {1e-7, 1e-6, 1e-5}) {
    const Bodies from = {box({0.1, 0.1, 0.1}, {0, 0, -0.05 - gap})};
    Bodies to = from;
    to[0].rotate = {30, 0, 40};
    for (int round = 0; round < 6; ++round) {
      const double fraction = limit_of(from, to, level, x).fraction;
      CAPTURE(gap, round, fraction);
      CHECK(fraction > 0);
      if (round > 0) CHECK(fraction == 1);
      to[0].rotate *= fraction;
      CHECK(bound(to, level)->intersections(x).empty());
    }
  }
}

TEST_CASE("ipc: an animation is interpolated linearly and never passes through the cloth") {
  const Scratch folder;
  const TriangleMesh flat = grid({0.3, 0.3}, 6, 6, Diagonals::one_way);
  ObstacleParameters wing;
  wing.name = "wing";
  const auto add_frame = [&](const TriangleMesh& mesh) {
    wing.animation.push_back((folder / (std::to_string(wing.animation.size()) + ".ply")).string());
    write_mesh(wing.animation.back(), mesh);
  };
  for (int k = 0; k < 4; ++k) {  // up, down, and up again further to the side
    TriangleMesh mesh = flat;
    for (auto vertex : mesh.vertices.rowwise())
      vertex +=
          Eigen::RowVector3d(0.01 * k - 0.15, -0.15, 0.4 * (k % 2 ? -1 : 1) * (vertex[0] - 0.15) - 0.02);
    add_frame(mesh);
  }
  const auto with = [&](double frame) {
    ObstacleParameters p = wing;
    p.frame = frame;
    return p;
  };
  const auto vertices = [&](double frame) { return obstacle_of(with(frame)).mesh().vertices; };
  CHECK((vertices(1.25) - 0.75 * vertices(1) - 0.25 * vertices(2)).norm() < 1e-14);

  const Level level = square_sheet(9, 0.2);
  Positions x = level.rest.vertices;
  const auto at = [&](double frame) { return bound({with(frame)}, level); };
  const auto part = [&](double from, double to) { return at(to)->max_step(*at(from), x).fraction; };
  // The wing's right end goes up in frames 1 to 2 and down in frames 2 to 3: highest in between.
  x.col(2).setConstant(0.005);
  x.col(0).array() += 0.12;
  const double blocked = part(1, 3);
  CHECK(blocked > 0.1);
  CHECK(blocked < 0.5);
  for (int k = 0; k <= 500; ++k) CHECK(at(1 + 2 * blocked * k / 500)->intersections(x).empty());
  CHECK(!at(1 + 2 * blocked + 0.05)->intersections(x).empty());
  CHECK(part(1, 1 + 2 * blocked) == 1);
  CHECK(at(3)->intersections(x).empty());
  x.col(2).setConstant(0.05);
  CHECK(part(1, 3) == 1);
  CHECK(part(3, 0) == 1);

  const auto refused = [](const ObstacleParameters& p, const std::string& why) {
    CHECK_THROWS_WITH(obstacle_of(p), Catch::Contains("\"" + p.name + "\"") && Catch::Contains(why));
  };
  refused(with(3.5), "last frame of its animation is 3");
  TriangleMesh other = flat;
  other.triangles.row(7) << flat.triangles(7, 1), flat.triangles(7, 2), flat.triangles(7, 0);
  add_frame(other);
  refused(with(0), "4.ply has other vertices in triangle 7");
  write_mesh(wing.animation.back(), grid({0.3, 0.3}, 5, 6, Diagonals::one_way));
  refused(with(0), "4.ply has 40 triangles and not 50");
  wing.mesh = "x.obj";
  refused(with(0), "exactly one of \"mesh\"");
  ObstacleParameters still = box({1, 1, 1});
  still.frame = 1;
  refused(still, "which it does not have");
}

TEST_CASE("ipc: one of many obstacles moves, bit for bit the same with any number of threads") {
  const Level level = square_sheet(41, 0.4);
  const Positions x = wavy(level, 0.01);
  // The first and the last nearly touch the cloth, and are static.
  Bodies from = {box({0.2, 0.2, 0.1}, {0, 0, x.col(2).minCoeff() - 0.05 - 1e-5}),
                 box({0.05, 0.05, 0.1}, {0.1, 0, -0.12}), ball(3, {-0.1, 0, -0.2})};
  from[1].name = "mover";
  from[2].translate.z() += 0.3 * limit_of({from[2]}, {ball(3, {-0.1, 0, 0.1})}, level, x).fraction;
  Bodies to = from;
  to[1].translate += Vector(0.02, 0.01, 0.3);
  to[1].rotate = {20, 10, 40};
  const double fraction = same_with_any_threads([&] {
    const StepLimit limit = limit_of(from, to, level, x);
    CHECK_THAT(limit.by, Catch::Contains("mover"));
    return limit.fraction;
  });
  CHECK(fraction > 0.1);
  CHECK(fraction < 0.9);
  to = from;
  to[1].translate.z() -= 1;
  CHECK(limit_of(from, to, level, x).fraction == 1);
}

TEST_CASE("ipc: an obstacle keeps most of the smallest gap that it has to the cloth before it moves") {
  const Level level = square_sheet(9, 0.4);
  const auto limit = [&](double gap, bool with_nearer_static) {
    Bodies from = {box({0.05, 0.05, 0.1}, {0, 0, -0.05 - gap})};
    if (with_nearer_static) from.push_back(box({0.05, 0.05, 0.1}, {0.1, 0.1, -0.05 - 1e-6}));
    Bodies to = from;
    to[0].translate.z() += 0.01;
    return 0.01 * limit_of(from, to, level, level.rest.vertices).fraction;
  };
  const double tenth = 0.1 * Ipc::Parameters().dhat;  // the least gap that is left, within 2 %
  for (const bool with_nearer_static : {false, true}) {
    CHECK(limit(2e-5, with_nearer_static) == Approx(0.2 * 2e-5).epsilon(0.1));
    CHECK(limit(0.9 * tenth, with_nearer_static) == Approx(0.2 * 0.9 * tenth).epsilon(0.1));
    CHECK(limit(20 * tenth, with_nearer_static) == Approx(19 * tenth).epsilon(0.005));
  }
}

TEST_CASE("ipc: poses that follow each other are as poses alone, with every broad phase") {
  const Level level = square_sheet(21, 0.4);
  const Positions x = wavy(level, 0.01);
  Ipc::Parameters p;
  p.friction = 0.2;
  p.dhat = 5e-3;
  const double low = x.col(2).minCoeff() - 0.05;
  p.obstacles = {ball(3, {0, 0, low - 0.003}, 0.05), box({0.1, 0.1, 0.1}, {0.1, 0.1, low - 0.001})};
  p.obstacles[0].rotate = {5, 5, 5};
  for (const BroadPhaseKind kind : {BroadPhaseKind::bvh, BroadPhaseKind::fcl}) {
    p.broad_phase = kind;
    auto model = std::make_unique<const Ipc>(p);
    std::shared_ptr<const BoundContact> now = model->bind(level, Material());
    std::shared_ptr<const BoundContact> alone_before = now;
    int contacts = 0, limited = 0;
    for (int k = 0; k < 12; ++k) {
      p.obstacles[0].translate += Vector(0.003, 0, k % 2 ? 0.008 : -0.006);
      p.obstacles[0].rotate += Vector(3, 40, 5);
      if (k == 8) p.obstacles[0].scale = 40;  // a tree that is built again
      if (k == 9) p.obstacles[0].scale = 1;
      auto next = std::make_unique<const Ipc>(p, *model);
      const std::shared_ptr<const BoundContact> then = next->rebind(level, Material(), *now),
                                                alone = Ipc(p).bind(level, Material());
      const StepLimit limit = then->max_step(*now, x), limit_alone = alone->max_step(*alone_before, x);
      CAPTURE(k, limit.fraction);
      CHECK(limit.fraction == limit_alone.fraction);
      CHECK(limit.by == limit_alone.by);
      limited += limit.fraction > 0 && limit.fraction < 1;
      const auto own = collisions_at(*then, x), expected = collisions_at(*alone, x);
      contacts += own->contact_count();
      CHECK(own->contact_count() == expected->contact_count());
      CHECK(own->value(x) == expected->value(x));
      now = then;
      alone_before = alone;
      model = std::move(next);
    }
    CHECK(contacts > 50);
    CHECK(limited > 1);
  }
}

TEST_CASE("ipc: an obstacle whose triangles change is refused by name") {
  const Level level = square_sheet(3, 0.2);
  CHECK_THROWS_WITH(limit_of({ball(1, {0, 0, 3})}, {ball(2, {0, 0, 3})}, level, level.rest.vertices),
                    Catch::Contains("\"ball\"") && Catch::Contains("320 triangles instead of 80"));
}

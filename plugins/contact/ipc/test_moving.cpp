#include <catch2/catch.hpp>

#include "core/numerics/collision_detection/intersections.h"
#include "core/numerics/contact_forces/friction.h"
#include "core/numerics/mesh_files/io.h"
#include "core/numerics/model/active_contacts.h"
#include "core/numerics/model/required.h"
#include "core/numerics/patterns/generate.h"
#include "plugins/contact/ipc/bound_ipc.h"
#include "tests/support/any_threads.h"
#include "tests/support/command.h"
#include "tests/support/evaluate.h"
#include "tests/support/ipc_obstacles.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"

using namespace drape;
using namespace drape::ipc;
using Vector = Eigen::Vector3d;

namespace {

RandomNumbers uniform(11);

Positions wavy(const Level& level, double height) {
  Positions x = level.rest.vertices;
  const double a = uniform(-20, 20), b = uniform(-20, 20);
  for (int v = 0; v < x.rows(); ++v) x(v, 2) = height * std::sin(a * x(v, 0) + b * x(v, 1));
  return x;
}

using Bodies = std::vector<ObstacleParameters>;

std::shared_ptr<const BoundContact> bound(const Bodies& bodies, const Level& level, double friction = 0) {
  Ipc::Parameters p;
  p.self_contact = false;
  p.obstacles = bodies;
  p.friction = friction;
  return Ipc(p).bind(level, Material());
}

/// Interpolates as load stepping does after a shortened obstacle step.
Bodies blended(const Bodies& from, const Bodies& to, double part) {
  Bodies result = to;
  const auto blend = [&](auto& now, const auto& a, const auto& b) { now = a + part * (b - a); };
  for (std::size_t i = 0; i < to.size(); ++i) {
    blend(result[i].scale, from[i].scale, to[i].scale);
    blend(result[i].radius, from[i].radius, to[i].radius);
    blend(result[i].size, from[i].size, to[i].size);
    blend(result[i].rotate, from[i].rotate, to[i].rotate);
    blend(result[i].translate, from[i].translate, to[i].translate);
  }
  return result;
}

double distance_moved(const Bodies& from, const Bodies& to) {
  return (obstacle_of(to[0]).mesh.vertices - obstacle_of(from[0]).mesh.vertices).rowwise().norm().maxCoeff();
}

/// The number of samples, at most `step` apart, of the motion up to `part` at which cloth and obstacle
/// intersect.
int crossings(const Bodies& from, const Bodies& to, double part, const Level& level, const Positions& x,
              double step) {
  const double turn = (to[0].rotate - from[0].rotate).cwiseAbs().sum() * M_PI / 180;
  const double size = std::max(from[0].scale, to[0].scale) * std::max(from[0].size.norm(), to[0].size.norm());
  const double length = distance_moved(from, to) + turn * size;
  const int samples = 2 + static_cast<int>(part * length / step);
  const TriangleMesh cloth{x, level.rest.triangles};
  int found = 0;
  for (int k = 0; k <= samples; ++k)
    found += !intersections(cloth, obstacle_of(blended(from, to, part * k / samples)[0]).mesh).empty();
  return found;
}

}  // namespace

TEST_CASE("ipc: an obstacle leaves a tenth of dhat, or most of a smaller gap") {
  const Level level = square_sheet(9, 0.4);
  const Positions& x = level.rest.vertices;
  const Bodies low = {box({0.2, 0.2, 0.1}, {0, 0, -0.06})}, high = {box({0.2, 0.2, 0.1}, {0, 0, 0.04})};
  StepLimit limit = bound(high, level)->max_step(*bound(low, level), x);
  CHECK(limit.fraction == Approx((0.01 - 1e-4) / 0.1).epsilon(1e-3));
  CHECK_THAT(limit.by, Catch::Contains("cloth") && Catch::Contains("block"));
  const Bodies near = {box({0.2, 0.2, 0.1}, {0, 0, -0.05 - 2e-5})};
  limit = bound(high, level)->max_step(*bound(near, level), x);
  CHECK(limit.fraction == Approx(0.2 * 2e-5 / (0.09 + 2e-5)).epsilon(0.1));
  limit = bound({box({0.2, 0.2, 0.1}, {0, 0, -0.0503})}, level)->max_step(*bound(low, level), x);
  CHECK(limit.fraction == 1);
  CHECK(limit.by.empty());
  CHECK(bound(high, level)->max_step(*bound(high, level), x).fraction == 1);  // static
  CHECK(bound(low, level)->max_step(*bound(low, level), x).fraction == 1);
  // Growth is a motion too.
  limit = bound({box({0.1, 0.1, 0.2}, {0, 0, -0.06})}, level)
              ->max_step(*bound({box({0.1, 0.1, 0.1}, {0, 0, -0.06})}, level), x);
  CHECK(limit.fraction == Approx((0.01 - 1e-4) / 0.05).epsilon(1e-3));
}

TEST_CASE("ipc: a plate that slides and rotates a tenth of a millimetre below the cloth is not limited") {
  const Level level = square_sheet(9, 0.4);
  Bodies from = {box({1, 1, 0.01}, {0, 0, -0.0051})}, to = from;
  to[0].translate.x() += 0.2;
  to[0].rotate.z() = 200;
  CHECK(bound(to, level)->max_step(*bound(from, level), level.rest.vertices).fraction == 1);
}

TEST_CASE("ipc: no obstacle motion passes through the cloth; a shortened step is not shortened again") {
  const Level level = square_sheet(7, 0.3);
  const Vector sizes[] = {{0.002, 0.002, 0.4}, {0.3, 0.2, 0.003}, {0.06, 0.08, 0.05}, {0.4, 0.004, 0.02}};
  int shortened = 0, full = 0, would_cross = 0, barely = 0;
  for (int i = 0; i < 160; ++i) {
    const Positions x = wavy(level, 0.02);
    const TriangleMesh cloth{x, level.rest.triangles};
    Bodies from = {box(sizes[i % 4])}, to;
    do {
      from[0].translate = uniform.vector(0.25);
      from[0].rotate = uniform.vector(180);
      from[0].scale = uniform(0.5, 1.5);
      if (i % 3 == 0)  // near already
        from[0].translate.z() = 0.5 * from[0].size.z() * from[0].scale + uniform(0.02, 0.03),
        from[0].rotate.head<2>().setZero();
    } while (!intersections(cloth, obstacle_of(from[0]).mesh).empty());
    to = from;
    to[0].translate += i % 5 == 0 ? uniform.vector(0.02) : uniform.vector(0.5);
    to[0].rotate += i % 2 ? uniform.vector(60) : uniform.vector(720);
    if (i % 4 == 0) to[0].scale = uniform(0.5, 2);
    if (i % 7 == 0) to[0].translate.z() = -from[0].translate.z() - 5;  // at a high speed
    const auto before = bound(from, level);
    const StepLimit limit = bound(to, level)->max_step(*before, x);
    CAPTURE(i, limit.fraction, limit.by);
    REQUIRE(limit.fraction > 0);
    REQUIRE(limit.fraction <= 1);
    CHECK(limit.by.empty() == (limit.fraction == 1));
    CHECK(crossings(from, to, limit.fraction, level, x, 1.5e-3) == 0);
    (limit.fraction < 1 ? shortened : full) += 1;
    if (limit.fraction == 1) continue;
    const Bodies part = blended(from, to, limit.fraction);
    CHECK(bound(part, level)->max_step(*before, x).fraction == 1);
    would_cross += crossings(from, to, 1, level, x, 1.5e-3) > 0;
    // Not overly conservative: an intersection would follow soon.
    const double soon = limit.fraction + 2e-3 / (distance_moved(from, to) + 1);
    barely += crossings(from, to, std::min(1.0, soon), level, x, 5e-4) > 0;
  }
  CAPTURE(shortened, full, would_cross, barely);
  CHECK(shortened > 40);
  CHECK(full > 20);
  CHECK(would_cross > 0.95 * shortened);
  CHECK(barely > 0.5 * shortened);
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
    const double fraction = bound(to, level)->max_step(*bound(from, level), x).fraction;
    CHECK(fraction > 0.01);
    CHECK((fraction == 1) == passes);
    CHECK(fraction < (passes ? 2 : 0.2));
  }
}

TEST_CASE("ipc: rotating obstacles keep gaps below a micrometre") {
  const Level level = square_sheet(5, 0.2);
  const Positions& x = level.rest.vertices;
  for (const double gap : {1e-7, 1e-6, 1e-5}) {
    Bodies from = {box({0.1, 0.1, 0.1}, {0, 0, -0.05 - gap})}, to = from;
    to[0].rotate = {30, 0, 40};
    const auto before = bound(from, level);
    for (int round = 0; round < 6; ++round) {
      const double fraction = bound(to, level)->max_step(*before, x).fraction;
      CAPTURE(gap, round, fraction);
      CHECK(fraction > 0);
      if (round > 0) CHECK(fraction == 1);
      to = blended(from, to, fraction);
      CHECK(bound(to, level)->intersections(x).empty());
    }
  }
}

TEST_CASE("ipc: an animation is interpolated linearly and never passes through the cloth") {
  const Scratch folder;
  const TriangleMesh flat = grid({0.3, 0.3}, 6, 6, Diagonals::one_way);
  Bodies from(1);
  from[0].name = "wing";
  for (int k = 0; k < 4; ++k) {  // up, down, and up again further to the side
    TriangleMesh mesh = flat;
    for (int v = 0; v < mesh.vertices.rows(); ++v)
      mesh.vertices(v, 2) = 0.4 * (k % 2 ? -1 : 1) * (mesh.vertices(v, 0) - 0.15) - 0.02;
    mesh.vertices.col(0).array() += 0.01 * k - 0.15;
    mesh.vertices.col(1).array() -= 0.15;
    from[0].animation.push_back((folder / ("wing" + std::to_string(k) + ".ply")).string());
    write_mesh(from[0].animation.back(), mesh);
  }
  from[0].frame = 1.25;
  const Positions between = obstacle_of(from[0]).mesh.vertices;
  from[0].frame = 1;
  Positions expected = 0.75 * obstacle_of(from[0]).mesh.vertices;
  from[0].frame = 2;
  expected += 0.25 * obstacle_of(from[0]).mesh.vertices;
  CHECK((between - expected).norm() < 1e-14);

  const Level level = square_sheet(9, 0.2);
  Positions x = level.rest.vertices;
  const auto at = [&](double frame) {
    Bodies bodies = from;
    bodies[0].frame = frame;
    return bound(bodies, level);
  };
  // The wing's right end goes up in frames 1 to 2 and down in frames 2 to 3: highest in between.
  x.col(2).setConstant(0.005);
  x.col(0).array() += 0.12;
  const double blocked = at(3)->max_step(*at(1), x).fraction;
  CHECK(blocked > 0.1);
  CHECK(blocked < 0.5);
  for (int k = 0; k <= 500; ++k) CHECK(at(1 + 2 * blocked * k / 500)->intersections(x).empty());
  CHECK(!at(1 + 2 * blocked + 0.05)->intersections(x).empty());
  CHECK(at(1 + 2 * blocked)->max_step(*at(1), x).fraction == 1);
  CHECK(at(3)->intersections(x).empty());
  x.col(2).setConstant(0.05);
  CHECK(at(3)->max_step(*at(1), x).fraction == 1);
  CHECK(at(0)->max_step(*at(3), x).fraction == 1);
  CHECK(at(0.5)->max_step(*at(0.5), x).fraction == 1);

  ObstacleParameters wrong = from[0];
  wrong.frame = 3.5;
  CHECK_THROWS_WITH(obstacle_of(wrong),
                    Catch::Contains("\"wing\"") && Catch::Contains("last frame of its animation is 3"));
  wrong.frame = 0;
  wrong.animation.push_back((folder / "other.ply").string());
  TriangleMesh other = flat;
  std::swap(other.triangles(7, 0), other.triangles(7, 1));
  std::swap(other.triangles(7, 1), other.triangles(7, 2));
  write_mesh(wrong.animation.back(), other);
  CHECK_THROWS_WITH(obstacle_of(wrong), Catch::Contains("other.ply has other vertices in triangle 7"));
  write_mesh(wrong.animation.back(), grid({0.3, 0.3}, 5, 6, Diagonals::one_way));
  CHECK_THROWS_WITH(obstacle_of(wrong), Catch::Contains("other.ply has 40 triangles and not 50"));
  wrong.mesh = "x.obj";
  CHECK_THROWS_WITH(obstacle_of(wrong), Catch::Contains("exactly one of \"mesh\""));
}

TEST_CASE("ipc: one of many obstacles moves, bit for bit the same with any number of threads") {
  const Level level = square_sheet(41, 0.4);
  Positions x = wavy(level, 0.01);
  Bodies from = {box({0.2, 0.2, 0.1}, {0, 0, -0.5}), box({0.05, 0.05, 0.1}, {0.1, 0, -0.12})}, to;
  from[1].name = "mover";
  from.push_back(ball(3, {-0.1, 0, -0.2}));
  // The first and the last nearly touch the cloth, and are static.
  from[0].translate.z() = x.col(2).minCoeff() - 0.05 - 1e-5;
  const double up = bound({ball(3, {-0.1, 0, 0.1})}, level)->max_step(*bound({from[2]}, level), x).fraction;
  from[2].translate.z() += 0.3 * up;
  to = from;
  to[1].translate += Vector(0.02, 0.01, 0.3);
  to[1].rotate = {20, 10, 40};
  const double fraction = same_with_any_threads([&] {
    const StepLimit limit = bound(to, level)->max_step(*bound(from, level), x);
    CHECK_THAT(limit.by, Catch::Contains("mover"));
    return limit.fraction;
  });
  CHECK(fraction > 0.1);
  CHECK(fraction < 0.9);
  to = from;
  to[1].translate.z() -= 1;
  CHECK(bound(to, level)->max_step(*bound(from, level), x).fraction == 1);
}

TEST_CASE("ipc: an obstacle whose triangles change is refused by name") {
  const Level level = square_sheet(3, 0.2);
  const auto before = bound({ball(1, {0, 0, 3})}, level);
  CHECK_THROWS_WITH(bound({ball(2, {0, 0, 3})}, level)->max_step(*before, level.rest.vertices),
                    Catch::Contains("\"ball\"") && Catch::Contains("320 triangles instead of 80"));
}

TEST_CASE("ipc: touched points move with their obstacle") {
  const Level level = square_sheet(5, 0.2);
  const Positions x = level.rest.vertices.rowwise() + Eigen::RowVector3d(0, 0, 4e-4);
  const Bodies from = {box({1, 0.5, 1}, {0.5, 0, -0.5})};  // below one half of the cloth
  Bodies to = from;
  to[0].translate += Vector(0.01, 0.003, 0);
  to[0].rotate.z() = 5;
  const auto before = bound(from, level, 0.3), after = bound(to, level, 0.3);
  const Eigen::Matrix3d turn = obstacle_of(to[0]).geometry.pose.linear();
  int above = 0;
  for (const auto& group : friction_contacts(*collisions_at(*before, x)))
    for (const FrictionContact& contact : group) {
      if (contact.vertices[1] >= 0 || x(contact.vertices[0], 0) < 1e-9) continue;
      ++above;
      const int v = contact.vertices[0];
      const Vector own = Vector(x(v, 0), x(v, 1), 0) - from[0].translate;
      const Vector moved = turn * own + to[0].translate - (own + from[0].translate);
      CAPTURE(v);
      CHECK(contact.touched.obstacle == 0);
      CHECK((after->displacement(*before, contact.touched) - moved).norm() < 1e-12);
    }
  CHECK(above >= 10);
}

namespace {

/// Force along x on a cloth with friction, less its barrier's [N].
double drag(ActiveContacts& contacts, const BoundContacts& models, const Positions& x) {
  Positions push = Positions::Zero(x.rows(), 3), all = push;
  for (const auto& model : models) collisions_at(*model, x)->add_gradient(x, push);
  contacts.add_gradient(x, all);
  return -(all.col(0) - push.col(0)).sum();
}

/// The same on a cloth at x once its obstacles have moved.
double drag_between(const BoundContacts& before, const BoundContacts& after, const Positions& x) {
  ActiveContacts contacts(before);
  contacts.begin_step(x);
  contacts.update_obstacles(after, x, x);
  contacts.begin_step(x);
  return drag(contacts, after, x);
}

/// Sum of the magnitudes of a model's forces along z [N].
double normal_force(const BoundContact& model, const Positions& x) {
  return gradient_of(*collisions_at(model, x), x).col(2).cwiseAbs().sum();
}

}  // namespace

TEST_CASE(
    "ipc: a plate that slides below a cloth drags it with μ times the normal force, however finely it is "
    "meshed") {
  const Level level = square_sheet(9, 0.2);
  const Positions x = level.rest.vertices.rowwise() + Eigen::RowVector3d(0, 0, 4e-4);
  const Scratch folder;
  for (const int columns : {2, 11, 41, 81}) {
    TriangleMesh plate = grid({0.8, 0.8}, columns, columns, Diagonals::criss_cross);
    plate.vertices.rowwise() -= Eigen::RowVector3d(0.403, 0.407, 0);
    write_mesh(folder / "plate.ply", plate);
    const auto at = [&](double shift) {
      ObstacleParameters p;
      p.mesh = (folder / "plate.ply").string();
      p.translate.x() = shift;
      return bound({p}, level, 0.3);
    };
    for (const double shift : {1e-3, 1e-2, 0.1}) {
      CAPTURE(columns, shift);
      const auto after = at(shift);
      CHECK(drag_between({at(0)}, {after}, x) == Approx(0.3 * normal_force(*after, x)).epsilon(1e-6));
    }
  }
}

TEST_CASE("ipc: of two obstacles that a cloth lies between, the static one does not drag it along") {
  const Level level = square_sheet(9, 0.2);
  const Positions x = level.rest.vertices.rowwise() + Eigen::RowVector3d(0, 0, 4e-4);
  const auto between = [&](double shift) {
    Bodies all = {box({1, 1, 1}, {0, 0, -0.5}), box({1, 1, 1}, {shift, 0, 0.5 + 8e-4})};
    all[0].friction = 1;
    all[1].friction = 0.1;
    return bound(all, level, 0.3);
  };
  const auto lower = bound({box({1, 1, 1}, {0, 0, -0.5})}, level);
  CHECK(drag_between({between(0)}, {between(0.01)}, x) ==
        Approx(0.1 * normal_force(*lower, x)).epsilon(1e-6));
}

TEST_CASE("ipc: contacts that form in a step have friction when the obstacle moves next") {
  const Level level = square_sheet(9, 0.2);
  Positions apart = level.rest.vertices, x = apart;
  apart.col(2).setConstant(2e-3);
  x.col(2).setConstant(4e-4);
  const auto at = [&](double shift) { return bound({box({1, 1, 1}, {shift, 0, -0.5})}, level, 0.3); };
  const BoundContacts before = {at(0)}, after = {at(0.01)};
  ActiveContacts contacts(before);
  contacts.begin_step(apart);
  contacts.max_step(apart, x);
  contacts.barrier(x);
  contacts.update_obstacles(after, x, x);
  contacts.begin_step(x);
  CHECK(drag(contacts, after, x) == Approx(0.3 * normal_force(*after[0], x)).epsilon(1e-6));
}

TEST_CASE("ipc: a frame of an obstacle that is no animation is refused") {
  ObstacleParameters still = box({1, 1, 1});
  still.frame = 1;
  CHECK_THROWS_WITH(obstacle_of(still),
                    Catch::Contains("\"block\"") && Catch::Contains("which it does not have"));
}

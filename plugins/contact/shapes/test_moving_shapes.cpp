#include <catch2/catch.hpp>

#include "core/numerics/contact_forces/friction.h"
#include "core/numerics/model/active_contacts.h"
#include "core/numerics/model/required.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"
#include "tests/support/solids.h"

using namespace drape;
using namespace drape::shapes;
using Eigen::Vector3d;

namespace {

RandomNumbers uniform(5);

/// The part of the motion that a cloth at rest allows.
StepLimit limit_of(const ShapeParameters& from, const ShapeParameters& to, const Level& level) {
  return bound({to}, level)->max_step(*bound({from}, level), level.rest.vertices);
}

ShapeParameters blended(const ShapeParameters& from, const ShapeParameters& to, double part) {
  ShapeParameters p = to;
  const auto blend = [&](auto& now, const auto& a, const auto& b) { now = a + part * (b - a); };
  blend(p.translate, from.translate, to.translate);
  blend(p.radius, from.radius, to.radius);
  blend(p.size, from.size, to.size);
  blend(p.height, from.height, to.height);
  blend(p.rotate, from.rotate, to.rotate);
  blend(p.normal, from.normal, to.normal);
  return p;
}

/// A sheet within d̂ above z = 0.
Positions resting(const Level& level) {
  return level.rest.vertices.rowwise() + Eigen::RowVector3d(0, 0, 4e-4);
}

/// How far the touched points of a cloth move with their solid.
std::vector<Vector3d> displacements(const ShapeParameters& from, const ShapeParameters& to,
                                    const Level& level) {
  const auto before = bound({from}, level, 0.3), after = bound({to}, level, 0.3);
  std::vector<Vector3d> all;
  for (const auto& group : friction_contacts(*collisions_at(*before, resting(level))))
    for (const FrictionContact& contact : group) {
      CHECK(contact.touched.obstacle == 0);
      all.push_back(after->displacement(*before, contact.touched));
    }
  REQUIRE(!all.empty());
  return all;
}

}  // namespace

TEST_CASE("shapes: a rising solid leaves a tenth of dhat, or most of a smaller gap; others are not limited") {
  const Level level = square_sheet(9, 0.4);
  for (const SolidKind kind : kinds) {
    INFO(to_string(kind));
    for (const double gap : {0.01, 2e-5}) {
      const ShapeParameters from = upright(kind, gap);
      ShapeParameters to = from;
      to.translate.z() += 0.1;
      const StepLimit limit = limit_of(from, to, level);
      const double left = 0.8 * std::min(gap, dhat / 8);
      CHECK(limit.fraction == Approx((gap - left) / 0.1).epsilon(gap > dhat ? 2e-3 : 0.1));
      CHECK_THAT(limit.by, Catch::StartsWith("cloth triangle ") && Catch::EndsWith(to_string(kind)));
      CHECK(limit_of(from, from, level).fraction == 1);
      to.translate.z() = from.translate.z() - 3;
      CHECK(limit_of(from, to, level).fraction == 1);
    }
    const ShapeParameters below = upright(kind, 1e-4);
    ShapeParameters beside = below;
    beside.translate.x() += 0.2;
    beside.rotate.z() = 100;
    CHECK(limit_of(below, beside, level).fraction == 1);
  }
  const ShapeParameters small = upright(SolidKind::sphere, 0.01);
  ShapeParameters large = small;
  large.radius = 0.2;
  CHECK(limit_of(small, large, level).fraction == Approx((0.01 - 0.1 * dhat) / 0.1).epsilon(2e-3));
}

TEST_CASE("shapes: no solid's motion passes through the cloth; a shortened step is not shortened again") {
  const Level level = square_sheet(6, 0.3);
  int shortened = 0, full = 0, would_cross = 0, barely = 0;
  for (int i = 0; i < 300; ++i) {
    Positions x = level.rest.vertices;
    const double a = uniform(-20, 20), b = uniform(-20, 20);
    for (auto vertex : x.rowwise()) vertex[2] = 0.02 * std::sin(a * vertex[0] + b * vertex[1]);
    const auto crosses = [&](const ShapeParameters& p) {
      return !bound({p}, level)->intersections(x).empty();
    };
    ShapeParameters from;
    from.shape = kinds[i % 5];
    do {
      from.translate = uniform.vector(0.3);
      from.rotate = uniform.vector(180);
      from.normal = uniform.vector(1);
      from.radius = i % 2 ? 0.002 : uniform(0.03, 0.1);  // a needle
      from.height = uniform(0.1, 0.4);
      from.size = i % 3 ? Vector3d(0.3, 0.2, 0.002) : Vector3d(0.05, 0.08, 0.1);
    } while (crosses(from));
    ShapeParameters to = from;
    to.translate = i % 3 == 0 ? Vector3d(from.translate + uniform.vector(0.02))
                              : Vector3d(uniform.vector(0.1) - from.translate);
    to.rotate += i % 4 ? uniform.vector(60) : uniform.vector(720);
    to.normal += uniform.vector(0.7);
    if (i % 7 == 0) to.radius = uniform(0.01, 0.2), to.size *= 1.5;
    const auto before = bound({from}, level);
    const StepLimit limit = bound({to}, level)->max_step(*before, x);
    CAPTURE(i, to_string(from.shape), limit.fraction);
    REQUIRE(limit.fraction > 0);
    REQUIRE(limit.fraction <= 1);
    CHECK(limit.by.empty() == (limit.fraction == 1));
    const auto crossings = [&](double begin, double end, int samples) {
      int found = 0;
      for (int k = 0; k <= samples; ++k)
        found += crosses(blended(from, to, begin + (end - begin) * k / samples));
      return found;
    };
    CHECK(crossings(0, limit.fraction, 700) == 0);
    (limit.fraction < 1 ? shortened : full) += 1;
    if (limit.fraction == 1) continue;
    CHECK(bound({blended(from, to, limit.fraction)}, level)->max_step(*before, x).fraction == 1);
    would_cross += crossings(limit.fraction, 1, 700) > 0;
    barely += crossings(limit.fraction, std::min(1.0, limit.fraction + 0.01), 20) > 0;
  }
  CAPTURE(shortened, full, would_cross, barely);
  CHECK(shortened > 100);
  CHECK(full > 50);
  CHECK(would_cross > 0.95 * shortened);
  CHECK(barely > 0.7 * shortened);
}

TEST_CASE("shapes: a solid whose kind changes is refused by name") {
  CHECK_THROWS_WITH(
      limit_of(upright(SolidKind::box, 1), upright(SolidKind::sphere, 1), square_sheet(3, 0.2)),
      Catch::StartsWith("thing: sphere cannot replace thing: box") && Catch::EndsWith(" during a run"));
}

TEST_CASE("shapes: touched points move with their solid") {
  const Level level = square_sheet(5, 0.2);
  const Vector3d move(0.01, 0.003, 0);
  for (const SolidKind kind : kinds) {
    INFO(to_string(kind));
    ShapeParameters to = upright(kind);
    to.translate += move;
    for (const Vector3d& moved : displacements(upright(kind), to, level))
      CHECK((moved - move).norm() < 1e-15);
  }
  // A ball that turns about a horizontal axis moves what lies on it, with a static centre.
  const ShapeParameters ball = upright(SolidKind::sphere);
  ShapeParameters turned = ball;
  turned.rotate = {0, 1, 0};
  double farthest = 0;
  for (const Vector3d& moved : displacements(ball, turned, level)) farthest = std::max(farthest, moved.x());
  CHECK(farthest == Approx(0.1 * M_PI / 180).epsilon(1e-3));
}

TEST_CASE("shapes: a half-space turns by the angle between its normals, wherever they point") {
  const Level level = square_sheet(5, 0.2);
  for (const double up : {-1.0, 1.0}) {
    const auto facing = [&](double x, double y) {
      ShapeParameters p = upright(SolidKind::half_space);
      p.normal = {x, y, up};
      return bound({p}, level, 0.3);
    };
    ObstaclePoint point{0};
    point.offset = {1, 0.5, 0};
    const double moved = facing(0, 1e-4)->displacement(*facing(1e-4, 0), point).norm();
    CHECK(moved < 1.01 * std::sqrt(2) * 1e-4 * point.offset.norm());
    CHECK(moved > 0);
  }
}

TEST_CASE("shapes: friction goes on while a solid turns below the cloth") {
  const Level level = square_sheet(9, 0.1);
  const auto roll = [&](double turned) {
    ShapeParameters p = upright(SolidKind::cylinder);
    p.height = 1;
    p.rotate = {90, turned, 0};  // turned about the cylinder's axis
    p.translate = {0, 0, -0.1};
    return bound({p}, level, 0.3);
  };
  // Draped over the roll: a strip of 0.1 m of its circumference.
  Positions x = level.rest.vertices, out = x;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double angle = x(i, 0) / 0.1;
    out.row(i) << std::sin(angle), 0, std::cos(angle);
    x.row(i) = (0.1 + 4e-4) * out.row(i) + Eigen::RowVector3d(0, x(i, 1), -0.1);
  }
  for (const double turned : {1.0, 10.0, 40.0}) {
    INFO(turned);
    const auto before = roll(0), after = roll(turned);
    ActiveContacts contacts({before});
    contacts.begin_step(x);
    contacts.update_obstacles({after}, x, x);
    contacts.begin_step(x);
    Positions push = Positions::Zero(x.rows(), 3), all = push;
    collisions_at(*after, x)->add_gradient(x, push);
    contacts.add_gradient(x, all);
    double along = 0;
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      along += (all.row(i) - push.row(i)).dot(Eigen::RowVector3d(out(i, 2), 0, -out(i, 0)));
    CHECK(std::abs(along / (0.3 * push.cwiseProduct(out).sum())) == Approx(1).epsilon(0.02));
  }
}

TEST_CASE("shapes: contacts keep their keys while another cylinder grows") {
  const Level level = square_sheet(4, 0.5);  // larger than the box, whose edges touch it
  const Positions x = resting(level);
  const auto keys = [&](double radius) {
    ShapeParameters roll = upright(SolidKind::cylinder, 0.5);
    roll.radius = radius;
    const auto contact = bound({roll, upright(SolidKind::box)}, level, 0.3);
    std::vector<ContactKey> all;
    for (const auto& d : lagged_friction(*collisions_at(*contact, x), x, {})->tangential_displacements(x))
      all.push_back(d.contact);
    return all;
  };
  REQUIRE(keys(0.1).size() > 10);
  CHECK(keys(0.1) == keys(0.11));
}

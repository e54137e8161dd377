#include <catch2/catch.hpp>

#include "core/numerics/contact_forces/friction.h"
#include "core/numerics/model/active_contacts.h"
#include "core/numerics/model/required.h"
#include "plugins/contact/shapes/shapes.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"

using namespace drape;
using namespace drape::shapes;
using Eigen::Vector3d;

namespace {

constexpr SolidKind kinds[] = {SolidKind::sphere, SolidKind::box, SolidKind::capsule, SolidKind::cylinder,
                               SolidKind::half_space};
constexpr double dhat = 1e-3;

RandomNumbers uniform(5);

std::shared_ptr<const BoundContact> bound(const std::vector<ShapeParameters>& shapes, const Level& level,
                                          double friction = 0) {
  Shapes::Parameters p;
  p.obstacles = shapes;
  p.dhat = dhat;
  p.friction = friction;
  return Shapes(p).bind(level, Material());
}
std::shared_ptr<const BoundContact> bound(const ShapeParameters& shape, const Level& level,
                                          double friction = 0) {
  return bound(std::vector{shape}, level, friction);
}

ShapeParameters blended(const ShapeParameters& from, const ShapeParameters& to, double part) {
  ShapeParameters p = to;
  p.translate = from.translate + part * (to.translate - from.translate);
  p.radius = from.radius + part * (to.radius - from.radius);
  p.size = from.size + part * (to.size - from.size);
  p.height = from.height + part * (to.height - from.height);
  p.rotate = from.rotate + part * (to.rotate - from.rotate);
  p.normal = from.normal + part * (to.normal - from.normal);
  return p;
}

ShapeParameters level_with(SolidKind kind, double gap) {
  ShapeParameters p;
  p.name = "thing";
  p.shape = kind;
  p.radius = p.height = 0.1;
  p.size = {0.3, 0.3, 0.1};
  p.translate.z() = -gap;
  if (kind == SolidKind::sphere) p.translate.z() -= 0.1;
  if (kind == SolidKind::box || kind == SolidKind::cylinder) p.translate.z() -= 0.05;
  if (kind == SolidKind::capsule) p.translate.z() -= 0.15;
  return p;
}

}  // namespace

TEST_CASE("shapes: a solid leaves a tenth of dhat, or most of a smaller gap") {
  const Level level = square_sheet(9, 0.4);
  const Positions& x = level.rest.vertices;
  for (const SolidKind kind : kinds) {
    INFO(to_string(kind));
    for (const double gap : {0.01, 2e-5}) {
      const ShapeParameters from = level_with(kind, gap);
      ShapeParameters to = from;
      to.translate.z() += 0.1;
      const StepLimit limit = bound(to, level)->max_step(*bound(from, level), x);
      const double left = 0.8 * std::min(gap, dhat / 8);
      CHECK(limit.fraction == Approx((gap - left) / 0.1).epsilon(gap > dhat ? 2e-3 : 0.1));
      CHECK_THAT(limit.by, Catch::StartsWith("cloth triangle ") && Catch::EndsWith(to_string(kind)));
      to.translate.z() = from.translate.z() - 3;
      CHECK(bound(to, level)->max_step(*bound(from, level), x).fraction == 1);
      CHECK(bound(from, level)->max_step(*bound(from, level), x).fraction == 1);
    }
  }
  const ShapeParameters small = level_with(SolidKind::sphere, 0.01);
  ShapeParameters large = small;
  large.radius = 0.2;
  CHECK(bound(large, level)->max_step(*bound(small, level), x).fraction ==
        Approx((0.01 - 0.1 * dhat) / 0.1).epsilon(2e-3));
}

TEST_CASE("shapes: solids that slide and rotate below the cloth are not limited") {
  const Level level = square_sheet(9, 0.4);
  for (const SolidKind kind : kinds) {
    const ShapeParameters from = level_with(kind, 1e-4);
    ShapeParameters to = from;
    to.translate.x() += 0.2;
    to.rotate.z() = 100;
    INFO(to_string(kind));
    CHECK(bound(to, level)->max_step(*bound(from, level), level.rest.vertices).fraction == 1);
  }
}

TEST_CASE("shapes: no solid's motion passes through the cloth; a shortened step is not shortened again") {
  const Level level = square_sheet(6, 0.3);
  int shortened = 0, full = 0, would_cross = 0, barely = 0;
  for (int i = 0; i < 300; ++i) {
    Positions x = level.rest.vertices;
    const double a = uniform(-20, 20), b = uniform(-20, 20);
    for (int v = 0; v < x.rows(); ++v) x(v, 2) = 0.02 * std::sin(a * x(v, 0) + b * x(v, 1));
    const auto crosses = [&](const ShapeParameters& p) { return !bound(p, level)->intersections(x).empty(); };
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
    const auto before = bound(from, level);
    const StepLimit limit = bound(to, level)->max_step(*before, x);
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
    CHECK(bound(blended(from, to, limit.fraction), level)->max_step(*before, x).fraction == 1);
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
  const Level level = square_sheet(3, 0.2);
  const auto before = bound(level_with(SolidKind::box, 1), level);
  CHECK_THROWS_WITH(
      bound(level_with(SolidKind::sphere, 1), level)->max_step(*before, level.rest.vertices),
      Catch::StartsWith("thing: sphere cannot replace thing: box") && Catch::EndsWith(" during a run"));
}

TEST_CASE("shapes: touched points move with their solid") {
  const Level level = square_sheet(5, 0.2);
  Positions x = level.rest.vertices;
  x.col(2).setConstant(4e-4);
  for (const SolidKind kind : kinds) {
    const ShapeParameters from = level_with(kind, 0);
    ShapeParameters to = from;
    to.translate += Vector3d(0.01, 0.003, 0);
    const auto before = bound(from, level, 0.3), after = bound(to, level, 0.3);
    INFO(to_string(kind));
    const FrictionContacts groups = friction_contacts(*collisions_at(*before, x));
    CHECK(!groups.empty());
    for (const auto& group : groups)
      for (const FrictionContact& contact : group) {
        CHECK(contact.touched.obstacle == 0);
        CHECK((after->displacement(*before, contact.touched) - Vector3d(0.01, 0.003, 0)).norm() < 1e-15);
      }
  }
  // A ball that turns about a horizontal axis moves what lies on it, with a static centre.
  const ShapeParameters from = level_with(SolidKind::sphere, 0);
  ShapeParameters to = from;
  to.rotate = {0, 1, 0};
  const auto before = bound(from, level, 0.3), after = bound(to, level, 0.3);
  double farthest = 0;
  for (const auto& group : friction_contacts(*collisions_at(*before, x)))
    for (const FrictionContact& contact : group)
      farthest = std::max(farthest, after->displacement(*before, contact.touched).x());
  CHECK(farthest == Approx(0.1 * M_PI / 180).epsilon(1e-3));
}

TEST_CASE("shapes: a half-space turns by the angle between its normals, wherever they point") {
  const Level level = square_sheet(5, 0.2);
  for (const double up : {-1.0, 1.0}) {
    const auto facing = [&](double x, double y) {
      ShapeParameters p = level_with(SolidKind::half_space, 0);
      p.normal = {x, y, up};
      return bound(p, level, 0.3);
    };
    ObstaclePoint point{0};
    point.offset = {1, 0.5, 0};
    const double angle = std::sqrt(2) * 1e-4, distance = point.offset.norm();
    const Vector3d moved = facing(0, 1e-4)->displacement(*facing(1e-4, 0), point);
    CHECK(moved.norm() < 1.01 * angle * distance);
    CHECK(moved.norm() > 0);
  }
}

TEST_CASE("shapes: friction goes on while a solid turns below the cloth") {
  const Level level = square_sheet(9, 0.1);
  const auto roll = [&](double turned) {
    ShapeParameters p = level_with(SolidKind::cylinder, 0);
    p.height = 1;
    p.rotate = {90, turned, 0};  // turned about the cylinder's axis
    p.translate = {0, 0, -0.1};
    return bound(p, level, 0.3);
  };
  // Draped over the roll: a strip of 0.1 m of its circumference.
  Positions x = level.rest.vertices;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double angle = x(i, 0) / 0.1, radius = 0.1 + 4e-4;
    x.row(i) << radius * std::sin(angle), x(i, 1), radius * std::cos(angle) - 0.1;
  }
  const auto torque = [&](ActiveContacts& contacts, const BoundContact& own) {
    Positions push = Positions::Zero(x.rows(), 3), all = push;
    collisions_at(own, x)->add_gradient(x, push);
    contacts.add_gradient(x, all);
    double sum = 0, normal = 0;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const Vector3d out = Vector3d(x(i, 0), 0, x(i, 2) + 0.1).normalized(), along(out.z(), 0, -out.x());
      sum -= (all.row(i) - push.row(i)).dot(along);
      normal -= push.row(i).dot(out);
    }
    return sum / (0.3 * normal);
  };
  for (const double turned : {1.0, 10.0, 40.0}) {
    INFO(turned);
    const auto before = roll(0), after = roll(turned);
    ActiveContacts contacts({before});
    contacts.begin_step(x);
    contacts.update_obstacles({after}, x, x);
    contacts.begin_step(x);
    CHECK(std::abs(torque(contacts, *after)) == Approx(1).epsilon(0.02));
  }
}

TEST_CASE("shapes: contacts keep their keys while another cylinder grows") {
  const Level level = square_sheet(4, 0.5);  // larger than the box, whose edges touch it
  Positions x = level.rest.vertices;
  x.col(2).setConstant(4e-4);
  const auto keys = [&](double radius) {
    ShapeParameters roll = level_with(SolidKind::cylinder, 0.5);
    roll.radius = radius;
    const auto contact = bound({roll, level_with(SolidKind::box, 0)}, level, 0.3);
    const auto friction = lagged_friction(*collisions_at(*contact, x), x, {});
    std::vector<ContactKey> all;
    for (const TangentialDisplacement& d : friction->tangential_displacements(x)) all.push_back(d.contact);
    return all;
  };
  REQUIRE(keys(0.1).size() > 10);
  CHECK(keys(0.1) == keys(0.11));
}

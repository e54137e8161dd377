#include <catch2/catch.hpp>

#include "core/numerics/contact_forces/friction.h"
#include "core/numerics/model/active_contacts.h"
#include "core/numerics/model/required.h"
#include "tests/support/meshes.h"
#include "tests/support/solids.h"

using namespace drape;
using namespace drape::shapes;
using Eigen::Vector3d;

namespace {

/// The part of the motion that a cloth at rest allows.
StepLimit limit_of(const ShapeParameters& from, const ShapeParameters& to, const Level& level) {
  return bound({to}, level)->max_step(*bound({from}, level), level.rest.vertices);
}

/// A sheet within d̂ above z = 0.
Positions resting(const Level& level) {
  return level.rest.vertices.rowwise() + Eigen::RowVector3d(0, 0, 4e-4);
}

}  // namespace

TEST_CASE(
    "shapes: a solid slides and turns freely below the cloth, and a ball may grow up to a tenth of dhat") {
  const Level level = square_sheet(9, 0.4);
  for (const auto& [name, kind] : kind_names) {
    INFO(name);
    const ShapeParameters below = upright(kind, 1e-4);
    ShapeParameters beside = below;
    beside.translate.x() += 0.2;
    beside.rotate.z() = 100;
    CHECK(limit_of(below, beside, level).fraction == 1);
  }
  const ShapeParameters small = upright(SolidKind::sphere, 0.01);
  ShapeParameters large = small;
  large.radius = 0.2;
  const StepLimit limit = limit_of(small, large, level);
  CHECK(limit.fraction == Approx((0.01 - 0.1 * dhat) / 0.1).epsilon(2e-3));
  CHECK_THAT(limit.by, Catch::StartsWith("cloth triangle ") && Catch::EndsWith("sphere"));
}

TEST_CASE("shapes: a solid whose kind changes is refused by name") {
  CHECK_THROWS_WITH(
      limit_of(upright(SolidKind::box, 1), upright(SolidKind::sphere, 1), square_sheet(3, 0.2)),
      Catch::StartsWith("thing: sphere cannot replace thing: box") && Catch::EndsWith(" during a run"));
}

TEST_CASE("shapes: a ball that turns about a horizontal axis moves what lies on it") {
  const Level level = square_sheet(5, 0.2);
  const ShapeParameters ball = upright(SolidKind::sphere);
  ShapeParameters turned = ball;
  turned.rotate = {0, 1, 0};
  const auto before = bound({ball}, level, 0.3), after = bound({turned}, level, 0.3);
  double farthest = 0;
  for (const auto& group : friction_contacts(*collisions_at(*before, resting(level))))
    for (const FrictionContact& contact : group)
      farthest = std::max(farthest, after->displacement(*before, contact.touched).x());
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

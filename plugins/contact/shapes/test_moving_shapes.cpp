#include <catch2/catch.hpp>
#include <random>

#include "core/kernel/mesh/generate.h"
#include "core/kernel/model/friction.h"
#include "plugins/contact/shapes/separation.h"
#include "plugins/contact/shapes/shapes.h"

using namespace drape;
using namespace drape::shapes;
using Eigen::Vector3d;

namespace {

constexpr SolidKind kinds[] = {SolidKind::sphere, SolidKind::box, SolidKind::capsule, SolidKind::cylinder,
                               SolidKind::half_space};
constexpr double dhat = 1e-3;

std::mt19937 generator(5);
double uniform(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(generator);
}
Vector3d any(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }

std::unique_ptr<BoundContact> bound(const std::vector<ShapeParameters>& shapes, const Level& level,
                                    double friction = 0) {
  Shapes::Parameters p;
  p.obstacles = shapes;
  p.dhat = dhat;
  p.friction = friction;
  return Shapes(p).bind(level, Material());
}
std::unique_ptr<BoundContact> bound(const ShapeParameters& shape, const Level& level, double friction = 0) {
  return bound(std::vector{shape}, level, friction);
}

StepLimit max_step(const BoundContact& before, const BoundContact& after, const Positions& x) {
  return dynamic_cast<const KinematicObstacles&>(after).max_step(before, x);
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

Level square(int side, double size) {
  TriangleMesh mesh = grid({size, size}, side, side, Diagonals::criss_cross);
  mesh.vertices.rowwise() -= Eigen::RowVector3d(size / 2, size / 2, 0);
  return Level::of(0, mesh);
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
  const Level level = square(9, 0.4);
  const Positions& x = level.rest.vertices;
  for (const SolidKind kind : kinds) {
    INFO(to_string(kind));
    for (const double gap : {0.01, 2e-5}) {
      const ShapeParameters from = level_with(kind, gap);
      ShapeParameters to = from;
      to.translate.z() += 0.1;
      const StepLimit limit = max_step(*bound(from, level), *bound(to, level), x);
      const double left = 0.8 * std::min(gap, dhat / 8);
      CHECK(limit.fraction == Approx((gap - left) / 0.1).epsilon(gap > dhat ? 2e-3 : 0.1));
      CHECK_THAT(limit.by, Catch::StartsWith("cloth triangle ") && Catch::EndsWith(to_string(kind)));
      to.translate.z() = from.translate.z() - 3;
      CHECK(max_step(*bound(from, level), *bound(to, level), x).fraction == 1);
      CHECK(max_step(*bound(from, level), *bound(from, level), x).fraction == 1);
    }
  }
  const ShapeParameters small = level_with(SolidKind::sphere, 0.01);
  ShapeParameters large = small;
  large.radius = 0.2;
  CHECK(max_step(*bound(small, level), *bound(large, level), x).fraction ==
        Approx((0.01 - 0.1 * dhat) / 0.1).epsilon(2e-3));
}

TEST_CASE("shapes: solids that slide and rotate below the cloth are not limited") {
  const Level level = square(9, 0.4);
  for (const SolidKind kind : kinds) {
    const ShapeParameters from = level_with(kind, 1e-4);
    ShapeParameters to = from;
    to.translate.x() += 0.2;
    to.rotate.z() = 100;
    INFO(to_string(kind));
    CHECK(max_step(*bound(from, level), *bound(to, level), level.rest.vertices).fraction == 1);
  }
}

TEST_CASE("shapes: no solid's motion passes through the cloth; a shortened step is not shortened again") {
  const Level level = square(6, 0.3);
  int shortened = 0, full = 0, would_cross = 0, barely = 0;
  for (int i = 0; i < 300; ++i) {
    Positions x = level.rest.vertices;
    const double a = uniform(-20, 20), b = uniform(-20, 20);
    for (int v = 0; v < x.rows(); ++v) x(v, 2) = 0.02 * std::sin(a * x(v, 0) + b * x(v, 1));
    const auto crosses = [&](const ShapeParameters& p) { return !bound(p, level)->intersections(x).empty(); };
    ShapeParameters from;
    from.shape = kinds[i % 5];
    do {
      from.translate = any(0.3);
      from.rotate = any(180);
      from.normal = any(1);
      from.radius = i % 2 ? 0.002 : uniform(0.03, 0.1);  // a needle
      from.height = uniform(0.1, 0.4);
      from.size = i % 3 ? Vector3d(0.3, 0.2, 0.002) : Vector3d(0.05, 0.08, 0.1);
    } while (crosses(from));
    ShapeParameters to = from;
    to.translate = i % 3 == 0 ? Vector3d(from.translate + any(0.02)) : Vector3d(any(0.1) - from.translate);
    to.rotate += i % 4 ? any(60) : any(720);
    to.normal += any(0.7);
    if (i % 7 == 0) to.radius = uniform(0.01, 0.2), to.size *= 1.5;
    const auto before = bound(from, level);
    const StepLimit limit = max_step(*before, *bound(to, level), x);
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
    CHECK(max_step(*before, *bound(blended(from, to, limit.fraction), level), x).fraction == 1);
    would_cross += crossings(limit.fraction, 1, 700) > 0;
    barely += crossings(limit.fraction, std::min(1.0, limit.fraction + 0.01), 20) > 0;
  }
  CAPTURE(shortened, full, would_cross, barely);
  CHECK(shortened > 100);
  CHECK(full > 50);
  CHECK(would_cross > 0.95 * shortened);
  CHECK(barely > 0.7 * shortened);
}

TEST_CASE("shapes: an edge that is highest during a rotation does not pass through the cloth") {
  const Level level = square(5, 0.2);
  const Positions& x = level.rest.vertices;
  const double apex = 0.1 / std::sqrt(2.0), lower = apex * (1 - std::cos(2 * M_PI / 180));  // 4.3e-5 m
  for (const bool passes : {true, false}) {
    ShapeParameters from = level_with(SolidKind::box, 0);
    from.size.setConstant(0.1);
    from.translate.z() = -apex + (passes ? -1.1e-4 : 0.5 * lower);
    from.rotate.y() = 43;
    ShapeParameters to = from;
    to.rotate.y() = 47;
    REQUIRE(bound(to, level)->intersections(x).empty());
    const double fraction = max_step(*bound(from, level), *bound(to, level), x).fraction;
    CHECK(fraction > 0.01);
    CHECK((fraction == 1) == passes);
    CHECK(fraction < (passes ? 2 : 0.2));
  }
}

TEST_CASE("shapes: a solid whose kind changes is refused by name") {
  const Level level = square(3, 0.2);
  const auto before = bound(level_with(SolidKind::box, 1), level);
  CHECK_THROWS_WITH(
      max_step(*before, *bound(level_with(SolidKind::sphere, 1), level), level.rest.vertices),
      Catch::StartsWith("thing: sphere cannot replace thing: box") && Catch::EndsWith(" during a run"));
}

TEST_CASE("shapes: the reference of tangential displacements is advected by solids") {
  const Level level = square(5, 0.2);
  Positions x = level.rest.vertices;
  x.col(2).setConstant(4e-4);
  for (const SolidKind kind : kinds) {
    const ShapeParameters from = level_with(kind, 0);
    ShapeParameters to = from;
    to.translate += Vector3d(0.01, 0.003, 0);
    const auto before = bound(from, level, 0.3);
    Positions reference = x.rowwise() + Eigen::RowVector3d(1e-5, 0, 0);
    const Positions start = reference;
    dynamic_cast<const KinematicObstacles&>(*bound(to, level, 0.3)).advect(*before, x, reference);
    INFO(to_string(kind));
    int advected = 0;
    for (int v = 0; v < x.rows(); ++v) {
      const Eigen::RowVector3d moved = reference.row(v) - start.row(v);
      if (moved.isZero(0)) continue;
      ++advected;
      CHECK((moved - Eigen::RowVector3d(0.01, 0.003, 0)).norm() < 1e-15);
    }
    CHECK(advected >= 1);
  }
  // A ball that turns about a horizontal axis advects what lies on it, with a static centre.
  const ShapeParameters from = level_with(SolidKind::sphere, 0);
  ShapeParameters to = from;
  to.rotate = {0, 1, 0};
  Positions reference = x;
  dynamic_cast<const KinematicObstacles&>(*bound(to, level, 0.3))
      .advect(*bound(from, level, 0.3), x, reference);
  CHECK((reference - x).col(0).maxCoeff() == Approx(0.1 * M_PI / 180).epsilon(1e-3));
}

TEST_CASE("shapes: contacts keep their keys while another cylinder grows") {
  const Level level = square(4, 0.5);  // larger than the box, whose edges touch it
  Positions x = level.rest.vertices;
  x.col(2).setConstant(4e-4);
  const auto keys = [&](double radius) {
    ShapeParameters roll = level_with(SolidKind::cylinder, 0.5);
    roll.radius = radius;
    const auto contact = bound({roll, level_with(SolidKind::box, 0)}, level, 0.3);
    const auto collisions = contact->build_candidates(x, x)->build_collisions(x);
    std::vector<ContactKey> all;
    for (const TangentialDisplacement& d : lagged_friction(*collisions, x, {})->tangential_displacements(x))
      all.push_back(d.contact);
    return all;
  };
  REQUIRE(keys(0.1).size() > 10);
  CHECK(keys(0.1) == keys(0.11));
}

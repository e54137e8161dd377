#include <catch2/catch.hpp>
#include <limits>

#include "core/numerics/contact_forces/barrier.h"
#include "core/numerics/model/required.h"
#include "plugins/contact/shapes/separation.h"
#include "tests/support/evaluate.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"
#include "tests/support/solids.h"

using namespace drape;
using namespace drape::shapes;
using Eigen::Vector3d;

namespace {

RandomNumbers uniform(7);

/// The cloth's positions at a place.
Positions lifted(const Level& level, double height, double x = 0, double y = 0) {
  return level.rest.vertices.rowwise() + Eigen::RowVector3d(x, y, height);
}

Positions gradient_at(const BoundContact& contact, const Positions& x) {
  return gradient_of(*collisions_at(contact, x), x);
}

double cloth_distance(const Solid& s, const Level& level, const Positions& x) {
  double d = std::numeric_limits<double>::infinity();
  for (const auto& t : level.rest.triangles.rowwise())
    d = std::min(d, separate(s, {x.row(t[0]), x.row(t[1]), x.row(t[2])}).separation);
  return d;
}

/// A cloth of few triangles, crumpled, its distance to the solid between 1 and 90 % of d̂, half of the time
/// below 5 %.
Positions near_cloth(const Solid& s, const Level& level) {
  for (;;) {
    const Vector3d middle = s.centre + uniform.vector(0.15);
    const SignedDistance n = s.nearest(middle);
    if (n.distance <= 0) continue;
    const Eigen::Quaterniond turn = uniform(0, 1) < 0.5
                                        ? Eigen::Quaterniond::UnitRandom()
                                        : Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), n.normal);
    Positions x = level.rest.vertices * turn.toRotationMatrix().transpose();
    for (Eigen::Index i = 0; i < x.rows(); ++i) x.row(i) += (middle + uniform.vector(5e-4)).transpose();
    const double wanted = uniform(0, 1) < 0.5 ? uniform(0.01, 0.05) : uniform(0.05, 0.9);
    for (int round = 0; round < 60; ++round) {
      const double d = cloth_distance(s, level, x);
      if (std::abs(d - wanted * dhat) < 0.1 * wanted * dhat) return x;
      x.rowwise() -= (d - wanted * dhat) * n.normal.transpose();
    }
  }
}

}  // namespace

TEST_CASE("shapes: the smallest gap is the cloth's distance") {
  for_each_solid([](const Solid& s, const ShapeParameters& p) {
    for (const Level& level : {square_sheet(3, 0.02), square_sheet(2, 0.2)}) {
      const auto contact = bound({p}, level);
      for (int i = 0; i < 150; ++i) {
        const Positions x = near_cloth(s, level);
        const double distance = cloth_distance(s, level, x),
                     seen = collisions_at(*contact, x)->smallest_gap();
        INFO("state " << i << ": distance " << distance << ", seen " << seen);
        CHECK(seen >= distance - 1e-12);
        const double inset = distance < 0.0499 * dhat ? 6e-5 * dhat : 6e-3 * dhat;  // of a rim's polygon
        CHECK(seen <= distance + (s.kind == SolidKind::cylinder ? inset : 1e-9));
      }
    }
  });
}

TEST_CASE("shapes: flat cloth on a face has the pressure κ |b'|") {
  const Level level = square_sheet(5, 0.04);
  for (const SolidKind kind : {SolidKind::half_space, SolidKind::box, SolidKind::cylinder})
    for (const double s : {0.05, 0.5, 0.9}) {
      const Positions g = gradient_at(*bound({upright(kind)}, level), lifted(level, s * dhat));
      INFO(to_string(kind) << " at " << s);
      CHECK(-g.col(2).sum() == Approx(-kappa * barrier(s).first * 0.04 * 0.04).epsilon(1e-9));
      CHECK(g.leftCols(2).norm() <= 1e-12 * g.norm());
    }
}

TEST_CASE("shapes: a cylinder thinner than the cloth's edges carries cloth however thin it is") {
  const Level level = square_sheet(4, 0.03);
  const auto force_on = [&](double radius) {
    ShapeParameters p = upright(SolidKind::cylinder);
    p.radius = radius;
    return -gradient_at(*bound({p}, level), lifted(level, 0.4 * dhat, 0.011, 0.004)).col(2).sum();
  };
  const double thin = force_on(1e-4);
  REQUIRE(thin > 0);
  for (const double radius : {1e-5, 1e-6, 1e-7}) CHECK(force_on(radius) == Approx(thin).epsilon(0.02));
}

TEST_CASE("shapes: forces are continuous during sliding") {
  const Level level = square_sheet(4, 0.03);
  std::vector<ShapeParameters> solids;
  for (const auto& [name, kind] : kind_names) solids.push_back(upright(some(kind)));
  for (const SolidKind kind : {SolidKind::capsule, SolidKind::cylinder}) {  // lying
    solids.push_back(upright(some(kind)));
    solids.back().rotate = {0, 90, 0};
    solids.back().translate.z() = -solids.back().radius;
  }
  for (const ShapeParameters& p : solids) {
    const auto contact = bound({p}, level);
    const auto largest_jump = [&](int steps) {
      double jump = 0, force = 0;
      Positions last;
      for (int i = 0; i <= steps; ++i) {
        const double shift = 0.12 * i / steps;
        const Positions g = gradient_at(*contact, lifted(level, 0.4 * dhat, shift, 0.31 * shift));
        if (i > 0) jump = std::max(jump, (g - last).norm());
        force = std::max(force, g.norm());
        last = g;
      }
      REQUIRE(force > 0);
      return jump / force;
    };
    const double coarse = largest_jump(2000), fine = largest_jump(16000);
    INFO(to_string(p.shape) << " at " << p.rotate.y() << "°: " << coarse << " → " << fine);
    CHECK(fine < std::max(0.25 * coarse, 1e-12));  // 0 on a plane
    CHECK(fine < 0.03);
  }
}

TEST_CASE("shapes: the blocking pair is named, also where the motion ends beyond the solid") {
  const Level level = square_sheet(2, 0.1);  // two triangles
  ShapeParameters p = upright(SolidKind::sphere);
  p.name = "ball";
  p.radius = 0.002;
  p.translate = {0.01, -0.02, -0.002};
  const auto contact = bound({p}, level);
  const Positions x0 = lifted(level, 0.01), x1 = lifted(level, -0.09);
  const StepLimit limit = contact->build_candidates(x0, x1)->max_step();
  CHECK(limit.fraction == Approx(0.09).epsilon(1e-9));
  CHECK(limit.by == "cloth triangle 0 and ball: sphere");
  CHECK(contact->intersections(x1).empty());  // it is on the other side
  const auto found = contact->intersections(lifted(level, -0.001));
  REQUIRE(found.size() == 1);
  CHECK(found[0].first == "cloth triangle 0");
  CHECK(found[0].second == "ball: sphere");
}

TEST_CASE("shapes: a half-space may face down, and needs a normal") {
  const Level level = square_sheet(3, 0.1);
  CHECK(bound({}, level) == nullptr);
  ShapeParameters p = upright(SolidKind::half_space);
  p.normal.setZero();
  CHECK_THROWS_WITH(bound({upright(SolidKind::box), p}, level),
                    "thing: half_space needs a \"normal\" that is not zero");
  p.normal = {0, 0, -3};  // turned over: the cloth is below
  p.name.clear();
  const auto contact = bound({p}, level);
  CHECK(contact->intersections(lifted(level, -0.01)).empty());
  const auto found = contact->intersections(lifted(level, 0.01));
  REQUIRE(found.size() == 8);
  CHECK(found[7].second == "shape 0: half_space");
}

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/numerics/contact_forces/barrier.h"
#include "core/numerics/model/required.h"
#include "plugins/contact/shapes/features.h"
#include "plugins/contact/shapes/separation.h"
#include "plugins/contact/shapes/shapes.h"
#include "tests/support/evaluate.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"

using namespace drape;
using namespace drape::shapes;
using Eigen::Vector3d;

namespace {

constexpr SolidKind kinds[] = {SolidKind::sphere, SolidKind::box, SolidKind::capsule, SolidKind::cylinder,
                               SolidKind::half_space};
constexpr double dhat = 1e-3, min_gap_fraction = 0.1, kappa = 20;

RandomNumbers uniform(7);

/// A shape of about 0.1 m, turned and off the origin.
ShapeParameters some(SolidKind kind) {
  ShapeParameters p;
  p.name = "thing";
  p.shape = kind;
  p.translate = {0.03, -0.02, 0.05};
  p.radius = 0.06;
  p.size = {0.1, 0.14, 0.08};
  p.height = 0.1;
  p.rotate = {20, -35, 50};
  p.normal = {0.3, -0.2, 1.1};
  return p;
}

/// The same, straight: top faces at z = 0.
ShapeParameters level_with(SolidKind kind) {
  ShapeParameters p = some(kind);
  p.rotate.setZero();
  p.normal = {0, 0, 2};
  p.translate = {0, 0, kind == SolidKind::half_space ? 0 : kind == SolidKind::box ? -0.04 : -0.05};
  return p;
}

std::unique_ptr<BoundContact> bound_to(const std::vector<ShapeParameters>& shapes, const Level& level) {
  Shapes::Parameters p;
  p.obstacles = shapes;
  p.dhat = dhat;
  p.min_gap_fraction = min_gap_fraction;
  p.stiffness = kappa;
  return Shapes(p).bind(level, Material());
}

/// The plugin's own conversion is tested through the model; here the solid is made by hand.
Solid solid_of(const ShapeParameters& p) {
  Solid s;
  s.kind = p.shape;
  s.centre = p.translate;
  const Vector3d angle = p.rotate * (M_PI / 180);
  s.axes = (Eigen::AngleAxisd(angle.z(), Vector3d::UnitZ()) *
            Eigen::AngleAxisd(angle.y(), Vector3d::UnitY()) * Eigen::AngleAxisd(angle.x(), Vector3d::UnitX()))
               .toRotationMatrix();
  if (p.shape == SolidKind::half_space)
    s.axes = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), p.normal).toRotationMatrix();
  if (p.shape == SolidKind::box)
    s.half = p.size / 2;
  else if (p.shape != SolidKind::half_space)
    s.radius = p.radius;
  if (p.shape == SolidKind::capsule || p.shape == SolidKind::cylinder) s.half.z() = p.height / 2;
  return s;
}

/// The solid's definition, by its own axes: nothing of solid.cpp is in it.
bool contains(const Solid& s, const Vector3d& p) {
  const Vector3d q = s.axes.transpose() * (p - s.centre);
  switch (s.kind) {
    case SolidKind::sphere:
      return q.norm() <= s.radius;
    case SolidKind::box:
      return (q.cwiseAbs() - s.half).maxCoeff() <= 0;
    case SolidKind::capsule:
      return (q - Vector3d(0, 0, std::clamp(q.z(), -s.half.z(), s.half.z()))).norm() <= s.radius;
    case SolidKind::cylinder:
      return q.head<2>().norm() <= s.radius && std::abs(q.z()) <= s.half.z();
    case SolidKind::half_space:
      break;
  }
  return q.z() <= 0;
}

/// min f over [0, 1], f convex.
template <class Function>
double smallest(const Function& f, int rounds = 80) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1);
  double low = 0, high = 1, a = 1 - golden, b = golden, fa = f(a), fb = f(b);
  for (int i = 0; i < rounds; ++i) {
    if (fa < fb) {
      high = b, b = a, fb = fa, a = high - golden * (high - low), fa = f(a);
    } else {
      low = a, a = b, fa = fb, b = low + golden * (high - low), fb = f(b);
    }
  }
  return std::min({fa, fb, f(0.0), f(1.0)});
}

/// The distance is convex, so a search within a search finds its minimum over the triangle.
double searched_distance(const Solid& s, const Corners& c) {
  return smallest(
      [&](double u) {
        return smallest(
            [&](double v) { return s.distance((1 - u) * c[0] + u * ((1 - v) * c[1] + v * c[2])); }, 60);
      },
      60);
}

/// A triangle whose distance is positive and mostly small.
Corners some_triangle(const Solid& s, double size) {
  for (;;) {
    const Vector3d middle = s.centre + uniform.vector(0.15);
    const SignedDistance n = s.nearest(middle);
    if (n.distance < 0 && s.kind != SolidKind::half_space) continue;
    const Vector3d at = middle - (n.distance - std::pow(10.0, uniform(-5, -1.5))) * n.normal;
    Corners c{at, at + uniform.vector(size), at + uniform.vector(size)};
    if (uniform(0, 1) < 0.5) {  // nearly tangent
      for (Vector3d& p : c) p -= 0.98 * n.normal.dot(p - at) * n.normal;
    }
    const double d = searched_distance(s, c);
    if (d > 1e-6) return c;
  }
}

/// The cloth's positions at a height.
Positions lifted(const Level& level, double height, double x = 0, double y = 0) {
  Positions p = level.rest.vertices;
  p.rowwise() += Eigen::RowVector3d(x, y, height);
  return p;
}

double energy_at(const BoundContact& bound, const Positions& x) { return collisions_at(bound, x)->value(x); }
Positions gradient_at(const BoundContact& bound, const Positions& x) {
  return gradient_of(*collisions_at(bound, x), x);
}

double cloth_distance(const Solid& s, const Level& level, const Positions& x) {
  double d = std::numeric_limits<double>::infinity();
  for (int i = 0; i < level.triangle_count(); ++i) {
    const auto t = level.rest.triangles.row(i);
    d = std::min(d, separate(s, {x.row(t[0]), x.row(t[1]), x.row(t[2])}).separation);
  }
  return d;
}

/// A cloth of few triangles, crumpled, its distance to the solid between 5 and 90 % of d̂.
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
    for (int round = 0; round < 60; ++round) {
      const double d = cloth_distance(s, level, x);
      if (d > 0.05 * dhat && d < 0.9 * dhat) return x;
      x.rowwise() -= (d - 0.4 * dhat) * n.normal.transpose();
    }
  }
}

}  // namespace

TEST_CASE("shapes: distance, gradient and curvature of solids") {
  for (const SolidKind kind : kinds) {
    const Solid s = solid_of(some(kind));
    int tested = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vector3d p = s.centre + uniform.vector(0.2);
      const SignedDistance n = s.nearest(p);
      INFO(to_string(kind) << " at " << p.transpose());
      CHECK(s.distance(p) == Approx(n.distance).margin(1e-15));
      CHECK((n.distance <= 0) == contains(s, p));
      CHECK(intersects(s, {p, p, p}) == contains(s, p));
      CHECK(n.normal.norm() == Approx(1));
      CHECK(n.normal.dot(n.tangent) == Approx(0).margin(1e-14));
      if (n.distance < 1e-4) continue;
      ++tested;
      // The nearest point is in the solid's closure, and nothing nearer is: a plane separates.
      CHECK(contains(s, p - (n.distance + 1e-9) * n.normal));
      CHECK(!contains(s, p - (n.distance - 1e-9) * n.normal));
      CHECK(n.normal.dot(p) - s.support(n.normal) == Approx(n.distance).epsilon(1e-12));
      const double h = 1e-6;
      const Vector3d b = n.normal.cross(n.tangent);
      const Eigen::Matrix3d hessian =
          n.curvature[0] * n.tangent * n.tangent.transpose() + n.curvature[1] * b * b.transpose();
      for (int k = 0; k < 3; ++k) {
        const SignedDistance plus = s.nearest(p + h * Vector3d::Unit(k)),
                             minus = s.nearest(p - h * Vector3d::Unit(k));
        CHECK((plus.distance - minus.distance) / (2 * h) == Approx(n.normal[k]).margin(1e-6));
        if ((plus.curvature - minus.curvature).norm() < 1e-2 * (1 + n.curvature.norm()))
          CHECK(((plus.normal - minus.normal) / (2 * h) - hessian.col(k)).norm() <
                1e-4 * (1 + hessian.norm()));
      }
    }
    REQUIRE(tested > 500);
  }
}

TEST_CASE("shapes: a solid's support function and its mesh") {
  const double volumes[] = {4.0 / 3 * M_PI * std::pow(0.06, 3), 0.1 * 0.14 * 0.08,
                            4.0 / 3 * M_PI * std::pow(0.06, 3) + M_PI * 0.06 * 0.06 * 0.1,
                            M_PI * 0.06 * 0.06 * 0.1};
  for (const SolidKind kind : kinds) {
    if (kind == SolidKind::half_space) continue;
    INFO(to_string(kind));
    const Solid s = solid_of(some(kind));
    const TriangleMesh mesh = tessellate(s, 1);
    CHECK(volume_of(mesh) == Approx(volumes[static_cast<int>(kind)]).epsilon(0.01));
    const Topology topology = Topology::of(mesh.triangles, static_cast<int>(mesh.vertices.rows()));
    CHECK(topology.edge_triangles.col(1).minCoeff() >= 0);  // closed
    for (Eigen::Index i = 0; i < mesh.vertices.rows(); ++i)
      CHECK(std::abs(s.distance(mesh.vertices.row(i))) < 1e-12);
    for (int i = 0; i < 100; ++i) {
      const Vector3d n = uniform.vector(1).normalized();
      const double drawn = (mesh.vertices * n).maxCoeff();
      CHECK(drawn <= s.support(n) + 1e-12);
      CHECK(drawn >= s.support(n) - 5e-4);
    }
  }
}

TEST_CASE("shapes: the distance of a triangle is the largest separation") {
  for (const SolidKind kind : kinds) {
    const Solid s = solid_of(some(kind));
    int small = 0;
    for (int i = 0; i < 300; ++i) {
      const Corners c = some_triangle(s, i % 2 ? 0.02 : 0.3);
      const double d = searched_distance(s, c), gap = separate(s, c).separation;
      INFO(to_string(kind) << " " << i << " distance " << d << " separation " << gap);
      CHECK(gap <= d * (1 + 1e-9) + 1e-14);
      CHECK(gap >= d * (1 - 1e-4) - 1e-10);
      small += d < dhat;
    }
    REQUIRE(small > 10);
  }
}

TEST_CASE("shapes: the smallest gap is the cloth's distance") {
  const Level level = square_sheet(3, 0.02), big = square_sheet(2, 0.2);
  for (const SolidKind kind : kinds) {
    const ShapeParameters p = some(kind);
    const Solid s = solid_of(p);
    for (const Level* l : {&level, &big}) {
      const auto bound = bound_to({p}, *l);
      for (int i = 0; i < 150; ++i) {
        const Positions x = near_cloth(s, *l);
        const double distance = cloth_distance(s, *l, x), seen = collisions_at(*bound, x)->smallest_gap();
        INFO(to_string(kind) << " state " << i << " distance " << distance << " seen " << seen);
        CHECK(seen >= distance - 1e-12);
        CHECK(seen <= distance + (kind == SolidKind::cylinder ? 6e-5 * dhat : 1e-9));
      }
    }
  }
}

TEST_CASE("shapes: a half-space's axes are those of the shortest rotation, wherever its normal points") {
  Solid s;
  s.kind = SolidKind::half_space;
  for (const Vector3d& normal :
       {Vector3d(0, 0, 1), Vector3d(0, 0, -3), Vector3d(1e-9, 0, 1), Vector3d(0, 1e-9, -1),
        Vector3d(2, -1, 0.5), Vector3d(-3, 0, 0), Vector3d(1e-3, 2e-3, -1e-3)}) {
    s.plane = normal;
    s.update_axes();
    INFO(normal.transpose());
    CHECK((s.axes.transpose() * s.axes - Eigen::Matrix3d::Identity()).norm() < 1e-15);
    CHECK(s.axes.determinant() == Approx(1));
    CHECK((s.axes.col(2) - normal.normalized()).norm() < 1e-15);
    if (normal.normalized().z() > -0.999)
      CHECK(
          (s.axes - Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), normal).toRotationMatrix()).norm() <
          1e-14);
  }
  s.plane = Vector3d::UnitZ();
  s.update_axes();
  CHECK(s.axes == Eigen::Matrix3d::Identity());
}

TEST_CASE("shapes: flat cloth on a face has the pressure κ |b'|") {
  const Level level = square_sheet(5, 0.04);
  for (const SolidKind kind : {SolidKind::half_space, SolidKind::box, SolidKind::cylinder}) {
    const auto bound = bound_to({level_with(kind)}, level);
    for (const double s : {0.05, 0.5, 0.9}) {
      const Positions x = lifted(level, s * dhat), g = gradient_at(*bound, x);
      INFO(to_string(kind) << " at " << s);
      CHECK(-g.col(2).sum() == Approx(-kappa * barrier(s).first * 0.04 * 0.04).epsilon(1e-9));
      CHECK(g.leftCols(2).norm() <= 1e-12 * g.norm());
    }
    CHECK(energy_at(*bound, lifted(level, 1.001 * dhat)) == 0);
  }
}

TEST_CASE("shapes: a cylinder thinner than the cloth's edges carries cloth however thin it is") {
  const Level level = square_sheet(4, 0.03);
  const auto force_on = [&](double radius) {
    ShapeParameters p = level_with(SolidKind::cylinder);
    p.radius = radius;
    const auto bound = bound_to({p}, level);
    return -gradient_at(*bound, lifted(level, 0.4 * dhat, 0.011, 0.004)).col(2).sum();
  };
  const double thin = force_on(1e-4);
  REQUIRE(thin > 0);
  for (const double radius : {1e-5, 1e-6, 1e-7}) CHECK(force_on(radius) == Approx(thin).epsilon(0.02));
}

TEST_CASE("shapes: forces are continuous during sliding") {
  const Level level = square_sheet(4, 0.03);
  for (const SolidKind kind : kinds) {
    ShapeParameters p = level_with(kind);
    if (kind == SolidKind::sphere) p.translate.z() = -p.radius;
    const bool lies = kind == SolidKind::capsule || kind == SolidKind::cylinder;
    for (const bool lying : {false, true}) {
      if (lying && !lies) continue;
      if (lying) p.rotate = {0, 90, 0}, p.translate = {0, 0, -p.radius};
      if (kind == SolidKind::capsule && !lying) p.translate.z() = -p.radius - p.height / 2;
      const auto bound = bound_to({p}, level);
      const auto largest_jump = [&](int steps) {
        double jump = 0, force = 0;
        Positions last;
        for (int i = 0; i <= steps; ++i) {
          const double shift = 0.12 * i / steps;
          const Positions g = gradient_at(*bound, lifted(level, 0.4 * dhat, shift, 0.31 * shift));
          if (i > 0) jump = std::max(jump, (g - last).norm());
          force = std::max(force, g.norm());
          last = g;
        }
        REQUIRE(force > 0);
        return jump / force;
      };
      const double coarse = largest_jump(2000), fine = largest_jump(16000);
      INFO(to_string(kind) << (lying ? " lying" : "") << ": " << coarse << " → " << fine);
      CHECK(fine < std::max(0.25 * coarse, 1e-12));  // 0 on a plane
      CHECK(fine < 0.03);
    }
  }
}

TEST_CASE("shapes: a step never leads to an intersection") {
  int cut = 0, free = 0, loose = 0;
  for (const SolidKind kind : kinds) {
    ShapeParameters p = some(kind);
    for (int i = 0; i < 400; ++i) {
      if (i % 2) p.radius = 0.004, p.size.setConstant(0.006), p.height = 0.006;  // between the vertices
      const Solid s = solid_of(p);
      const Corners from = some_triangle(s, i % 3 ? 0.05 : 0.2);
      Corners to = from;
      const Vector3d through = 2.2 * (s.centre - (from[0] + from[1] + from[2]) / 3);
      const double turn = i % 5 ? 0.02 : 0.5, size = i % 7 ? 1 : 10;
      for (Vector3d& q : to) q += size * (through + uniform.vector(turn));
      const double start = searched_distance(s, from), part = advance(s, from, to, min_gap_fraction);
      INFO(to_string(kind) << " " << i << ": " << part);
      CHECK(part >= 0);
      CHECK(part <= 1);
      (part < 1 ? cut : free) += 1;
      const auto distance_at = [&](double t) {
        Corners now;
        for (int c = 0; c < 3; ++c) now[c] = from[c] + t * (to[c] - from[c]);
        return searched_distance(s, now);
      };
      for (int k = 1; k <= 20; ++k)
        CHECK(distance_at(part * k / 20) >= min_gap_fraction * start * (1 - 1e-3) - 1e-11);
      // Not overly conservative, except for long rolling motions about an edge.
      if (part < 1) loose += distance_at(part) > 1.1 * min_gap_fraction * start;
    }
  }
  REQUIRE(cut > 1000);
  REQUIRE(free > 20);
  CHECK(loose < 0.01 * cut);
}

TEST_CASE("shapes: max_step names the blocking pair") {
  const Level level = square_sheet(2, 0.1);  // two triangles
  ShapeParameters p = level_with(SolidKind::sphere);
  p.name = "ball";
  p.radius = 0.002;
  p.translate = {0.01, -0.02, -0.002};
  const auto bound = bound_to({p}, level);
  const Positions x0 = lifted(level, 0.01), x1 = lifted(level, -0.09);
  const StepLimit limit = bound->build_candidates(x0, x1)->max_step();
  CHECK(limit.fraction == Approx(0.09).epsilon(1e-9));
  CHECK(limit.by == "cloth triangle 0 and ball: sphere");
  CHECK(bound->intersections(x0).empty());
  CHECK(bound->intersections(x1).empty());  // it is on the other side
  const auto found = bound->intersections(lifted(level, -0.001));
  REQUIRE(found.size() == 1);
  CHECK(found[0].first == "cloth triangle 0");
  CHECK(found[0].second == "ball: sphere");
  const StepLimit away = bound->build_candidates(x0, lifted(level, 1))->max_step();
  CHECK(away.fraction == 1);
  CHECK(away.by.empty());
  const auto far =
      bound->build_candidates(lifted(level, 1), lifted(level, 2))->build_collisions(lifted(level, 1.5));
  CHECK(far->contact_count() == 0);
  CHECK(far->smallest_gap() == std::numeric_limits<double>::infinity());
  CHECK(bound->obstacles().size() == 1);
}

TEST_CASE("shapes: collisions at a state do not depend on the motion of the candidates") {
  const Level level = square_sheet(9, 0.16);
  std::vector<ShapeParameters> all;
  for (const SolidKind kind : kinds) all.push_back(some(kind));
  all[4].translate.z() = -0.2;
  for (int i = 0; i < 4; ++i)
    all[i].translate.head<2>() = Eigen::Vector2d(i % 2 ? 0.1 : -0.1, i / 2 ? 0.1 : -0.1);
  const auto bound = bound_to(all, level);
  double height = 0.4;
  Positions x0 = lifted(level, height);
  int contacts = 0;
  for (int i = 0; i < 12; ++i) {
    Positions x1 = x0;
    x1.col(2).array() -= 0.05;
    const auto candidates = bound->build_candidates(x0, x1);
    const double part = candidates->max_step().fraction;
    const Positions x = x0 + part * (x1 - x0);
    CHECK(bound->intersections(x).empty());
    const auto set = candidates->build_collisions(x);
    contacts += set->contact_count();
    CHECK(set->value(x) == Approx(energy_at(*bound, x)).epsilon(1e-12));
    CHECK((gradient_of(*set, x) - gradient_at(*bound, x)).norm() <= 1e-12 * gradient_at(*bound, x).norm());
    x0 = x;
  }
  REQUIRE(contacts > 0);
}

TEST_CASE("shapes: parameters") {
  const Level level = square_sheet(3, 0.1);
  CHECK(bound_to({}, level) == nullptr);
  ShapeParameters p = level_with(SolidKind::half_space);
  p.normal.setZero();
  CHECK_THROWS_WITH(bound_to({level_with(SolidKind::box), p}, level),
                    "thing: half_space needs a \"normal\" that is not zero");
  p.normal = {0, 0, -3};  // turned over: the cloth is below
  p.name.clear();
  const auto bound = bound_to({p}, level);
  CHECK(bound->intersections(lifted(level, -0.01)).empty());
  const auto found = bound->intersections(lifted(level, 0.01));
  REQUIRE(found.size() == 8);
  CHECK(found[7].second == "shape 0: half_space");
}

TEST_CASE("shapes: gaps near round-off are resolved at edges and rims") {
  for (const SolidKind kind : {SolidKind::box, SolidKind::cylinder}) {
    const ShapeParameters p = some(kind);
    const Solid s = solid_of(p);
    const double top = kind == SolidKind::box ? p.size.z() / 2 : p.height / 2;
    for (int i = 0; i < 50; ++i) {
      const double angle = uniform(0, 2 * M_PI), turn = uniform(0.2, M_PI - 0.2);
      Vector3d out(std::cos(angle), std::sin(angle), 0), on(p.radius * out.x(), p.radius * out.y(), top);
      if (kind == SolidKind::box) out = {1, 0, 0}, on = {p.size.x() / 2, uniform(-0.05, 0.05), top};
      const Vector3d along = Vector3d::UnitZ().cross(out), up = (out + Vector3d::UnitZ()).normalized();
      const Vector3d edge = 0.01 * (std::cos(turn) * along + std::sin(turn) * up.cross(along));
      for (const double gap : {1e-8, 1e-10, 1e-12}) {
        const Vector3d near = on + gap * up;
        const Corners c{s.to_world(near - 0.3 * edge), s.to_world(near + 0.7 * edge),
                        s.to_world(near + 0.02 * up)};
        INFO(to_string(kind) << " " << i << ", gap " << gap << ", separation " << separate(s, c).separation);
        CHECK(separate(s, c).separation == Approx(gap).epsilon(1e-3).margin(2e-16));
        CHECK(!intersects(s, c));
      }
    }
  }
}

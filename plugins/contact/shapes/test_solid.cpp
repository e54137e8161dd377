#include <catch2/catch.hpp>
#include <map>

#include "plugins/contact/shapes/features.h"
#include "plugins/contact/shapes/separation.h"
#include "plugins/contact/shapes/solid.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"
#include "tests/support/solids.h"

using namespace drape;
using namespace drape::shapes;
using Eigen::Vector3d;

namespace {

RandomNumbers uniform(7);

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
double smallest(const Function& f) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1);
  double low = 0, high = 1, a = 1 - golden, b = golden, fa = f(a), fb = f(b);
  for (int i = 0; i < 60; ++i) {
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
  return smallest([&](double u) {
    return smallest([&](double v) { return s.distance((1 - u) * c[0] + u * ((1 - v) * c[1] + v * c[2])); });
  });
}

/// A triangle whose distance is positive and mostly small.
Corners some_triangle(const Solid& s, double size) {
  for (;;) {
    const Vector3d middle = s.centre + uniform.vector(0.15);
    const SignedDistance n = s.nearest(middle);
    if (n.distance < 0 && s.kind != SolidKind::half_space) continue;
    const Vector3d at = middle - (n.distance - std::pow(10.0, uniform(-5, -1.5))) * n.normal;
    Corners c{at, at + uniform.vector(size), at + uniform.vector(size)};
    if (uniform(0, 1) < 0.5)  // nearly tangent
      for (Vector3d& p : c) p -= 0.98 * n.normal.dot(p - at) * n.normal;
    if (searched_distance(s, c) > 1e-6) return c;
  }
}

}  // namespace

TEST_CASE("shapes: distance, gradient and curvature of solids") {
  for_each_solid([](const Solid& s, const ShapeParameters&) {
    int tested = 0;
    for (int i = 0; i < 3000; ++i) {
      const Vector3d p = s.centre + uniform.vector(0.2);
      const SignedDistance n = s.nearest(p);
      INFO(p.transpose());
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
  });
}

TEST_CASE("shapes: a solid's mesh is closed, has its volume and agrees with its support function") {
  const double ball = 4.0 / 3 * M_PI * std::pow(0.06, 3), roll = M_PI * 0.06 * 0.06 * 0.1;
  const std::map<SolidKind, double> volumes = {{SolidKind::sphere, ball},
                                               {SolidKind::box, 0.1 * 0.14 * 0.08},
                                               {SolidKind::capsule, ball + roll},
                                               {SolidKind::cylinder, roll}};
  for_each_solid([&](const Solid& s, const ShapeParameters&) {
    if (s.kind == SolidKind::half_space) return;
    const TriangleMesh mesh = tessellate(s, 1, drawn_sides(1));
    CHECK(volume_of(mesh) == Approx(volumes.at(s.kind)).epsilon(0.01));
    const Topology topology = Topology::of(mesh.triangles, static_cast<int>(mesh.vertices.rows()));
    CHECK(topology.edge_triangles.col(1).minCoeff() >= 0);  // closed
    for (const auto& vertex : mesh.vertices.rowwise()) CHECK(std::abs(s.distance(vertex)) < 1e-12);
    for (int i = 0; i < 100; ++i) {
      const Vector3d n = uniform.vector(1).normalized();
      const double drawn = (mesh.vertices * n).maxCoeff();
      CHECK(drawn <= s.support(n) + 1e-12);
      CHECK(drawn >= s.support(n) - 5e-4);
    }
  });
}

TEST_CASE("shapes: very many solids are drawn with fewer triangles, still closed") {
  CHECK(drawn_sides(900) == 64);
  CHECK(drawn_sides(10'000) == 20);
  CHECK(drawn_sides(10'000'000) == 12);
  for_each_solid([](const Solid& s, const ShapeParameters&) {
    if (s.kind == SolidKind::half_space) return;
    const TriangleMesh mesh = tessellate(s, 1, drawn_sides(10'000));
    CHECK(mesh.triangles.rows() <= 450);
    const Topology topology = Topology::of(mesh.triangles, static_cast<int>(mesh.vertices.rows()));
    CHECK(topology.edge_triangles.col(1).minCoeff() >= 0);
    for (const auto& vertex : mesh.vertices.rowwise()) CHECK(std::abs(s.distance(vertex)) < 1e-12);
  });
}

TEST_CASE("shapes: the distance of a triangle is the largest separation") {
  for_each_solid([](const Solid& s, const ShapeParameters&) {
    int small = 0;
    for (int i = 0; i < 300; ++i) {
      const Corners c = some_triangle(s, i % 2 ? 0.02 : 0.3);
      const double d = searched_distance(s, c), gap = separate(s, c).separation;
      INFO(i << ": distance " << d << ", separation " << gap);
      CHECK(gap <= d * (1 + 1e-9) + 1e-14);
      CHECK(gap >= d * (1 - 1e-4) - 1e-10);
      small += d < dhat;
    }
    REQUIRE(small > 10);
  });
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
    const auto shortest = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), normal).toRotationMatrix();
    if (normal.normalized().z() > -0.999) CHECK((s.axes - shortest).norm() < 1e-14);
  }
}

TEST_CASE("shapes: a step never leads to an intersection") {
  int cut = 0, free = 0, loose = 0;
  for_each_solid([&](const Solid&, ShapeParameters p) {
    for (int i = 0; i < 400; ++i) {
      if (i % 2) p.radius = 0.004, p.size.setConstant(0.006), p.height = 0.006;  // between the vertices
      const Solid s = solid_of(p);
      const Corners from = some_triangle(s, i % 3 ? 0.05 : 0.2);
      Corners to = from;
      const Vector3d through = 2.2 * (s.centre - (from[0] + from[1] + from[2]) / 3);
      const double turn = i % 5 ? 0.02 : 0.5, size = i % 7 ? 1 : 10, fraction = 0.1;
      for (Vector3d& q : to) q += size * (through + uniform.vector(turn));
      const double least = fraction * searched_distance(s, from), part = advance(s, from, to, fraction);
      INFO(i << ": " << part);
      CHECK(part >= 0);
      CHECK(part <= 1);
      (part < 1 ? cut : free) += 1;
      const auto distance_at = [&](double t) {
        Corners now;
        for (int c = 0; c < 3; ++c) now[c] = from[c] + t * (to[c] - from[c]);
        return searched_distance(s, now);
      };
      for (int k = 1; k <= 20; ++k) CHECK(distance_at(part * k / 20) >= least * (1 - 1e-3) - 1e-11);
      // Not overly conservative, except for long rolling motions about an edge.
      if (part < 1) loose += distance_at(part) > 1.1 * least;
    }
  });
  REQUIRE(cut > 1000);
  REQUIRE(free > 20);
  CHECK(loose < 0.01 * cut);
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

#include <Eigen/Geometry>
#include <functional>
#include <limits>
#include <numbers>

#include "plugins/metric/curvature_consistency/curvature.h"
#include "tests/support/closed_meshes.h"
#include "tests/support/metric_check.h"
#include "tests/support/unregistered.h"
// After it:
#include "plugins/metric/curvature_consistency/curvature_consistency.cpp"

using namespace drape;
using Eigen::Vector3d;
using Eigen::VectorXd;
using std::numbers::pi;

namespace {

/// A mesh with its closed-form curvatures; `inner` is 1 for vertices away from any border and 0 for others.
struct Surface : TriangleMesh {
  VectorXd mean, gaussian;
  Eigen::ArrayXd inner;
};

struct Exact {
  Vector3d point;
  double mean, gaussian;
};

/// An n×m grid over [0, 1]², wrapped around where asked, its triangles facing ∂u × ∂v.
Surface grid(int n, int m, bool wrap_u, bool wrap_v, const std::function<Exact(double u, double v)>& at) {
  const int rows = wrap_u ? n : n + 1, columns = wrap_v ? m : m + 1, count = rows * columns;
  Surface s{
      {Positions(count, 3), Triangles(2 * n * m, 3)}, VectorXd(count), VectorXd(count), VectorXd(count)};
  const auto away = [](bool wrap, double t) { return wrap || (t > 0.24 && t < 0.76); };
  for (int k = 0; k < count; ++k) {
    const double u = double(k / columns) / n, v = double(k % columns) / m;
    const Exact e = at(u, v);
    s.vertices.row(k) = e.point.transpose();
    s.mean[k] = e.mean;
    s.gaussian[k] = e.gaussian;
    s.inner[k] = away(wrap_u, u) && away(wrap_v, v);
  }
  for (int t = 0; t < n * m; ++t) {
    const auto corner = [&](int i, int j) { return (t / m + i) % rows * columns + (t % m + j) % columns; };
    s.triangles.row(2 * t) << corner(0, 0), corner(1, 0), corner(1, 1);
    s.triangles.row(2 * t + 1) << corner(0, 0), corner(1, 1), corner(0, 1);
  }
  return s;
}

Surface plane(int n) {
  return grid(n, n, false, false, [](double u, double v) { return Exact{{u, v, 0.3 * u - 0.2 * v}, 0, 0}; });
}

Surface saddle(int n) {  // z = x² − 2y²/3 over [−½, ½]²
  return grid(n, n, false, false, [](double u, double v) {
    const double x = u - 0.5, y = v - 0.5, zx = 2 * x, zy = -4 * y / 3, zxx = 2, zyy = -4.0 / 3;
    const double w = 1 + zx * zx + zy * zy;
    const double mean = ((1 + zy * zy) * zxx + (1 + zx * zx) * zyy) / (2 * std::pow(w, 1.5));
    return Exact{{x, y, x * x - 2 * y * y / 3}, -mean, zxx * zyy / (w * w)};
  });
}

Surface torus(int n) {  // radii 1 and 0.4, facing outward
  return grid(2 * n, n, true, true, [](double u, double v) {
    const double a = 2 * pi * u, b = 2 * pi * v, ring = 1 + 0.4 * std::cos(b);
    return Exact{{ring * std::cos(a), ring * std::sin(a), 0.4 * std::sin(b)},
                 0.5 * (1 / 0.4 + std::cos(b) / ring),
                 std::cos(b) / (0.4 * ring)};
  });
}

/// A square of side 1, wrapped onto a sphere along the geodesics from its pole.
Surface cap(int n, double radius) {
  return grid(n, n, false, false, [radius](double u, double v) {
    const double x = u - 0.5, y = v - 0.5, r = std::hypot(x, y), a = r / radius;
    const double across = r > 0 ? radius * std::sin(a) / r : 1;
    return Exact{{across * x, across * y, radius * std::cos(a)}, 1 / radius, 1 / (radius * radius)};
  });
}

VertexCurvatures fit(const TriangleMesh& m, int rings = 5) {
  const Topology topology = Topology::of(m.triangles, static_cast<int>(m.vertices.rows()));
  return fit_curvatures(m.vertices, m.triangles, topology, rings);
}
VertexCurvatures ddg(const TriangleMesh& m) {
  const Topology topology = Topology::of(m.triangles, static_cast<int>(m.vertices.rows()));
  return ddg_curvatures(m.vertices, m.triangles, topology);
}

/// Root mean square over the inner vertices, relative to the largest exact value.
double error(const Surface& s, const VectorXd& values, const VectorXd& exact) {
  REQUIRE(s.inner.sum() > 20);
  const double square = (s.inner * (values - exact).array().square()).sum() / s.inner.sum();
  return std::sqrt(square) / (s.inner * exact.array().abs()).maxCoeff();
}

/// Errors of the mean and of the Gaussian curvature, by the fit and by angles.
Eigen::Array4d errors(const Surface& s) {
  const VertexCurvatures f = fit(s), d = ddg(s);
  return {error(s, f.mean, s.mean), error(s, f.gaussian, s.gaussian), error(s, d.mean, s.mean),
          error(s, d.gaussian, s.gaussian)};
}

double largest(const VectorXd& values) { return values.cwiseAbs().maxCoeff(); }

MetricResult evaluate(const Level& level, const Positions& x, const Positions& other, int rings = 5) {
  return CurvatureConsistency(CurvatureConsistency::Parameters{rings})
      .evaluate({level, empty_model(), x, &other});
}

}  // namespace

TEST_CASE("curvatures converge to closed forms") {
  for (const auto& [name, make] : {std::pair("saddle", &saddle), std::pair("torus", &torus)}) {
    Eigen::Array4d last = errors(make(32));
    for (const int n : {64, 128}) {
      const Eigen::Array4d now = errors(make(n));
      INFO(name << ", " << n << ": " << last.transpose() << " → " << now.transpose());
      CHECK((now < 0.3 * last).all());  // smooth images of a lattice: second order, four times smaller
      last = now;
    }
    CHECK((last < Eigen::Array4d(0.02, 0.02, 0.002, 0.002)).all());
  }
}

TEST_CASE("the strongest principal curvature keeps its sign, and belongs to H and K") {
  const VertexCurvatures f = fit(saddle(24));
  const VectorXd other = 2 * f.mean - f.strongest;
  CHECK(largest(f.strongest.cwiseProduct(other) - f.gaussian) < 1e-10);
  CHECK((f.strongest.cwiseAbs() - other.cwiseAbs()).minCoeff() > -1e-10);
  // At the middle κ = (4/3, −2) from z = x² − 2y²/3 under an upward normal.
  const int middle = 12 * 25 + 12;
  CHECK(f.strongest[middle] == Approx(-2).epsilon(0.03));
  CHECK(other[middle] == Approx(4.0 / 3).epsilon(0.03));
}

TEST_CASE("a plane has no curvature inside, and only its border's own turning at the border") {
  const int n = 12;
  const Surface s = plane(n);
  const VertexCurvatures f = fit(s), d = ddg(s);
  for (const VectorXd& none : {f.mean, f.gaussian, d.mean}) CHECK(largest(none) < 1e-9);
  // The corner keeps π minus its angle over its area; straight borders and inner vertices have none.
  const Vector3d a = s.vertices.row(n + 1) - s.vertices.row(0), b = s.vertices.row(1) - s.vertices.row(0);
  const double area = a.cross(b).norm(), angle = std::atan2(area, a.dot(b));
  CHECK(d.gaussian[0] == Approx((pi - angle) / (area / 3)));
  VectorXd rest = d.gaussian;
  for (const int corner : {0, n, n * (n + 1), (n + 1) * (n + 1) - 1}) rest[corner] = 0;
  CHECK(largest(rest) < 1e-8);
  // A vertex whose neighbours' normals all oppose its own is fitted to all of them.
  Surface folded = plane(6);
  folded.vertices.row(0) << 0.2, 0.2, 0.3 * 0.2 - 0.2 * 0.2;  // the corner, turned over inside the plane
  const VertexCurvatures g = fit(folded);
  for (const VectorXd& none : {g.mean, g.gaussian}) CHECK(largest(none) < 1e-9);
  CHECK(g.strongest.allFinite());
}

TEST_CASE("angle defects add up to the Euler characteristic") {
  const auto total = [](const TriangleMesh& m) {  // rest = deformed: its areas are the A_i
    return Level::of(0, m).vertex_area.dot(ddg(m).gaussian);
  };
  CHECK(total(sphere_mesh(1, 2)) == Approx(4 * pi));
  CHECK(total(torus(12)) == Approx(0).margin(1e-9));
  CHECK(total(saddle(9)) == Approx(2 * pi));
}

TEST_CASE("the other side of a fold is left out of the fit") {
  // Two flat legs at 20° to each other, creased along one row. Less than five rings from the crease, the
  // other leg's normals oppose; the crease itself lies in the leg's plane.
  const int n = 24;
  const double slope = 10 * pi / 180;
  const Surface crease = grid(n, n, false, false, [&](double u, double v) {
    const double s = u - 0.5;
    return Exact{{-std::abs(s) * std::cos(slope), v, s * std::sin(slope)}, 0, 0};
  });
  VectorXd mean = fit(crease).mean;
  auto at_crease = mean.segment(n / 2 * (n + 1), n + 1);
  CHECK(at_crease.segment(1, n - 1).cwiseAbs().minCoeff() > 1);
  at_crease.setZero();
  CHECK(largest(mean) < 1e-8);
}

TEST_CASE("fewer rings smooth less, and rings end with the mesh, however many are asked for") {
  // The fit's error is of the square of its reach: 4/25 of it with two rings for five.
  const Surface s = torus(64), small = torus(12);
  const double five = error(s, fit(s, 5).mean, s.mean), two = error(s, fit(s, 2).mean, s.mean);
  CHECK(two / five == Approx(4.0 / 25).epsilon(0.3));
  const VectorXd all = fit(small, 100).mean;
  CHECK(all == fit(small, std::numeric_limits<int>::max()).mean);
  CHECK(all != fit(small, 2).mean);
}

TEST_CASE("a mesh without area is refused by name, one of four vertices has finite curvatures") {
  Surface s = plane(4);
  s.vertices.setConstant(1);
  CHECK_THROWS_WITH(fit(s), Catch::Contains("vertex 0"));
  CHECK_THROWS_WITH(ddg(s), Catch::Contains("vertex 0"));
  const VertexCurvatures f = fit(cap(1, 2.0));  // fewer neighbours than unknowns
  CHECK((f.mean + f.gaussian).allFinite());
}

TEST_CASE("consistency of two spherical caps is the closed form") {
  // Σ m (1/R₁ − 1/R₂)² over a rest square of area 1.
  const double exact_mean = std::pow(1 / 1.5 - 1 / 1.0, 2), exact_gaussian = std::pow(1 / 2.25 - 1, 2);
  Eigen::Array3d last(1, 1, 1);
  for (const int n : {32, 64, 128}) {
    Surface flat = plane(n);
    flat.vertices.col(2).setZero();
    const Level level = Level::of(1, flat);
    const MetricResult result = evaluate(level, cap(n, 1.0).vertices, cap(n, 1.5).vertices);
    const Eigen::Array3d now =
        (Eigen::Array3d(value(result, "d_H_fit") / exact_mean, value(result, "d_K_fit") / exact_gaussian,
                        value(result, "d_H_ddg") / exact_mean) -
         1)
            .abs();
    INFO(n << ": " << now.transpose());
    CHECK((now < 0.6 * last).all());
    last = now;
  }
  CHECK((last < Eigen::Array3d(0.01, 0.02, 0.03)).all());
}

TEST_CASE("fields and weights belong to the right state") {
  const Surface s = torus(24);
  const Level level = Level::of(0, {2 * s.vertices, s.triangles});  // rest areas four times the deformed ones
  const MetricResult result = evaluate(level, s.vertices, 0.5 * s.vertices, 2);
  const VertexCurvatures f = fit(s, 2);
  CHECK(largest(result.fields[0].values - f.mean) < 1e-9);  // 2 H − H
  CHECK(result.fields[1].values == f.strongest);
  CHECK(largest(result.fields[2].values - 2 * f.strongest) < 1e-9);
  CHECK(value(result, "d_H_fit") == Approx(level.vertex_area.dot(f.mean.cwiseAbs2())));
}

TEST_CASE("curvatures of states seen lately are kept, and belong to their own state and mesh") {
  const Surface s = torus(12);
  TriangleMesh turned_over = s;
  turned_over.triangles.col(1).swap(turned_over.triangles.col(2));
  const Level level = Level::of(0, s), other = Level::of(0, turned_over);
  const RecentCurvatures recent(2);
  const auto first = recent.of(s.vertices, level), reversed = recent.of(s.vertices, other),
             large = recent.of(2 * s.vertices, level);
  CHECK(first->fit.mean.mean() > 0.5);  // orientation decides the sign of H
  CHECK(largest(first->fit.mean + reversed->fit.mean) < 1e-9);
  CHECK(largest(first->ddg.mean + reversed->ddg.mean) < 1e-9);
  CHECK(largest(first->fit.strongest + reversed->fit.strongest) < 1e-9);
  CHECK(largest(first->fit.gaussian - reversed->fit.gaussian) < 1e-9);
  CHECK(largest(first->fit.mean - 2 * large->fit.mean) < 1e-9);
  // As a run uses them: two targets, and one state after the other.
  for (int k = 3; k < 8; ++k) {
    const auto state = recent.of(k * s.vertices, level);
    for (const auto& target : {first, reversed}) {
      CHECK(recent.of(s.vertices, target == first ? level : other) == target);
      CHECK(recent.of(k * s.vertices, level) == state);
    }
  }
  CHECK(recent.of(2 * s.vertices, level) != large);
}

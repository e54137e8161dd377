#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <numbers>
#include <vector>

#include "plugins/metric/curvature_consistency/curvature.h"
#include "plugins/metric/curvature_consistency/quadric.h"
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

/// A mesh with its closed-form curvatures; `inner` vertices are those away from any border.
struct Surface {
  Positions x;
  Triangles triangles;
  VectorXd mean, gaussian;
  std::vector<char> inner;
};

struct Exact {
  Vector3d point;
  double mean, gaussian;
};

/// An n×m grid over [0, 1]², wrapped around where asked, its triangles facing ∂u × ∂v.
Surface grid(int n, int m, bool wrap_u, bool wrap_v, const std::function<Exact(double u, double v)>& at) {
  const int rows = wrap_u ? n : n + 1, columns = wrap_v ? m : m + 1;
  Surface s{Positions(rows * columns, 3), Triangles(2 * n * m, 3), VectorXd(rows * columns),
            VectorXd(rows * columns), std::vector<char>(rows * columns)};
  const auto away = [](bool wrap, double t) { return wrap || (t > 0.24 && t < 0.76); };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      const double u = double(i) / n, v = double(j) / m;
      const Exact e = at(u, v);
      const int k = i * columns + j;
      s.x.row(k) = e.point.transpose();
      s.mean[k] = e.mean;
      s.gaussian[k] = e.gaussian;
      s.inner[k] = away(wrap_u, u) && away(wrap_v, v);
    }
  for (int i = 0, t = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const int i1 = (i + 1) % rows, j1 = (j + 1) % columns;
      const int a = i * columns + j, b = i1 * columns + j, c = i1 * columns + j1, d = i * columns + j1;
      s.triangles.row(t++) << a, b, c;
      s.triangles.row(t++) << a, c, d;
    }
  return s;
}

Surface plane(int n) {
  return grid(n, n, false, false, [](double u, double v) { return Exact{{u, v, 0.3 * u - 0.2 * v}, 0, 0}; });
}

Surface cylinder(int n) {  // radius 0.5, facing outward, triangles of aspect π/2
  return grid(2 * n, n, true, false, [](double u, double v) {
    return Exact{{0.5 * std::cos(2 * pi * u), 0.5 * std::sin(2 * pi * u), v}, 1.0, 0.0};
  });
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

VertexCurvatures fit(const Surface& s, int rings = 5) {
  return fit_curvatures(s.x, s.triangles, Topology::of(s.triangles, static_cast<int>(s.x.rows())), rings);
}

VertexCurvatures ddg(const Surface& s) {
  return ddg_curvatures(s.x, s.triangles, Topology::of(s.triangles, static_cast<int>(s.x.rows())));
}

/// Root mean square over the inner vertices, relative to the largest exact value (or to 1 if that is 0).
double error(const Surface& s, const VectorXd& values, const VectorXd& exact) {
  double sum = 0, scale = 0;
  int count = 0;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (!s.inner[i]) continue;
    sum += std::pow(values[i] - exact[i], 2);
    scale = std::max(scale, std::abs(exact[i]));
    ++count;
  }
  REQUIRE(count > 20);
  return std::sqrt(sum / count) / (scale > 0 ? scale : 1);
}

struct Errors {
  double fit_mean, fit_gaussian, ddg_mean, ddg_gaussian;
};

Errors errors(const char* name, const Surface& s) {
  const VertexCurvatures f = fit(s), d = ddg(s);
  const Errors e{error(s, f.mean, s.mean), error(s, f.gaussian, s.gaussian), error(s, d.mean, s.mean),
                 error(s, d.gaussian, s.gaussian)};
  std::printf("%-10s %7d vertices  fit H %.2e K %.2e   ddg H %.2e K %.2e\n", name,
              static_cast<int>(s.x.rows()), e.fit_mean, e.fit_gaussian, e.ddg_mean, e.ddg_gaussian);
  return e;
}

MetricResult evaluate(const Level& level, const Positions& x, const Positions& other, int rings = 5) {
  return CurvatureConsistency(CurvatureConsistency::Parameters{rings})
      .evaluate({level, empty_model(), x, &other});
}

}  // namespace

TEST_CASE("curvatures converge to closed forms", "[curvature]") {
  const std::vector<std::pair<const char*, std::function<Surface(int)>>> families = {
      {"cylinder", cylinder}, {"saddle", saddle}, {"torus", torus}};
  for (const auto& [name, make] : families) {
    CAPTURE(name);
    Errors last{};
    for (const int n : {32, 64, 128}) {
      const Errors e = errors(name, make(n));
      // Smooth images of a lattice: second order, so four times smaller. Zero K (cylinder) is exact anyway.
      if (n > 32) {
        CHECK(e.fit_mean < 0.3 * last.fit_mean);
        CHECK(e.fit_gaussian < 0.3 * last.fit_gaussian + 1e-9);
        CHECK(e.ddg_mean < 0.3 * last.ddg_mean);
        CHECK(e.ddg_gaussian < 0.3 * last.ddg_gaussian + 1e-9);
      }
      last = e;
    }
    CHECK(last.fit_mean < 0.02);
    CHECK(last.fit_gaussian < 0.02);
    CHECK(last.ddg_mean < 0.002);
    CHECK(last.ddg_gaussian < 0.002);
  }
}

TEST_CASE("orientation decides the sign of the mean curvature", "[curvature]") {
  Surface s = torus(24);
  const VertexCurvatures f = fit(s), d = ddg(s);
  s.triangles.col(1).swap(s.triangles.col(2));
  const VertexCurvatures turned_f = fit(s), turned_d = ddg(s);
  CHECK(f.mean.mean() > 0.5);
  CHECK(d.mean.mean() > 0.5);
  CHECK((f.mean + turned_f.mean).cwiseAbs().maxCoeff() < 1e-8);
  CHECK((d.mean + turned_d.mean).cwiseAbs().maxCoeff() < 1e-8);
  CHECK((f.gaussian - turned_f.gaussian).cwiseAbs().maxCoeff() < 1e-8);
  CHECK((d.gaussian - turned_d.gaussian).cwiseAbs().maxCoeff() < 1e-8);
  CHECK((f.strongest + turned_f.strongest).cwiseAbs().maxCoeff() < 1e-8);
}

TEST_CASE("the strongest principal curvature keeps its sign, and belongs to H and K", "[curvature]") {
  const VertexCurvatures f = fit(saddle(24));
  const VectorXd other = 2 * f.mean - f.strongest;
  CHECK((f.strongest.cwiseProduct(other) - f.gaussian).cwiseAbs().maxCoeff() < 1e-10);
  CHECK((f.strongest.cwiseAbs() - other.cwiseAbs()).minCoeff() > -1e-10);
  // At the middle κ = (4/3, −2) from z = x² − 2y²/3 under an upward normal.
  const int middle = 12 * 25 + 12;
  CHECK(f.strongest[middle] == Approx(-2).epsilon(0.03));
  CHECK(other[middle] == Approx(4.0 / 3).epsilon(0.03));
}

TEST_CASE("a quadric is fitted exactly and bends as its graph does", "[curvature]") {
  const double cases[][5] = {
      {1, 1, 0.5, 0, 0}, {1, 1, 0.5, 1, -0.5}, {-2, 0.3, 1, -0.7, 0.2}, {0, 0, 0, 2, 3}};
  for (const auto& [a, b, c, d, e] : cases) {
    std::vector<Vector3d> offsets;
    for (const double u : {-1.0, -0.3, 0.4, 0.9})
      for (const double v : {-0.8, 0.1, 0.7})
        offsets.emplace_back(u, v, a * u * u + b * u * v + c * v * v + d * u + e * v);
    const Vector5d q = fit_quadric(offsets);
    CHECK((q - Vector5d(a, b, c, d, e)).norm() < 1e-12);
    const double w = 1 + d * d + e * e;
    const double mean = -((1 + e * e) * 2 * a - 2 * d * e * b + (1 + d * d) * 2 * c) / (2 * std::pow(w, 1.5));
    const double gaussian = (4 * a * c - b * b) / (w * w);
    const PointCurvatures k = quadric_curvatures(q);
    CHECK(k.mean == Approx(mean).margin(1e-12));
    CHECK(k.gaussian == Approx(gaussian).margin(1e-12));
    CHECK(k.kappa1 + k.kappa2 == Approx(2 * mean).margin(1e-12));
    CHECK(k.kappa1 * k.kappa2 == Approx(gaussian).margin(1e-12));
    CHECK(k.kappa1 >= k.kappa2);
  }
}

TEST_CASE("a plane has no curvature inside, and only its border's own turning at the border", "[curvature]") {
  const int n = 12;
  const Surface s = plane(n);
  const VertexCurvatures f = fit(s), d = ddg(s);
  CHECK(f.mean.cwiseAbs().maxCoeff() < 1e-9);
  CHECK(f.gaussian.cwiseAbs().maxCoeff() < 1e-9);
  CHECK(d.mean.cwiseAbs().maxCoeff() < 1e-9);
  // The corner keeps π minus its angle over its area; straight borders and inner vertices have none.
  const Vector3d a = s.x.row(n + 1) - s.x.row(0), b = s.x.row(1) - s.x.row(0);
  const double angle = std::atan2(a.cross(b).norm(), a.dot(b)), area = a.cross(b).norm() / 3;
  CHECK(d.gaussian[0] == Approx((pi - angle) / area));
  VectorXd rest = d.gaussian;
  for (const int corner : {0, n, n * (n + 1), (n + 1) * (n + 1) - 1}) rest[corner] = 0;
  CHECK(rest.cwiseAbs().maxCoeff() < 1e-8);
}

TEST_CASE("angle defects add up to the Euler characteristic", "[curvature]") {
  const auto total = [](const Surface& s) {
    const Level level = Level::of(0, {s.x, s.triangles});  // rest = deformed: its areas are the A_i
    return level.vertex_area.dot(ddg(s).gaussian);
  };
  const TriangleMesh sphere = sphere_mesh(1, 2);
  CHECK(total({sphere.vertices, sphere.triangles, {}, {}, {}}) == Approx(4 * pi));
  CHECK(total(torus(12)) == Approx(0).margin(1e-9));
  CHECK(total(saddle(9)) == Approx(2 * pi));
}

TEST_CASE("the other side of a fold is left out of the fit", "[curvature]") {
  // Two flat legs at 20° to each other, creased along one row. Less than five rings from the crease, the
  // other leg's normals oppose; the crease itself lies in the leg's plane.
  const int n = 24;
  const double slope = 10 * pi / 180;
  const Surface crease = grid(n, n, false, false, [&](double u, double v) {
    const double s = u - 0.5;
    return Exact{{-std::abs(s) * std::cos(slope), v, s * std::sin(slope)}, 0, 0};
  });
  const VertexCurvatures f = fit(crease);
  REQUIRE(f.mean.allFinite());
  for (int row = 0; row <= n; ++row) {
    CAPTURE(row);
    const auto means = f.mean.segment(row * (n + 1), n + 1).cwiseAbs();
    if (row == n / 2)
      CHECK(means.segment(1, n - 1).minCoeff() > 1);
    else
      CHECK(means.maxCoeff() < 1e-8);
  }
}

TEST_CASE("fewer rings smooth less", "[curvature]") {
  // The fit's error is of the square of its reach: 4/25 of it with two rings for five.
  const Surface s = torus(64);
  const double five = error(s, fit(s, 5).mean, s.mean), two = error(s, fit(s, 2).mean, s.mean);
  CHECK(two / five == Approx(4.0 / 25).epsilon(0.3));
}

TEST_CASE("degenerate input is refused by name", "[curvature]") {
  Surface s = plane(4);
  s.x.setConstant(1);
  CHECK_THROWS_WITH(fit(s), Catch::Contains("vertex 0"));
  CHECK_THROWS_WITH(ddg(s), Catch::Contains("vertex 0"));
  s = plane(4);
  s.x(7, 1) = std::nan("");
  CHECK_THROWS_WITH(fit(s), Catch::Contains("vertex"));
  CHECK_THROWS_WITH(ddg(s), Catch::Contains("vertex"));
}

TEST_CASE("a mesh of fewer neighbours than unknowns still gives finite curvatures", "[curvature]") {
  const VertexCurvatures f = fit(cap(1, 2.0));  // four vertices
  CHECK(f.mean.allFinite());
  CHECK(f.gaussian.allFinite());
}

TEST_CASE("a vertex whose neighbours' normals all oppose its own is fitted to all of them", "[curvature]") {
  Surface s = plane(6);
  s.x.row(0) << 0.2, 0.2, 0.3 * 0.2 - 0.2 * 0.2;  // the corner, turned over inside the plane
  const VertexCurvatures f = fit(s);
  CHECK(f.mean.cwiseAbs().maxCoeff() < 1e-9);
  CHECK(f.gaussian.cwiseAbs().maxCoeff() < 1e-9);
  CHECK(f.strongest.allFinite());
}

TEST_CASE("consistency of two spherical caps is the closed form", "[curvature_consistency]") {
  // Σ m (1/R₁ − 1/R₂)² over a rest square of area 1.
  const double exact_mean = std::pow(1 / 1.5 - 1 / 1.0, 2), exact_gaussian = std::pow(1 / 2.25 - 1, 2);
  double last_mean = 1, last_gaussian = 1, last_ddg = 1;
  for (const int n : {32, 64, 128}) {
    Surface flat = plane(n);
    flat.x.col(2).setZero();
    const Level level = Level::of(1, {flat.x, flat.triangles});
    const MetricResult result = evaluate(level, cap(n, 1.0).x, cap(n, 1.5).x);
    const double mean = std::abs(value(result, "d_H_fit") / exact_mean - 1);
    const double gaussian = std::abs(value(result, "d_K_fit") / exact_gaussian - 1);
    const double ddg_mean = std::abs(value(result, "d_H_ddg") / exact_mean - 1);
    std::printf("caps       %7d vertices  d_H_fit off by %.2e  d_K_fit %.2e  d_H_ddg %.2e  (d_K_ddg %.2e)\n",
                level.vertex_count(), mean, gaussian, ddg_mean, value(result, "d_K_ddg") / exact_gaussian);
    CHECK(mean < 0.6 * last_mean);
    CHECK(gaussian < 0.6 * last_gaussian);
    CHECK(ddg_mean < 0.6 * last_ddg);
    last_mean = mean;
    last_gaussian = gaussian;
    last_ddg = ddg_mean;
  }
  CHECK(last_mean < 0.01);
  CHECK(last_gaussian < 0.02);
  CHECK(last_ddg < 0.03);
}

TEST_CASE("fields and weights belong to the right state", "[curvature_consistency]") {
  const Surface s = torus(24);
  Surface flat = s;
  flat.x *= 2;  // rest areas four times the deformed ones
  const Level level = Level::of(0, {flat.x, flat.triangles});
  const Positions other = 0.5 * s.x;
  const MetricResult result = evaluate(level, s.x, other, 2);
  const VertexCurvatures f = fit(s, 2);
  CHECK((result.fields[0].values - f.mean).cwiseAbs().maxCoeff() < 1e-9);  // 2 H − H
  CHECK((result.fields[1].values - f.strongest).cwiseAbs().maxCoeff() == 0);
  CHECK((result.fields[2].values - 2 * f.strongest).cwiseAbs().maxCoeff() < 1e-9);
  CHECK(value(result, "d_H_fit") == Approx(level.vertex_area.dot(f.mean.cwiseAbs2())));
}

TEST_CASE("curvatures of states seen lately are kept, and belong to their own state and mesh",
          "[curvature_consistency]") {
  const Surface s = torus(12);
  Triangles turned_over = s.triangles;
  turned_over.col(1).swap(turned_over.col(2));
  const Level level = Level::of(0, {s.x, s.triangles}), other = Level::of(0, {s.x, turned_over});
  const RecentCurvatures recent(2);
  const auto first = recent.of(s.x, level), reversed = recent.of(s.x, other),
             large = recent.of(2 * s.x, level);
  CHECK(recent.of(s.x, level) == first);
  CHECK(recent.of(s.x, other) == reversed);
  CHECK((first->fit.mean + reversed->fit.mean).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((first->fit.mean - 2 * large->fit.mean).cwiseAbs().maxCoeff() < 1e-9);
  // As a run uses them: two targets, and one state after the other.
  for (int k = 3; k < 8; ++k) {
    const auto state = recent.of(k * s.x, level);
    for (const auto& target : {first, reversed}) {
      CHECK(recent.of(s.x, target == first ? level : other) == target);
      CHECK(recent.of(k * s.x, level) == state);
    }
  }
  CHECK(recent.of(2 * s.x, level) != large);
}

TEST_CASE("rings end with the mesh, however many are asked for", "[curvature_consistency]") {
  const Surface s = torus(12);
  const VertexCurvatures all = fit(s, 100), more = fit(s, std::numeric_limits<int>::max());
  CHECK((all.mean - more.mean).cwiseAbs().maxCoeff() == 0);
  CHECK((all.mean - fit(s, 2).mean).cwiseAbs().maxCoeff() > 0);
}

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <limits>

#include "core/numerics/model/stretch_limit.h"
#include "core/numerics/patterns/generate.h"
#include "plugins/energy/strain_limit/strain_limit_law.h"
#include "plugins/energy/strain_limit/stretch_path.h"
#include "tests/support/decompositions.h"
#include "tests/support/kernel_check.h"
#include "tests/support/unregistered.h"
// After it:
#include "plugins/energy/strain_limit/strain_limit.cpp"

using namespace drape;

namespace {

using Kernel = StretchKernel<StrainLimitLaw>;
using Check = KernelCheck<Kernel>;
constexpr double limit = 1.0608, weight = 0.7;
const Eigen::Vector3d rest1(0.9, 0.2, 0.1), rest2(0.1, 1.1, -0.3);

const RestTriangle triangle = RestTriangle::of(rest1, rest2);
const Kernel::Rest rest = [] {
  Kernel::Rest r;
  r << triangle.a, triangle.b, triangle.c, weight, 1 / (limit - 1);
  return r;
}();

/// The edges that give the principal stretches, v₁ at `angle`, turned in space by `seed`.
Check::State state(double s1, double s2, double angle, unsigned seed = 1) {
  const Eigen::Matrix3d turn =
      Eigen::Quaterniond(Eigen::Vector4d(normal_numbers(4, seed))).normalized().toRotationMatrix();
  const Eigen::Matrix2d v = Eigen::Rotation2Dd(angle).toRotationMatrix();
  const Eigen::Matrix<double, 3, 2> f =
      turn.leftCols<2>() * (v * Eigen::Vector2d(s1, s2).asDiagonal() * v.transpose());
  Check::State x;
  x << f.col(0) / rest[0], (f.col(1) - f.col(0) / rest[0] * rest[1]) / rest[2];
  return x;
}

/// φ / weight in long double.
double law(double stretch) {
  const long double y = (stretch - 1.0L) / (limit - 1.0L);
  return stretch <= 1 ? 0 : double(-y * y * std::log1p(-y));
}

/// A square, whose energy has this limit.
struct Sheet {
  Level level = Level::of(0, grid({1, 1}, 5, 4, Diagonals::criss_cross));
  const Positions& rest = level.rest.vertices;
  std::unique_ptr<BoundEnergy> energy = [this] {
    StrainLimit of;
    of.limit = ::limit;
    return of.bind(level, Material());
  }();

  /// The largest stretch of a triangle, by Eigen's SVD.
  double stretch_of(const Positions& x, int t) const {
    const auto v = level.rest.triangles.row(t);
    const auto edges = [&](const Positions& p) {
      Eigen::Matrix<double, 3, 2> e;
      e << (p.row(v[1]) - p.row(v[0])).transpose(), (p.row(v[2]) - p.row(v[0])).transpose();
      return e;
    };
    const Eigen::Matrix<double, 3, 2> e = edges(rest);
    const Eigen::Matrix3d f = edges(x) * (e.transpose() * e).inverse() * e.transpose();
    return singular_values_of(f)[0];
  }
  double largest_stretch(const Positions& x) const {
    double largest = 0;
    for (int t = 0; t < level.triangle_count(); ++t) largest = std::max(largest, stretch_of(x, t));
    return largest;
  }
};

const StretchLimited& limited(const BoundEnergy& energy) { return *energy.stretch_limit(); }

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

TEST_CASE("strain_limit: derivatives a millionth below the limit") {
  for (const double s2 : {0.8, 1.05, limit - 1e-6, limit - 2e-6})
    Check::derivatives(state(limit - 1e-6, s2, 0.6), rest, 1e-8, 1e-5);
}

TEST_CASE("strain_limit: the second derivatives pass through 1 without a jump") {
  const auto hessian = [](double s) { return Check::evaluate(state(s, 0.9, 0.4), rest).hessian; };
  CHECK(hessian(1 - 1e-9).norm() == 0);
  const double slope = 6 * weight / std::pow(limit - 1, 3);  // φ''' at 1 from above
  const double edges = std::pow(std::max(rest1.norm(), rest2.norm()), -2);
  for (const double step : {1e-3, 1e-5, 1e-7}) {
    const double norm = hessian(1 + step).norm();
    CHECK(norm > 0);
    CHECK(norm < 10 * slope * step / edges);
  }
  // And of the divided difference, with one stretch on either side.
  const auto below = Check::evaluate(state(1.03, 1 - 1e-10, 0.4), rest).hessian,
             above = Check::evaluate(state(1.03, 1 + 1e-10, 0.4), rest).hessian;
  CHECK((below - above).norm() <= 1e-7 * above.norm());
}

TEST_CASE("strain_limit: a triangle's energy is convex, so that nothing needs to be projected") {
  // One and both stretches above 1, equal and nearly equal, wide apart, nearly collapsed.
  for (const auto& x : {state(1.03, 0.7, 0.3), state(1.05, 1.02, 2.0, 2), state(1.04, 1.04, 0.5, 3),
                        state(1.03, 1.03 - 1e-9, 1.1, 4), state(1.03, 1.03 - 1e-5, 1, 4),
                        state(1.055, 0.1, -0.8, 5), state(1.02, 1e-4, 0.2, 6)}) {
    CHECK(Check::projections<double>(x, rest) >= -1e-14);
    Check::projections<Pack<native_pack_width>>(x, rest);
  }
}

TEST_CASE("strain_limit: values in closed form, and +infinity at the limit") {
  for (const double s1 : {1.0 + 1e-7, 1.001, 1.03, 1.06, limit - 1e-6})
    for (const double s2 : {0.5, 1.0, 1.0005}) {
      const double expected = weight * (law(s1) + law(s2));
      const auto r = Check::evaluate(state(s1, s2, 0.3), rest);
      // What rounding of the stretch by 1e-15 does to the energy.
      CHECK(std::abs(r.value - expected) <= 1e-12 * expected + 1e-14 * r.gradient.norm());
    }
  CHECK(law(1.03) > 0.1);
  for (const double s1 : {1.0 - 1e-12, 0.9, 0.0}) {
    const auto r = Check::evaluate(state(s1, 0.5 * s1, 1), rest);
    CHECK(r.value == 0);
    CHECK(r.gradient.norm() == 0);
    CHECK(r.hessian.norm() == 0);
  }
  const Sheet sheet;
  const auto stretched = [&](double s) -> Positions {
    return sheet.rest * Eigen::Vector3d(s, 1, 1).asDiagonal();
  };
  CHECK(sheet.energy->value(stretched(1.03)) ==
        Approx(1e3 * Material().thickness * law(1.03)).epsilon(1e-10));
  CHECK(sheet.energy->value(0.7 * sheet.rest) == 0);
  for (const double s : {limit + 1e-12, 1.2, 50.0}) {
    Positions g = Positions::Zero(sheet.rest.rows(), 3);
    CHECK(sheet.energy->value(stretched(s)) == infinity);
    CHECK(sheet.energy->add_gradient(stretched(s), g) == infinity);
  }
}

TEST_CASE("strain_limit: a filtered step leaves a tenth of the margin and never violates the limit") {
  const Sheet sheet;
  const Positions x0 = shaken(sheet.rest, 0.002, 1);
  REQUIRE(sheet.largest_stretch(x0) > 1.005);
  REQUIRE(sheet.largest_stretch(x0) < limit);
  for (unsigned seed = 2; seed <= 60; ++seed) {
    const Positions x1 = shaken(x0, std::pow(10.0, static_cast<int>(seed % 6) - 2), seed);
    if (sheet.largest_stretch(x1) < 1.01) continue;
    const StepLimit step = sheet.energy->max_step(x0, x1);
    REQUIRE(step.fraction > 0);
    REQUIRE(step.fraction < 1);
    // All triangles stay within their bounds; the limiting one would violate its bound a hundred-thousandth
    // further.
    double slack = -1;
    int tight = -1;
    const Positions end = x0 + step.fraction * (x1 - x0), beyond = x0 + 1.00001 * step.fraction * (x1 - x0);
    for (int t = 0; t < sheet.level.triangle_count(); ++t) {
      const double bound = limit - 0.1 * (limit - std::max(sheet.stretch_of(x0, t), 1.0)),
                   excess = sheet.stretch_of(beyond, t) - bound;
      CHECK(sheet.stretch_of(end, t) <= bound + 1e-12);
      if (excess > slack) slack = excess, tight = t;
    }
    CHECK(slack > 0);
    CHECK_THAT(step.by, Catch::StartsWith("triangle " + std::to_string(tight) + ", stretched to 1.0") &&
                            Catch::EndsWith("(limit 1.0608)"));
    CHECK(std::isfinite(sheet.energy->value(end)));
  }
}

TEST_CASE("strain_limit: single triangles are followed to the limit through collapse and far steps") {
  const Eigen::Vector3d right(1, 0, 0), up(0, 1, 0);
  for (const StretchPath& path :
       {StretchPath{right, up, -3 * right, -0.5 * up},    // through a point of no width
        StretchPath{right, up, -2 * right, -2 * up},      // inverted, full step
        StretchPath{right, up, 1e9 * right, 1e9 * up},    // very far
        StretchPath{right, up, 1e-9 * right, 1e-1 * up},  // just beyond
        StretchPath{right, right, 2 * up, -right}}) {
    const double t = path.reach(1.5);
    CHECK(path.at(t).largest <= 1.5);
    for (int i = 1; i < 1000; ++i) CHECK(path.at(t * i / 1000).largest <= 1.5);
    if (t < 1) CHECK(path.at(t * (1 + 1e-5)).largest > 1.5);
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(StretchPath{right, up, nan * right, up}.reach(1.5) == 0);
}

TEST_CASE("strain_limit: rigid motions and shrinking take full steps") {
  const Sheet sheet;
  const Positions x0 = shaken(sheet.rest, 0.004, 1);
  REQUIRE(sheet.largest_stretch(x0) < limit);
  for (const double angle : {0.1, 1.5, 3.1}) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    const Positions x1 = (x0 * turn.transpose()).rowwise() + Eigen::RowVector3d(5, -3, 1);
    CHECK(sheet.energy->max_step(x0, x1).fraction == 1);
    CHECK(sheet.energy->max_step(x0, x1).by.empty());
  }
  CHECK(sheet.energy->max_step(x0, 0.2 * x0).fraction == 1);
}

TEST_CASE("strain_limit: violations are listed, can be excluded, and the rest still limits") {
  const Sheet sheet;
  const int triangles = sheet.level.triangle_count();
  Positions x = sheet.rest;
  x(0, 0) -= 0.1;  // a corner
  const auto beyond = limited(*sheet.energy).violations(x);
  REQUIRE(!beyond.empty());
  REQUIRE(static_cast<int>(beyond.size()) < triangles);
  CHECK(limited(*sheet.energy).limit() == limit);
  CHECK(beyond[0].stretch == Approx(sheet.stretch_of(x, beyond[0].triangle)).epsilon(1e-12));
  const StepLimit step = sheet.energy->max_step(x, sheet.rest);
  CHECK(step.fraction == 0);
  CHECK_THAT(step.by, Catch::StartsWith("triangle " + std::to_string(beyond[0].triangle) + ","));

  std::vector<char> skipped(triangles, 0);
  for (const auto& violation : beyond) skipped[violation.triangle] = 1;
  const auto left = limited(*sheet.energy).restricted(skipped);
  CHECK(limited(*left).violations(x).empty());
  CHECK(std::isfinite(left->value(x)));
  CHECK(left->stencils().rows() == triangles - static_cast<int>(beyond.size()));
  CHECK(left->max_step(x, sheet.rest).fraction == 1);
  CHECK(left->max_step(x, 1.5 * x).fraction < 1);
  const auto none = limited(*left).restricted(std::vector<char>(triangles, 1));
  CHECK(none->value(1e3 * x) == 0);
  CHECK(none->max_step(x, 1e3 * x).fraction == 1);
}

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

const Kernel::Rest rest = [] {
  const RestTriangle triangle = RestTriangle::of(rest1, rest2);
  Kernel::Rest r;
  r << triangle.a, triangle.b, triangle.c, weight, 1 / (limit - 1);
  return r;
}();

/// The edges that give the principal stretches, v₁ at `angle`, turned in space by `seed`.
Check::State state(double s1, double s2, double angle, unsigned seed = 1) {
  const Eigen::Matrix3d turn =
      Eigen::Quaterniond(Eigen::Vector4d(normal_numbers(4, seed))).normalized().toRotationMatrix();
  const Eigen::Rotation2Dd v(angle);
  const Eigen::Matrix2d plane =
      v.toRotationMatrix() * Eigen::Vector2d(s1, s2).asDiagonal() * v.toRotationMatrix().transpose();
  const Eigen::Matrix<double, 3, 2> f = turn.leftCols<2>() * plane;
  Check::State x;
  x << f.col(0) / rest[0], (f.col(1) - f.col(0) / rest[0] * rest[1]) / rest[2];
  return x;
}

/// φ / weight in long double.
double law(double stretch) {
  const long double y = (stretch - 1.0L) / (limit - 1.0L);
  return stretch <= 1 ? 0 : double(-y * y * std::log1p(-y));
}

/// One and both stretches above 1, equal and nearly equal, wide apart, nearly collapsed.
std::vector<Check::State> states() {
  return {state(1.03, 0.7, 0.3),          state(1.05, 1.02, 2.0, 2),
          state(1.04, 1.04, 0.5, 3),      state(1.03, 1.03 - 1e-9, 1.1, 4),
          state(1.03, 1.03 - 1e-5, 1, 4), state(1.055, 0.1, -0.8, 5),
          state(1.02, 1e-4, 0.2, 6)};
}

Level square() { return Level::of(0, grid({1, 1}, 5, 4, Diagonals::criss_cross)); }

std::unique_ptr<BoundEnergy> bound_to(const Level& level) {
  StrainLimit energy;
  energy.limit = limit;
  return energy.bind(level, Material());
}

const StretchLimited& limited(const BoundEnergy& energy) { return *energy.stretch_limit(); }

/// The largest stretch of a triangle of the level, by Eigen's SVD.
double stretch_of(const Level& level, const Positions& x, int t) {
  const auto v = level.rest.triangles.row(t);
  const auto edges = [&](const Positions& p) {
    Eigen::Matrix<double, 3, 2> e;
    e << (p.row(v[1]) - p.row(v[0])).transpose(), (p.row(v[2]) - p.row(v[0])).transpose();
    return e;
  };
  const Eigen::Matrix<double, 3, 2> e = edges(level.rest.vertices);
  const Eigen::Matrix3d f = edges(x) * (e.transpose() * e).inverse() * e.transpose();
  return singular_values_of(f)[0];
}

double largest_stretch(const Level& level, const Positions& x) {
  double largest = 0;
  for (int t = 0; t < level.triangle_count(); ++t) largest = std::max(largest, stretch_of(level, x, t));
  return largest;
}

}  // namespace

TEST_CASE("principal stretches and their frame, by Eigen's SVD") {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    Eigen::Matrix<double, 3, 2> f =
        Eigen::Map<const Eigen::Matrix<double, 3, 2>>(normal_numbers(6, seed).data());
    if (seed % 4 == 0) f.col(1) = 0.3 * f.col(0) + 1e-7 * f.col(1);
    if (seed % 4 == 1) f.col(1).setZero();
    const PrincipalStretch<double> s(f.col(0), f.col(1));
    const Eigen::Vector2d expected = singular_values_of(f);
    CHECK(s.largest == Approx(expected[0]).epsilon(1e-14).margin(0));
    CHECK(std::abs(s.smallest - expected[1]) <= 1e-14 * expected[0]);
    CHECK(s.cosine * s.cosine + s.sine * s.sine == Approx(1).epsilon(1e-14));
    CHECK(s.w1.norm() == Approx(expected[0]).epsilon(1e-14));
    CHECK(std::abs(s.w2.norm() - expected[1]) <= 1e-14 * expected[0]);
    CHECK(std::abs(s.w1.dot(s.w2)) <= 2e-15 * expected[0] * expected[0]);
  }
}

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
  for (const auto& x : states()) {
    const double smallest = Check::projections<double>(x, rest);
    CHECK(smallest >= -1e-14);
    Check::projections<Pack<native_pack_width>>(x, rest);
  }
}

TEST_CASE("strain_limit: values in closed form") {
  for (const double s1 : {1.0 + 1e-7, 1.001, 1.03, 1.06, limit - 1e-6})
    for (const double s2 : {0.5, 1.0, 1.0005}) {
      const double expected = weight * (law(std::max(s1, s2)) + law(std::min(s1, s2)));
      // What rounding of the stretch by 1e-15 does to the energy.
      const double slope = Check::evaluate(state(s1, s2, 0.3), rest).gradient.norm();
      CHECK(std::abs(Check::evaluate(state(s1, s2, 0.3), rest).value - expected) <=
            1e-12 * expected + 1e-14 * slope);
    }
  CHECK(law(1.03) > 0.1);
  for (const double s1 : {1.0 - 1e-12, 0.9, 0.0}) {
    const auto r = Check::evaluate(state(s1, 0.5 * s1, 1), rest);
    CHECK(r.value == 0);
    CHECK(r.gradient.norm() == 0);
    CHECK(r.hessian.norm() == 0);
  }
}

TEST_CASE("strain_limit: a stretched sheet has the energy of its volume, and +infinity at the limit") {
  const Level level = square();
  const auto energy = bound_to(level);
  const Material material;
  const auto stretched = [&](double s) {
    Positions x = level.rest.vertices;
    x.col(0) *= s;
    return x;
  };
  CHECK(energy->value(stretched(1.03)) == Approx(1e3 * material.thickness * law(1.03)).epsilon(1e-10));
  CHECK(energy->value(0.7 * level.rest.vertices) == 0);
  for (const double s : {limit + 1e-12, 1.2, 50.0}) {
    const Positions x = stretched(s);
    Positions g = Positions::Zero(x.rows(), 3);
    CHECK(energy->value(x) == std::numeric_limits<double>::infinity());
    CHECK(energy->add_gradient(x, g) == std::numeric_limits<double>::infinity());
  }
}

TEST_CASE("strain_limit: a filtered step leaves a tenth of the margin and never violates the limit") {
  const Level level = square();
  const auto energy = bound_to(level);
  const Positions x0 = shaken(level.rest.vertices, 0.002, 1);
  REQUIRE(largest_stretch(level, x0) > 1.005);
  REQUIRE(largest_stretch(level, x0) < limit);
  for (unsigned seed = 2; seed <= 60; ++seed) {
    const Positions x1 = shaken(x0, std::pow(10.0, static_cast<int>(seed % 6) - 2), seed);
    if (largest_stretch(level, x1) < 1.01) continue;
    const StepLimit step = energy->max_step(x0, x1);
    REQUIRE(step.fraction > 0);
    REQUIRE(step.fraction < 1);
    // All triangles stay within their bounds; the limiting one would violate its bound a hundred-thousandth
    // further.
    double slack = -1;
    int tight = -1;
    const Positions end = x0 + step.fraction * (x1 - x0), beyond = x0 + 1.00001 * step.fraction * (x1 - x0);
    for (int t = 0; t < level.triangle_count(); ++t) {
      const double bound = limit - 0.1 * (limit - std::max(stretch_of(level, x0, t), 1.0));
      CHECK(stretch_of(level, end, t) <= bound + 1e-12);
      if (stretch_of(level, beyond, t) - bound > slack)
        slack = stretch_of(level, beyond, t) - bound, tight = t;
    }
    CHECK(slack > 0);
    CHECK_THAT(step.by, Catch::StartsWith("triangle " + std::to_string(tight) + ", stretched to 1.0"));
    CHECK_THAT(step.by, Catch::EndsWith("(limit 1.0608)"));
    CHECK(std::isfinite(energy->value(end)));
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
    if (t < 1) CHECK(path.at(t * (1 + 1e-5)).largest > 1.5);
    for (int i = 1; i < 1000; ++i) CHECK(path.at(t * i / 1000).largest <= 1.5);
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK(StretchPath{right, up, nan * right, up}.reach(1.5) == 0);
}

TEST_CASE("strain_limit: rigid motions and shrinking take full steps") {
  const Level level = square();
  const auto energy = bound_to(level);
  const Positions x0 = shaken(level.rest.vertices, 0.004, 1);
  REQUIRE(largest_stretch(level, x0) < limit);
  for (const double angle : {0.1, 1.5, 3.1}) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
    const Positions x1 = (x0 * turn.transpose()).rowwise() + Eigen::RowVector3d(5, -3, 1);
    const StepLimit step = energy->max_step(x0, x1);
    CHECK(step.fraction == 1);
    CHECK(step.by.empty());
  }
  CHECK(energy->max_step(x0, 0.2 * x0).fraction == 1);
}

TEST_CASE("strain_limit: violations are listed, can be excluded, and the rest still limits") {
  const Level level = square();
  const auto all = bound_to(level);
  Positions x = level.rest.vertices;
  x(0, 0) -= 0.1;  // a corner
  const auto beyond = limited(*all).violations(x);
  REQUIRE(!beyond.empty());
  REQUIRE(static_cast<int>(beyond.size()) < level.triangle_count());
  CHECK(limited(*all).limit() == limit);
  CHECK(beyond[0].stretch == Approx(stretch_of(level, x, beyond[0].triangle)).epsilon(1e-12));
  CHECK(all->max_step(x, level.rest.vertices).fraction == 0);
  CHECK_THAT(all->max_step(x, level.rest.vertices).by,
             Catch::StartsWith("triangle " + std::to_string(beyond[0].triangle) + ","));
  CHECK(all->value(x) == std::numeric_limits<double>::infinity());

  std::vector<char> skipped(level.triangle_count(), 0);
  for (const auto& triangle : beyond) skipped[triangle.triangle] = 1;
  const auto left = limited(*all).restricted(skipped);
  CHECK(limited(*left).violations(x).empty());
  CHECK(std::isfinite(left->value(x)));
  CHECK(left->stencils().rows() == level.triangle_count() - static_cast<int>(beyond.size()));
  CHECK(left->max_step(x, level.rest.vertices).fraction == 1);
  CHECK(left->max_step(x, 1.5 * x).fraction < 1);
  const auto none = limited(*left).restricted(std::vector<char>(level.triangle_count(), 1));
  CHECK(none->value(1e3 * x) == 0);
  CHECK(none->max_step(x, 1e3 * x).fraction == 1);
}

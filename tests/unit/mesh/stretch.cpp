#include "core/numerics/elements/stretch.h"

#include <Eigen/SVD>
#include <catch2/catch.hpp>
#include <random>

using namespace drape;
using Eigen::Vector3d;

TEST_CASE("stretch: of a triangle, the singular values of its deformation gradient") {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  const auto edge = [&] { return Vector3d(normal(random), normal(random), normal(random)); };
  for (int trial = 0; trial < 200; ++trial) {
    const Vector3d rest1 = edge(), rest2 = edge(), e1 = edge(), e2 = edge();
    // F = [e1, e2] [rest1, rest2]⁺ has the two stretches and a zero.
    Eigen::Matrix<double, 3, 2> rest, deformed;
    rest << rest1, rest2;
    deformed << e1, e2;
    const Eigen::Matrix3d F = deformed * (rest.transpose() * rest).inverse() * rest.transpose();
    const Vector3d expected = F.jacobiSvd().singularValues();
    const auto s = RestTriangle::of(rest1, rest2).stretch(e1, e2);
    CHECK(s.largest == Approx(expected[0]).epsilon(1e-8));
    CHECK(s.smallest == Approx(expected[1]).epsilon(1e-8));
  }
}

TEST_CASE("stretch: no digits are lost where stretches agree or vanish") {
  const Vector3d e1(1, 0, 0), e2(0.3, 0.8, 0);
  const RestTriangle triangle = RestTriangle::of(e1, e2);
  const auto rest = triangle.stretch(e1, e2);
  CHECK(std::abs(rest.largest - 1) < 1e-15);
  CHECK(std::abs(rest.smallest - 1) < 1e-15);
  const Vector3d nearly(1 + 1e-10, 1, 1);
  const auto near = triangle.stretch(e1.cwiseProduct(nearly), e2.cwiseProduct(nearly));
  CHECK(near.largest - 1 == Approx(1e-10).epsilon(1e-4));
  CHECK(std::abs(near.smallest - 1) < 1e-14);
  const Vector3d flat(2, 1e-9, 1);
  const auto thin = triangle.stretch(e1.cwiseProduct(flat), e2.cwiseProduct(flat));
  CHECK(thin.largest == Approx(2));
  CHECK(thin.smallest == Approx(1e-9).epsilon(1e-9));
  const auto collapsed = triangle.stretch(Vector3d::Zero(), Vector3d::Zero());
  CHECK(collapsed.largest == 0);
  CHECK(collapsed.smallest == 0);
}

#include <catch2/catch.hpp>
#include <random>

#include "core/numerics/contact/pair_contacts.h"
#include "core/numerics/contact_forces/barrier.h"
#include "tests/support/decompositions.h"
#include "tests/support/kernel_check.h"

using namespace drape;
using Eigen::Vector3d;

namespace {

constexpr double reach = 1e-2;
const BarrierParameters parameters{reach, 3, 1e-4};

/// A rim along y below the origin.
const Positions rim = (Positions(2, 3) << 0, -1, 0, 0, 1, 0).finished();

std::unique_ptr<Collisions> contacts(const Positions& x, double mollifier = 0) {
  ContactPair pair{{0, 1, 2, 3}, PairKind::edge_edge};
  pair.weight = 0.5;
  pair.dhat = reach;
  pair.mollifier = mollifier;
  pair.friction = 0.25;
  pair.obstacle = 0;
  pair.at_rim = true;
  return make_rim_contacts(x, rim, {pair}, parameters);
}

/// A cloth edge of 5 cm at a height over the rim, which it passes by `past`.
Positions level_edge(double past, double height) {
  return (Positions(2, 3) << past, 0, height, past - 0.05, 0, height).finished();
}

double b(double gap) { return gap < reach ? barrier(gap / reach).value : 0; }

}  // namespace

TEST_CASE("A cloth edge over a rim takes over the barrier that its vertex loses beyond it") {
  const double height = 0.4 * reach, unit = 3 * reach * 0.5;
  for (const double past : {-2 * reach, -0.5 * reach, -1e-6, 0.0}) {  // before the rim
    const Positions x = level_edge(past, height);
    CHECK(contacts(x)->value(x) == 0);
    CHECK(gradient_of(*contacts(x), x).norm() == 0);
  }
  double last = 0;
  for (const double past : {0.1 * reach, 0.5 * reach, 0.9 * reach}) {
    const Positions x = level_edge(past, height);
    const double value = contacts(x)->value(x);
    CHECK(value > last);
    CHECK(value + unit * b(std::hypot(past, height)) == Approx(unit * b(height)));
    last = value;
  }
  const Positions far = level_edge(2 * reach, height);
  CHECK(contacts(far)->value(far) == Approx(unit * b(height)));
  CHECK(contacts(far)->smallest_gap() == Approx(height));
  const double touching = 1e-10 * reach;
  const Positions low = level_edge(2 * reach, touching);
  CHECK(contacts(low)->value(low) == Approx(unit * b(touching)).epsilon(1e-6));
}

TEST_CASE("Rim contacts have the derivatives of their energy, and are never attractive") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(-1, 1);
  int near_both = 0, mollified = 0, indefinite = 0;
  for (int round = 0; round < 2000; ++round) {
    const bool is_parallel = round % 3 == 0;  // nearly, so that it is mollified
    const double length = round % 2 ? 5 * reach : 0.7 * reach, turn = is_parallel ? 0.02 : M_PI;
    const double angle = M_PI / 2 + turn * unit(random);
    Positions x(2, 3);
    x.row(0) << (is_parallel ? 0.05 : 0.5) * reach * unit(random), unit(random) * 0.1,
        reach * (0.5 + 0.4 * unit(random));
    x.row(1) = x.row(0) + length * Eigen::RowVector3d(std::cos(angle), std::sin(angle),
                                                      (is_parallel ? 2e-3 : 0.3) * unit(random));
    if (x(1, 2) < 0.1 * reach) continue;
    const double mollifier = 1e-3 * length * length * 4;
    const auto all = contacts(x, mollifier);
    if (all->contact_count() == 0) continue;
    const Positions g = gradient_of(*all, x);
    const Eigen::MatrixXd h = dense(hessian_of(*all, x, Projection::none));
    const auto value = [&](const Positions& y) { return contacts(y, mollifier)->value(y); };
    const auto gradient = [&](const Positions& y) { return gradient_of(*contacts(y, mollifier), y); };
    const double size = 1e-6 * reach;
    CAPTURE(round, x);
    CHECK(value(x) >= 0);
    CHECK((differences(value, x, size) - flat(g).transpose()).norm() <= 1e-5 * (g.norm() + 1e-3));
    bool steady = true;  // no end becomes the nearest point
    for (int c = 0; c < 6; ++c)
      for (const double sign : {-3.0, 3.0}) {
        Positions y = x;
        y(c / 3, c % 3) += sign * size;
        steady = steady && contacts(y, mollifier)->contact_count() == 1;
      }
    if (steady) CHECK((differences(gradient, x, size) - h).norm() <= 1e-3 * (h.norm() + 1));
    near_both +=
        x(0, 2) < reach && std::hypot(x(1, 0), x(1, 2)) < reach && std::hypot(x(0, 0), x(0, 2)) < reach;
    mollified += is_parallel;
    const Eigenpairs eigen = eigenpairs_of(h);
    indefinite += eigen.values[0] < -1e-9 * h.norm();
    const Eigen::MatrixXd clamped = dense(hessian_of(*all, x, Projection::clamp));
    CHECK((clamped - recomposed(eigen, Projection::clamp)).norm() <= 1e-10 * h.norm());
  }
  CHECK(near_both > 50);
  CHECK(mollified > 50);
  CHECK(indefinite > 50);
}

#include "core/numerics/contact/rim_contacts.h"

#include "tests/support/random.h"
#include "tests/unit/contact/pairs.h"

using namespace drape;

namespace {

constexpr double reach = 1e-2;

/// The contacts of a cloth's edge with a rim along y below the origin.
std::unique_ptr<Collisions> with_rim(const Positions& x, double mollifier = 0) {
  static const Positions rim = (Positions(2, 3) << 0, -1, 0, 0, 1, 0).finished();
  ContactPair pair{{0, 1, 2, 3}, PairKind::edge_edge};
  pair.weight = 0.5;
  pair.dhat = reach;
  pair.mollifier = mollifier;
  pair.friction = 0.25;
  pair.obstacle = 0;
  pair.at_rim = true;
  return make_collisions(BarrierParameters{reach, 3, 1e-4}, find_rim_contacts(x, rim, {pair}));
}

/// A cloth edge of 5 cm at a height over the rim, which it passes by `past`.
Positions level_edge(double past, double height) {
  return (Positions(2, 3) << past, 0, height, past - 0.05, 0, height).finished();
}

}  // namespace

TEST_CASE("A cloth edge over a rim takes over the barrier that its vertex loses beyond it") {
  const auto b = [](double gap) { return 3 * reach * 0.5 * barrier(gap / reach).value; };
  const double height = 0.4 * reach;
  for (const double past : {-2 * reach, -0.5 * reach, -1e-6, 0.0}) {  // before the rim
    const Positions x = level_edge(past, height);
    CHECK(with_rim(x)->value(x) == 0);
    CHECK(gradient_of(*with_rim(x), x).norm() == 0);
  }
  double last = 0;
  for (const double past : {0.1 * reach, 0.5 * reach, 0.9 * reach, 2 * reach}) {
    const Positions x = level_edge(past, height);
    const double value = with_rim(x)->value(x);
    CHECK(value > last);
    CHECK(value + b(std::hypot(past, height)) == Approx(b(height)));
    last = value;
  }
  const Positions far = level_edge(2 * reach, height), low = level_edge(2 * reach, 1e-10 * reach);
  CHECK(with_rim(far)->smallest_gap() == Approx(height));
  CHECK(with_rim(low)->value(low) == Approx(b(1e-10 * reach)).epsilon(1e-6));
}

TEST_CASE("Rim contacts have the derivatives of their energy, and are never attractive") {
  RandomNumbers random(2);
  int near_both = 0, mollified = 0, indefinite = 0;
  for (int round = 0; round < 2000; ++round) {
    const bool is_parallel = round % 3 == 0;  // nearly, so that it is mollified
    const double length = round % 2 ? 5 * reach : 0.7 * reach, turn = is_parallel ? 0.02 : M_PI;
    const double angle = M_PI / 2 + turn * random(-1, 1);
    Positions x(2, 3);
    x.row(0) << (is_parallel ? 0.05 : 0.5) * reach * random(-1, 1), 0.1 * random(-1, 1),
        reach * (0.5 + 0.4 * random(-1, 1));
    x.row(1) = x.row(0) + length * Eigen::RowVector3d(std::cos(angle), std::sin(angle),
                                                      (is_parallel ? 2e-3 : 0.3) * random(-1, 1));
    if (x(1, 2) < 0.1 * reach) continue;
    const auto at = [&](const Positions& y) { return with_rim(y, 1e-3 * length * length * 4); };
    const auto all = at(x);
    if (all->contact_count() == 0) continue;
    const Positions g = gradient_of(*all, x);
    const Eigen::MatrixXd h = dense(hessian_of(*all, x, Projection::none));
    const auto value = [&](const Positions& y) { return at(y)->value(y); };
    const auto gradient = [&](const Positions& y) { return gradient_of(*at(y), y); };
    const double size = 1e-6 * reach;
    CAPTURE(round, x);
    CHECK(value(x) >= 0);
    CHECK((differences(value, x, size) - flat(g).transpose()).norm() <= 1e-5 * (g.norm() + 1e-3));
    bool steady = true;  // no end becomes the nearest point
    for (const double sign : {-3.0, 3.0})
      for (int c = 0; c < 6; ++c) {
        Positions y = x;
        y.data()[c] += sign * size;
        steady = steady && at(y)->contact_count() == 1;
      }
    if (steady) CHECK((differences(gradient, x, size) - h).norm() <= 1e-3 * (h.norm() + 1));
    near_both +=
        x(0, 2) < reach && std::hypot(x(1, 0), x(1, 2)) < reach && std::hypot(x(0, 0), x(0, 2)) < reach;
    mollified += is_parallel;
    indefinite += check_whole_projections(*all, x) < -1e-9;
  }
  CHECK(near_both > 50);
  CHECK(mollified > 50);
  CHECK(indefinite > 50);
}

#include "core/numerics/contact/pair_contacts.h"

#include <Eigen/Geometry>
#include <map>

#include "core/numerics/contact/pair_geometry.h"
#include "core/numerics/contact_forces/friction.h"
#include "tests/support/kernel_check.h"

using namespace drape;
using Eigen::Vector3d;

namespace {

/// One pair alone; the first `cloth` of its vertices in `order` belong to the cloth, the others to an
/// obstacle.
struct OnePair {
  Positions x, obstacle;
  ContactPair pair;
  BarrierParameters parameters;

  OnePair(PairKind kind, const PairPositions& at, const std::vector<int>& of_cloth = {0, 1, 2, 3}) {
    pair.kind = kind;
    pair.weight = 0.7;
    pair.dhat = 1e-3;
    parameters.stiffness = 3;
    const int cloth = static_cast<int>(of_cloth.size());
    x.resize(cloth, 3);
    obstacle.resize(4 - cloth, 3);
    int own = 0, other = 0;
    for (int k = 0; k < 4; ++k) {
      if (std::count(of_cloth.begin(), of_cloth.end(), k)) {
        x.row(own) = at.col(k);
        pair.vertices[k] = own++;
      } else {
        obstacle.row(other) = at.col(k);
        pair.vertices[k] = cloth + other++;
      }
    }
  }

  PairPositions at() const { return positions_of(pair, x, obstacle); }
  double distance() const { return connection(at(), closest(pair.kind, at())).norm(); }
  double parallel() const {
    const PairPositions y = at();
    return Vector3d(y.col(1) - y.col(0)).cross(Vector3d(y.col(3) - y.col(2))).squaredNorm();
  }
  /// Sets d̂ so that the gap is a part s of it.
  OnePair& with_gap_part(double s) {
    pair.dhat = (distance() - pair.offset) / s;
    return *this;
  }
  std::unique_ptr<Collisions> set(const Positions& y) const {
    return make_pair_contacts(y, obstacle, {pair}, parameters);
  }
  std::unique_ptr<Collisions> set() const { return set(x); }
  Positions gradient(const Positions& y) const { return gradient_of(*set(y), y); }

  /// Gradient and Hessian against differences with step h.
  void check_derivatives(double h, double tolerance) const {
    const auto own = set();
    CAPTURE(at(), closest(pair.kind, at()).c.transpose(), distance(), pair.dhat, pair.mollifier, h);
    REQUIRE(own->contact_count() == 1);
    const Positions g = gradient_of(*own, x);
    const Eigen::MatrixXd hessian = dense(hessian_of(*own, x, Projection::none));
    REQUIRE(g.norm() > 0);
    REQUIRE(hessian.norm() > 0);
    const auto value = [&](const Positions& y) { return set(y)->value(y); };
    const auto by_x = [&](const Positions& y) { return gradient(y); };
    CHECK((differences(value, x, h).transpose() - flat(g)).norm() <= tolerance * g.norm());
    CHECK((differences(by_x, x, h) - hessian).norm() <= tolerance * hessian.norm());
  }

  /// Projections against Eigen's of the whole matrix of the cloth's vertices.
  void check_projections() const {
    const auto own = set();
    const Eigen::MatrixXd whole = dense(hessian_of(*own, x, Projection::none));
    const Eigenpairs eigen = eigenpairs_of(whole);
    for (const auto projection : {Projection::clamp, Projection::absolute}) {
      const Eigen::MatrixXd projected = dense(hessian_of(*own, x, projection));
      CAPTURE(at(), closest(pair.kind, at()).c.transpose(), pair.mollifier);
      CHECK((projected - recomposed(eigen, projection)).norm() <= 1e-10 * whole.norm());
      const double smallest = eigenvalues_of(projected)[0];
      CHECK(smallest >= -1e-12 * whole.norm());
    }
  }
};

double barrier_slope(double s) { return -2 * (s - 1) * std::log(s) - (s - 1) * (s - 1) / s; }

PairPositions close_positions(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return 0.01 * PairPositions::NullaryExpr([&] { return normal(random); });
}

/// Which of a pair's vertices may be the cloth's.
std::vector<std::vector<int>> owners(PairKind kind) {
  if (kind == PairKind::point_triangle) return {{0, 1, 2, 3}, {0}, {1, 2, 3}};
  return {{0, 1, 2, 3}, {0, 1}, {2, 3}};
}

/// How far the weights are from where the nearest features change.
double inside(const Closest& closest) {
  double least = 1;
  for (int k = 0; k < 4; ++k)
    if (closest.c[k] != 0 && closest.direction.row(k).norm() > 0)
      least = std::min(least, std::abs(closest.c[k]));
  return least;
}

PairPositions columns(const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& d) {
  PairPositions x;
  x << a, b, c, d;
  return x;
}

}  // namespace

TEST_CASE("derivatives and projections of random pairs") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  std::map<std::tuple<PairKind, std::size_t, int, bool>, int> seen;
  for (const auto kind : {PairKind::point_triangle, PairKind::edge_edge})
    for (int i = 0; i < 600; ++i) {
      const auto of_cloth = owners(kind)[i % owners(kind).size()];
      OnePair one(kind, close_positions(random), of_cloth);
      const Closest nearest = closest(kind, one.at());
      if (one.distance() < 1e-3 || inside(nearest) < 0.05) continue;
      if (i % 2) one.pair.offset = 0.6 * one.distance();
      if (kind == PairKind::edge_edge) one.pair.mollifier = one.parallel() * 2 * unit(random);
      one.with_gap_part(0.1 + 0.8 * unit(random));
      const bool mollified = one.parallel() < one.pair.mollifier;
      if (kind == PairKind::edge_edge && std::abs(one.parallel() / one.pair.mollifier - 1) < 0.02) continue;
      ++seen[{kind, of_cloth.size(), nearest.free, kind == PairKind::edge_edge && mollified}];
      one.check_derivatives(1e-6, 1e-6);
      one.check_projections();
    }
  // Each region and owner: of point and triangle 3 × 3, of edges 3 × 2, mollified or not.
  CHECK(seen.size() == 9 + 12);
  for (const auto& [what, count] : seen) CHECK(count >= 5);
}

TEST_CASE("derivatives next to changes of the nearest features, and a continuous gradient across them") {
  const Vector3d o(0, 0, 0), e1(0.01, 0, 0), e2(0, 0.01, 0), e3(0, 0, 0.002);
  const Vector3d edge = 0.4 * e1, vertex = o, diagonal = 0.3 * e1 + 0.7 * e2;
  for (const Vector3d& foot : {edge, vertex, diagonal})
    for (const double aside : {1e-6, 1e-8, 1e-10}) {
      std::vector<Positions> gradients;
      for (const Vector3d& way :
           {Vector3d(1, 2, 0), Vector3d(-2, -1, 0), Vector3d(2, -3, 0), Vector3d(-1, 2, 0)}) {
        const Vector3d point = foot + e3 + aside * way;
        OnePair one(PairKind::point_triangle, columns(point, o, e1, e2));
        one.pair.dhat = 0.004;
        one.check_derivatives(aside / 4, 1e-6 + 1e-15 / aside);
        one.check_projections();
        gradients.push_back(one.gradient(one.x));
      }
      for (const Positions& g : gradients) CHECK((g - gradients[0]).norm() <= 5e3 * aside * g.norm());
    }
  // The end of one edge beside the middle of the other, and both ends.
  for (const double aside : {1e-6, 1e-8, 1e-10})
    for (const double sign : {-1.0, 1.0})
      for (const Vector3d& to : {Vector3d(0.001, 0.01, 0), Vector3d(0.004, 0.01, 0)}) {
        const Vector3d from = e3 + (to.x() == 0.004 ? 0.4 : 0) * e1 + Vector3d(sign, -2 * sign, 0) * aside;
        OnePair one(PairKind::edge_edge, columns(o, e1, from, to + e3));
        one.pair.dhat = 0.004;
        one.check_derivatives(aside / 4, 1e-6 + 1e-15 / aside);
        one.check_projections();
      }
}

TEST_CASE("derivatives at gaps of 1e-8 m") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0.1, 0.4);
  for (int i = 0; i < 100; ++i) {
    const double gap = 1e-8;
    PairPositions at = close_positions(random);
    const PairKind kind = i % 2 ? PairKind::point_triangle : PairKind::edge_edge;
    if (kind == PairKind::point_triangle) {
      const Vector3d n = Vector3d(at.col(2) - at.col(1)).cross(Vector3d(at.col(3) - at.col(1))).normalized();
      at.col(0) = at.col(1) + unit(random) * (at.col(2) - at.col(1)) + unit(random) * (at.col(3) - at.col(1));
      at.col(0) += gap * n;
    } else {
      const Vector3d u = at.col(1) - at.col(0), v = at.col(3) - at.col(2), n = u.cross(v).normalized();
      at.col(2) = at.col(0) + unit(random) * u + gap * n - unit(random) * v;
      at.col(3) = at.col(2) + v;
    }
    OnePair one(kind, at);
    CHECK(one.distance() == Approx(gap).epsilon(1e-6));
    if (i % 4 == 0) one.pair.mollifier = 1.5 * one.parallel();
    one.check_derivatives(2e-10, 1e-4);
    one.check_projections();
    CHECK(one.set()->smallest_gap() == Approx(one.distance()));
  }
}

TEST_CASE("parallel and nearly parallel edges") {
  const Vector3d o(0, 0, 0), e1(0.01, 0, 0), e3(0, 0, 0.0005), shift(0.003, 0, 0);
  const double epsilon = 1e-3 * 1e-8;
  double before = -1;
  for (const double angle : {0.0, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 1e-2, 0.039, 0.04, 0.1}) {
    const Vector3d half = 0.004 * Vector3d(std::cos(angle), std::sin(angle), 0);
    OnePair one(PairKind::edge_edge, columns(o, e1, shift - half + e3, shift + half + e3));
    one.pair.mollifier = epsilon;
    const auto own = one.set();
    const Positions g = gradient_of(*own, one.x);
    const Eigen::MatrixXd h = dense(hessian_of(*own, one.x, Projection::none));
    CAPTURE(angle);
    CHECK(own->contact_count() == 1);
    CHECK(own->value(one.x) >= before);
    CHECK(g.allFinite());
    CHECK(h.allFinite());
    REQUIRE(h.norm() > 0);
    one.check_projections();
    before = own->value(one.x);
    if (angle == 0) {
      // m = 0 and m' = 0: what is left of the Hessian is b ∇²m.
      CHECK(own->value(one.x) == 0);
      CHECK(g.norm() == 0);
      const auto by_x = [&](const Positions& y) { return one.gradient(y); };
      CHECK((differences(by_x, one.x, 1e-8) - h).norm() <= 1e-4 * h.norm());
    }
    if (angle >= 1e-3) one.check_derivatives(1e-6 * angle, 1e-5);
  }
}

TEST_CASE("the mollifier's threshold") {
  std::mt19937 random(5);
  int checked = 0;
  for (int i = 0; i < 100; ++i) {
    OnePair one(PairKind::edge_edge, close_positions(random));
    if (one.distance() < 1e-3 || inside(closest(one.pair.kind, one.at())) < 0.05) continue;
    one.with_gap_part(0.3);
    const double z = one.parallel();
    std::vector<Positions> gradients;
    std::vector<double> values;
    for (const double part : {1 - 1e-9, 1.0, 1 + 1e-9, 1 + 1e-3}) {
      one.pair.mollifier = z * part;
      gradients.push_back(one.gradient(one.x));
      values.push_back(one.set()->value(one.x));
      if (part > 1 + 1e-6) one.check_derivatives(1e-8, 1e-5);
    }
    one.pair.mollifier = z;
    CHECK((gradients[0] - gradients[1]).norm() <= 1e-12 * gradients[1].norm());
    CHECK((gradients[2] - gradients[1]).norm() <= 1e-7 * gradients[1].norm());
    CHECK(values[2] == Approx(values[1]).epsilon(1e-12));
    ++checked;
  }
  CHECK(checked > 20);
}

TEST_CASE("the force is -κ weight b'(s), along the shortest vector, and sums to zero") {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0.02, 0.98);
  for (int i = 0; i < 200; ++i) {
    OnePair one(i % 2 ? PairKind::point_triangle : PairKind::edge_edge, close_positions(random));
    if (i % 3 == 0) one.pair.offset = 0.5 * one.distance();
    const double s = unit(random);
    one.with_gap_part(s);
    const Positions g = one.gradient(one.x);
    const Closest found = closest(one.pair.kind, one.at());
    const Vector3d n = connection(one.at(), found).normalized(),
                   pushed = found.c.head<2>().sum() > 0.5 && i % 2 == 0 ? Vector3d(g.row(0) + g.row(1))
                                                                        : Vector3d(g.row(0));
    const double expected = one.parameters.stiffness * one.pair.weight * barrier_slope(s);
    CHECK((pushed - expected * n).norm() <= 1e-9 * std::abs(expected));
    CHECK(g.colwise().sum().norm() <= 1e-12 * std::abs(expected));
    CHECK(one.set()->value(one.x) == Approx(-one.parameters.stiffness * one.pair.weight * one.pair.dhat *
                                            (s - 1) * (s - 1) * std::log(s)));
  }
}

TEST_CASE("the barrier is zero beyond dhat and infinite at contact") {
  const Vector3d o(0, 0, 0), e1(0.01, 0, 0), e2(0, 0.01, 0);
  OnePair one(PairKind::point_triangle, columns(0.3 * (e1 + e2) + Vector3d(0, 0, 1e-3), o, e1, e2));
  one.parameters.dhat = 1e-3;
  CHECK(one.set()->contact_count() == 0);
  CHECK(one.set()->value(one.x) == 0);
  CHECK(one.set()->smallest_gap() == std::numeric_limits<double>::infinity());
  CHECK(one.set()->stencils().rows() == 0);
  CHECK(lagged_friction(*one.set(), one.x, {}) == nullptr);
  one.pair.offset = 1e-3;
  CHECK(one.set()->contact_count() == 1);
  CHECK(one.set()->value(one.x) == std::numeric_limits<double>::infinity());
  one.pair.offset = 2e-3;
  CHECK(one.set()->value(one.x) == std::numeric_limits<double>::infinity());
  CHECK(one.set()->smallest_gap() == Approx(-1e-3));
}

TEST_CASE("a contact's friction is at most μ times its force and opposes the motion") {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 90; ++i) {
    const PairKind kind = static_cast<PairKind>(i % 2);
    OnePair one(kind, close_positions(random), owners(kind)[(i / 2) % owners(kind).size()]);
    one.pair.friction = 0.3;
    const bool mollified = i % 4 == 1;  // every second pair of edges
    one.pair.mollifier = mollified ? 2 * one.parallel() : 0;
    one.with_gap_part(0.4);
    one.parameters.friction_smoothing_distance = 1e-5;
    const Positions from = one.x;
    const auto friction = lagged_friction(*one.set(), from, {});
    REQUIRE(friction);
    const Closest found = closest(kind, one.at());
    const Vector3d n = connection(one.at(), found).normalized();
    Vector3d u = Vector3d::Zero();
    Positions moved = from;
    for (Eigen::Index v = 0; v < moved.rows(); ++v)
      for (int c = 0; c < 3; ++c) moved(v, c) += 1e-3 * normal(random);
    Vector3d force = Vector3d::Zero();
    const Positions g = gradient_of(*friction, moved);
    for (int k = 0; k < 4; ++k) {
      const int v = one.pair.vertices[k];
      if (v >= one.x.rows()) continue;
      u += found.c[k] * (moved.row(v) - from.row(v)).transpose();
      if ((k < first_primitive_size(kind)) == (one.pair.vertices[0] < one.x.rows())) force += g.row(v);
    }
    u -= n.dot(u) * n;
    REQUIRE(u.norm() > one.parameters.friction_smoothing_distance);
    const double faded = mollified ? 0.75 : 1;  // y (2 - y) at y = 1/2
    const double expected = -0.3 * faded * one.parameters.stiffness * one.pair.weight * barrier_slope(0.4);
    REQUIRE(expected > 0);
    CHECK(force.norm() == Approx(expected).epsilon(1e-9));
    const double sign = one.pair.vertices[0] < one.x.rows() ? 1 : -1;
    CHECK((sign * force - expected * u.normalized()).norm() <= 1e-9 * expected);
  }
}

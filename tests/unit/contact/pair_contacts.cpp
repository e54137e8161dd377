#include "core/numerics/contact/pair_contacts.h"

#include <map>

#include "core/numerics/contact_forces/friction.h"
#include "tests/unit/contact/pairs.h"

using namespace drape;
using Eigen::Vector3d;

namespace {

/// One pair alone; the vertices `of_cloth` belong to the cloth, the others to an obstacle.
struct OnePair {
  Positions x, obstacle;
  ContactPair pair;
  BarrierParameters parameters{1e-3, 3};

  OnePair(PairKind kind, const PairPositions& at, const std::vector<int>& of_cloth = {0, 1, 2, 3},
          double dhat = 1e-3) {
    pair.kind = kind;
    pair.weight = 0.7;
    pair.dhat = dhat;
    const int cloth = static_cast<int>(of_cloth.size());
    x.resize(cloth, 3);
    obstacle.resize(4 - cloth, 3);
    int own = 0, other = 0;
    for (int k = 0; k < 4; ++k) {
      const bool is_cloth = std::count(of_cloth.begin(), of_cloth.end(), k) > 0;
      (is_cloth ? x.row(own) : obstacle.row(other)) = at.col(k);
      pair.vertices[k] = is_cloth ? own++ : cloth + other++;
    }
  }

  PairPositions at() const { return positions_of(pair, x, obstacle); }
  Closest nearest() const { return closest(pair.kind, at()); }
  Vector3d shortest() const { return connection(at(), nearest()); }
  double parallel() const {
    const PairPositions y = at();
    return Vector3d(y.col(1) - y.col(0)).cross(Vector3d(y.col(3) - y.col(2))).squaredNorm();
  }
  /// Sets d̂ so that the gap is a part s of it.
  void set_gap_part(double s) { pair.dhat = (shortest().norm() - pair.offset) / s; }
  /// How far the weights are from where the nearest features change.
  double inside() const {
    const Closest found = nearest();
    double least = 1;
    for (int k = 0; k < 4; ++k)
      if (found.c[k] != 0 && found.direction.row(k).norm() > 0) least = std::min(least, std::abs(found.c[k]));
    return least;
  }
  std::unique_ptr<Collisions> set(const Positions& y) const {
    return make_collisions(parameters, find_pair_contacts(y, obstacle, {pair}));
  }
  std::unique_ptr<Collisions> set() const { return set(x); }
  double value() const { return set()->value(x); }
  Positions gradient() const { return gradient_of(*set(), x); }
  /// -κ weight b'(s) [N]
  double force(double s) const {
    return parameters.stiffness * pair.weight * (s - 1) * (2 * std::log(s) + (s - 1) / s);
  }

  /// Gradient and Hessian against differences with step h.
  void check_derivatives(double h, double tolerance) const {
    CAPTURE(at(), nearest().c.transpose(), pair.dhat, pair.mollifier, h);
    REQUIRE(set()->contact_count() == 1);
    check_energy_derivatives([&](const Positions& y) { return set(y); }, x, h, tolerance, tolerance);
  }
  void check_projections() const {
    CAPTURE(at(), nearest().c.transpose(), pair.mollifier);
    check_whole_projections(*set(), x);
  }
};

constexpr PairKind pair_kinds[] = {PairKind::point_triangle, PairKind::edge_edge};

PairPositions close_pair(std::mt19937& random) { return 0.01 * random_pair(random); }

/// Which of a pair's vertices may be the cloth's.
std::vector<std::vector<int>> owners(PairKind kind) {
  if (kind == PairKind::point_triangle) return {{0, 1, 2, 3}, {0}, {1, 2, 3}};
  return {{0, 1, 2, 3}, {0, 1}, {2, 3}};
}

const Vector3d o(0, 0, 0), e1(0.01, 0, 0), e2(0, 0.01, 0), e3(0, 0, 0.002);

}  // namespace

TEST_CASE("derivatives and projections of random pairs") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0, 1);
  std::map<std::tuple<PairKind, std::size_t, int, bool>, int> seen;
  for (const auto kind : pair_kinds)
    for (int i = 0; i < 600; ++i) {
      const auto of_cloth = owners(kind)[i % 3];
      OnePair one(kind, close_pair(random), of_cloth);
      const double distance = one.shortest().norm();
      if (distance < 1e-3 || one.inside() < 0.05) continue;
      if (i % 2) one.pair.offset = 0.6 * distance;
      const bool edges = kind == PairKind::edge_edge;
      if (edges) one.pair.mollifier = one.parallel() * 2 * unit(random);
      one.set_gap_part(0.1 + 0.8 * unit(random));
      if (edges && std::abs(one.parallel() / one.pair.mollifier - 1) < 0.02) continue;
      ++seen[{kind, of_cloth.size(), one.nearest().free, edges && one.parallel() < one.pair.mollifier}];
      one.check_derivatives(1e-6, 1e-6);
      one.check_projections();
    }
  // Each region and owner: of point and triangle 3 × 3, of edges 3 × 2, mollified or not.
  CHECK(seen.size() == 9 + 12);
  for (const auto& [what, count] : seen) CHECK(count >= 5);
}

TEST_CASE("derivatives next to changes of the nearest features, and a continuous gradient across them") {
  for (const double aside : {1e-6, 1e-8, 1e-10}) {
    const auto checked = [&](PairKind kind, const PairPositions& at) {
      const OnePair one(kind, at, {0, 1, 2, 3}, 0.004);
      one.check_derivatives(aside / 4, 1e-6 + 1e-15 / aside);
      one.check_projections();
      return one.gradient();
    };
    // A point over an edge, a vertex and the diagonal of a triangle.
    for (const Vector3d& foot : {Vector3d(0.4 * e1), o, Vector3d(0.3 * e1 + 0.7 * e2)}) {
      std::vector<Positions> gradients;
      for (const Vector3d& way :
           {Vector3d(1, 2, 0), Vector3d(-2, -1, 0), Vector3d(2, -3, 0), Vector3d(-1, 2, 0)})
        gradients.push_back(checked(PairKind::point_triangle, pair_at(foot + e3 + aside * way, o, e1, e2)));
      for (const Positions& g : gradients) CHECK((g - gradients[0]).norm() <= 5e3 * aside * g.norm());
    }
    // The end of one edge beside an end of the other, and beside its middle.
    for (const double sign : {-1.0, 1.0})
      for (const auto& [from, to] : {std::pair(o, Vector3d(0.001, 0.01, 0)), {0.4 * e1, 0.4 * e1 + e2}})
        checked(PairKind::edge_edge, pair_at(o, e1, from + e3 + sign * aside * Vector3d(1, -2, 0), to + e3));
  }
}

TEST_CASE("derivatives at gaps of 1e-8 m") {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(0.1, 0.4);
  for (int i = 0; i < 100; ++i) {
    const double gap = 1e-8, s = unit(random), t = unit(random);
    PairPositions at = close_pair(random);
    bring_near(pair_kinds[(i + 1) % 2], at, s, t, gap);
    OnePair one(pair_kinds[(i + 1) % 2], at);
    CHECK(one.shortest().norm() == Approx(gap).epsilon(1e-6));
    if (i % 4 == 0) one.pair.mollifier = 1.5 * one.parallel();
    one.check_derivatives(2e-10, 1e-4);
    one.check_projections();
    CHECK(one.set()->smallest_gap() == Approx(one.shortest().norm()));
  }
}

TEST_CASE("parallel and nearly parallel edges") {
  const Vector3d middle(0.003, 0, 0.0005);
  double before = -1;
  for (const double angle : {0.0, 1e-12, 1e-9, 1e-6, 1e-4, 1e-3, 1e-2, 0.039, 0.04, 0.1}) {
    const Vector3d half = 0.004 * Vector3d(std::cos(angle), std::sin(angle), 0);
    OnePair one(PairKind::edge_edge, pair_at(o, e1, middle - half, middle + half));
    one.pair.mollifier = 1e-3 * 1e-8;
    const Positions g = one.gradient();
    const Eigen::MatrixXd h = dense(hessian_of(*one.set(), one.x, Projection::none));
    CAPTURE(angle);
    CHECK(one.set()->contact_count() == 1);
    CHECK(one.value() >= before);
    CHECK(g.allFinite());
    CHECK(h.allFinite());
    REQUIRE(h.norm() > 0);
    one.check_projections();
    before = one.value();
    if (angle == 0) {
      // m = 0 and m' = 0: what is left of the Hessian is b ∇²m.
      CHECK(one.value() == 0);
      CHECK(g.norm() == 0);
      const auto gradient = [&](const Positions& y) { return gradient_of(*one.set(y), y); };
      CHECK((differences(gradient, one.x, 1e-8) - h).norm() <= 1e-4 * h.norm());
    }
    if (angle >= 1e-3) one.check_derivatives(1e-6 * angle, 1e-5);
  }
}

TEST_CASE("the mollifier and its slope are continuous at the threshold") {
  CHECK(mollifier(0, 3).value == 0);
  CHECK(mollifier(3 - 1e-9, 3).value == Approx(1).epsilon(1e-15));
  CHECK(mollifier(3 - 1e-9, 3).first <= 1e-9);
  CHECK(mollifier(3, 3).value == 1);
  CHECK(mollifier(3, 3).first == 0);
}

TEST_CASE("the force is -κ weight b'(s), along the shortest vector, and sums to zero") {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> unit(0.02, 0.98);
  for (int i = 0; i < 200; ++i) {
    OnePair one(pair_kinds[(i + 1) % 2], close_pair(random));
    if (i % 3 == 0) one.pair.offset = 0.5 * one.shortest().norm();
    const double s = unit(random), expected = one.force(s);
    one.set_gap_part(s);
    const Positions g = one.gradient();
    const Vector3d pushed = g.topRows(first_primitive_size(one.pair.kind)).colwise().sum();
    CHECK((pushed + expected * one.shortest().normalized()).norm() <= 1e-9 * expected);
    CHECK(g.colwise().sum().norm() <= 1e-12 * expected);
    CHECK(one.value() == Approx(-one.parameters.stiffness * one.pair.weight * one.pair.dhat * (s - 1) *
                                (s - 1) * std::log(s)));
  }
}

TEST_CASE("the barrier is zero beyond dhat and infinite at contact") {
  OnePair one(PairKind::point_triangle, pair_at(0.3 * (e1 + e2) + Vector3d(0, 0, 1e-3), o, e1, e2));
  CHECK(one.set()->contact_count() == 0);
  CHECK(one.value() == 0);
  CHECK(one.set()->smallest_gap() == std::numeric_limits<double>::infinity());
  CHECK(one.set()->stencils().rows() == 0);
  CHECK(lagged_friction(*one.set(), one.x, {}) == nullptr);
  for (const double offset : {1e-3, 2e-3}) {
    one.pair.offset = offset;
    CHECK(one.set()->contact_count() == 1);
    CHECK(one.value() == std::numeric_limits<double>::infinity());
  }
  CHECK(one.set()->smallest_gap() == Approx(-1e-3));
}

TEST_CASE("a contact's friction is at most μ times its force and opposes the motion") {
  std::mt19937 random(9);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 90; ++i) {
    const PairKind kind = pair_kinds[i % 2];
    OnePair one(kind, close_pair(random), owners(kind)[(i / 2) % 3]);
    one.pair.friction = 0.3;
    const bool mollified = i % 4 == 1;  // every second pair of edges
    one.pair.mollifier = mollified ? 2 * one.parallel() : 0;
    one.set_gap_part(0.4);
    one.parameters.friction_smoothing_distance = 1e-5;
    const auto friction = lagged_friction(*one.set(), one.x, {});
    REQUIRE(friction);
    Positions moved = one.x;
    for (Eigen::Index k = 0; k < moved.size(); ++k) moved.data()[k] += 1e-3 * normal(random);
    const Positions g = gradient_of(*friction, moved);
    // On the first side, or on the second where that alone is the cloth's; and how far the first side moves.
    const bool of_first = one.pair.vertices[0] < one.x.rows();
    Vector3d u = Vector3d::Zero(), force = u;
    for (int k = 0; k < 4; ++k) {
      const int v = one.pair.vertices[k];
      if (v >= one.x.rows()) continue;
      u += one.nearest().c[k] * (moved.row(v) - one.x.row(v)).transpose();
      if ((k < first_primitive_size(kind)) == of_first) force += (of_first ? 1 : -1) * g.row(v);
    }
    const Vector3d n = one.shortest().normalized();
    u -= n.dot(u) * n;
    REQUIRE(u.norm() > one.parameters.friction_smoothing_distance);
    const double faded = mollified ? 0.75 : 1;  // y (2 - y) at y = 1/2
    const double expected = 0.3 * faded * one.force(0.4);
    REQUIRE(expected > 0);
    CHECK((force - expected * u.normalized()).norm() <= 1e-9 * expected);
  }
}

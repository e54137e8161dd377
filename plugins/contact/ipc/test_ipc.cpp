#include <catch2/catch.hpp>
#include <random>
#include <set>

#include "core/numerics/contact/rim_contacts.h"
#include "core/numerics/contact_forces/contact_stiffness.h"
#include "core/numerics/contact_forces/friction.h"
#include "core/numerics/model/required.h"
#include "core/numerics/patterns/generate.h"
#include "plugins/contact/ipc/bound_ipc.h"
#include "tests/support/evaluate.h"
#include "tests/support/ipc_obstacles.h"
#include "tests/support/meshes.h"
#include "tests/support/reference_dihedrals.h"

using namespace drape;
using namespace drape::ipc;

namespace {

/// A square cloth of side 1 folded like a letter, unstretched: straight layers `gap` apart, half circles
/// between them; with noise.
Positions folded(const Level& level, int layers, double gap, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> move(-noise, noise);
  const double turn = M_PI * gap / 2,
               straight = (level.rest.vertices.col(0).maxCoeff() + turn) / layers - turn;
  Positions x = level.rest.vertices;
  for (auto v : x.rowwise()) {
    const double along = v[0];
    const int layer = std::min(static_cast<int>(along / (straight + turn)), layers - 1);
    const double rest = along - layer * (straight + turn), angle = std::max(rest - straight, 0.0) / (gap / 2);
    const double across = std::min(rest, straight) - straight / 2 + gap / 2 * std::sin(angle);
    const double dx = move(random), dy = move(random), dz = move(random);
    v << (layer % 2 ? -across : across) + dx, v[1] + dy, gap * (layer + 0.5 - 0.5 * std::cos(angle)) + dz;
  }
  return x;
}

/// All contacts at x of primitives whose distance is below d̂, with independently computed weights. The
/// obstacles are convex: a cloth vertex has contact with the nearest triangle of each.
std::unique_ptr<Collisions> brute_force(const Level& level, const Obstacles& obstacles, const Positions& x,
                                        const BarrierParameters& barrier, double friction) {
  const Surface own = Surface::of(level.rest, level.topology);
  const SurfaceTopology& other = *obstacles.topology;
  const ReferenceDihedrals d = ReferenceDihedrals::of(other, obstacles.vertices);
  const int n = level.vertex_count();
  std::vector<ContactPair> at_rims, others;
  const auto distance = [&](const ContactPair& pair) {
    const PairPositions at = positions_of(pair, x, obstacles.vertices);
    return connection(at, closest(pair.kind, at)).norm();
  };
  const auto protrusion_factor = [&](const Bend& bend, double length) {
    const double sagitta = std::max(bend.angle * length / 4, bend.curvature * length * length / 8);
    return std::min(1.0, sagitta / (barrier.dhat / 8));
  };
  const auto add = [&](ContactPair pair, double weight) {
    if (weight == 0 || distance(pair) >= barrier.dhat) return;
    pair.weight = weight;
    pair.dhat = barrier.dhat;
    pair.friction = friction;
    (pair.at_rim ? at_rims : others).push_back(pair);
  };
  const auto point_triangle = [](int v, Eigen::RowVector3i t) {
    return ContactPair{{v, t[0], t[1], t[2]}, PairKind::point_triangle};
  };
  const auto edges = [](Eigen::RowVector2i e, Eigen::RowVector2i f, double lengths) {
    ContactPair pair{{e[0], e[1], f[0], f[1]}, PairKind::edge_edge};
    pair.mollifier = 1e-3 * lengths;
    return pair;
  };
  for (int v = 0; v < n; ++v) {
    for (int t = 0; t < own.triangle_count(); ++t)
      if ((own.triangles.row(t).array() != v).all())
        add(point_triangle(v, own.triangles.row(t)), own.vertex_area[v] / 2);
    for (std::size_t body = 0; body < obstacles.bodies.size(); ++body) {
      ContactPair nearest{};
      for (int t = 0; t < other.triangle_count(); ++t) {
        if (obstacles.body_of(other.triangles(t, 0)) != static_cast<int>(body)) continue;
        const ContactPair pair = point_triangle(v, other.triangles.row(t).array() + n);
        if (nearest.vertices == std::array<int, 4>{} || distance(pair) < distance(nearest)) nearest = pair;
      }
      add(nearest, own.vertex_area[v]);
    }
  }
  for (int v = 0; v < obstacles.vertices.rows(); ++v)
    for (int t = 0; t < own.triangle_count(); ++t)
      add(point_triangle(n + v, own.triangles.row(t)),
          std::min(d.vertex[v].area, own.triangle_area[t]) / 2 *
              protrusion_factor(d.vertex[v], std::sqrt(own.triangle_area[t] / (std::sqrt(3.0) / 4))));
  for (int e = 0; e < own.edges.rows(); ++e) {
    for (int f = e + 1; f < own.edges.rows(); ++f) {
      const std::set<int> ends{own.edges(e, 0), own.edges(e, 1), own.edges(f, 0), own.edges(f, 1)};
      if (ends.size() == 4)
        add(edges(own.edges.row(e), own.edges.row(f),
                  own.edge_length_squared[e] * own.edge_length_squared[f]),
            std::min(own.edge_area[e], own.edge_area[f]) / 4);
    }
    for (int f = 0; f < other.edges.rows(); ++f) {
      ContactPair pair = edges(own.edges.row(e), other.edges.row(f).array() + n,
                               own.edge_length_squared[e] * (obstacles.vertices.row(other.edges(f, 1)) -
                                                             obstacles.vertices.row(other.edges(f, 0)))
                                                                .squaredNorm());
      pair.at_rim = d.edge_is_rim[f] != 0;
      add(pair, std::min(own.edge_area[e], d.edge[f].area) / 2 *
                    protrusion_factor(d.edge[f], std::sqrt(own.edge_length_squared[e])));
    }
  }
  REQUIRE(!at_rims.empty());
  return make_collisions(barrier, find_rim_contacts(x, obstacles.vertices, at_rims),
                         find_pair_contacts(x, obstacles.vertices, others));
}

}  // namespace

TEST_CASE("ipc: a surface's areas and representative triangles") {
  const Level level = Level::of(0, grid({2, 1}, 9, 7, Diagonals::criss_cross));
  const Surface s = Surface::of(level.rest, level.topology);
  for (const double area : {s.vertex_area.sum(), s.edge_area.sum(), s.triangle_area.sum()})
    CHECK(area == Approx(2));
  CHECK((s.vertex_area - level.vertex_area).norm() < 1e-14);
  Eigen::VectorXi of_vertices = Eigen::VectorXi::Zero(level.vertex_count()),
                  of_edges = Eigen::VectorXi::Zero(s.edges.rows());
  for (int t = 0; t < s.triangle_count(); ++t)
    for (int k = 0; k < 3; ++k) {
      of_vertices[s.triangles(t, k)] += s.represents_vertex(t, k);
      of_edges[s.triangle_edges(t, k)] += s.represents_edge(t, k);
    }
  CHECK((of_vertices.array() == 1).all());
  CHECK((of_edges.array() == 1).all());
}

TEST_CASE("ipc: obstacles are scaled, rotated and translated, and without any there is no contact") {
  const TriangleMesh round = obstacle_of(ball(3, {1, 2, 3}, 0.3)).mesh();
  CHECK(round.triangles.rows() == 20 * 64);
  CHECK(((round.vertices.rowwise() - Eigen::RowVector3d(1, 2, 3)).rowwise().norm().array() - 0.3)
            .abs()
            .maxCoeff() < 1e-14);
  CHECK(volume_of(round) == Approx(4 * M_PI / 3 * 0.027).epsilon(0.02));
  ObstacleParameters p = box({1, 2, 4}, {0, 0, 1});
  p.rotate = {0, 90, 0};
  p.scale = 0.5;
  const TriangleMesh table = obstacle_of(p).mesh();
  CHECK((table.vertices.colwise().maxCoeff() - Eigen::RowVector3d(1, 0.5, 1.25)).norm() < 1e-14);
  CHECK(volume_of(table) == Approx(1));
  Ipc::Parameters nothing;
  nothing.self_contact = false;
  CHECK(Ipc(nothing).bind(square_sheet(3, 1), Material()) == nullptr);
}

TEST_CASE("ipc: the collisions of a motion's candidates are those of a brute-force search") {
  const Level level = Level::of(0, grid({1, 1}, 24, 16, Diagonals::criss_cross));
  Ipc::Parameters p;
  p.dhat = 0.012;
  p.friction = 0.3;
  p.obstacles = {ball(2, {0, 0.5, -0.105}, 0.1), box({0.3, 0.4, 0.1}, {-0.1, 0.2, -0.06})};
  const Obstacles obstacles = obstacles_of({obstacle_of(p.obstacles[0]), obstacle_of(p.obstacles[1])});
  const Positions x0 = folded(level, 4, 0.02, 0.002, 1);
  Positions x1 = folded(level, 4, 0.011, 0.003, 2);
  x1.col(2).array() -= 0.003;
  const Material material;
  const BarrierParameters barrier{p.dhat, contact_stiffness(material), p.friction_smoothing_distance};
  std::vector<double> energies;
  for (const BroadPhaseKind kind : {BroadPhaseKind::bvh, BroadPhaseKind::fcl}) {
    p.broad_phase = kind;
    const auto contact = Ipc(p).bind(level, material);
    REQUIRE(contact->intersections(x0).empty());
    const auto candidates = contact->build_candidates(x0, x1);
    for (const double part : {0.0, 0.3, 1.0}) {
      const Positions x = x0 + part * (x1 - x0);
      const auto expected = brute_force(level, obstacles, x, barrier, p.friction),
                 found = candidates->build_collisions(x);
      REQUIRE(expected->contact_count() > 100);
      CHECK(found->contact_count() == expected->contact_count());
      CHECK(found->smallest_gap() == Approx(expected->smallest_gap()).epsilon(1e-12));
      CHECK(found->value(x) == Approx(expected->value(x)).epsilon(1e-10));
      const Positions g = gradient_of(*found, x), exact = gradient_of(*expected, x);
      CHECK((g - exact).norm() <= 1e-10 * exact.norm());
      const auto friction = lagged_friction(*found, x0, {});
      REQUIRE(friction);
      CHECK(friction->value(x) == Approx(lagged_friction(*expected, x0, {})->value(x)).epsilon(1e-10));
      energies.push_back(found->value(x));
    }
    const double fraction = candidates->max_step().fraction;
    CHECK(fraction > 0);
    CHECK(contact->intersections(x0 + fraction * (x1 - x0)).empty());
  }
  for (int i = 0; i < 3; ++i) CHECK(energies[i] == energies[3 + i]);  // bit for bit, with any broad phase
}

TEST_CASE("ipc: a mesh finer than dhat never intersects itself, and its layers repel") {
  const Level level = Level::of(0, grid({0.01, 0.01}, 21, 21, Diagonals::one_way));
  const auto contact = Ipc(Ipc::Parameters()).bind(level, Material());  // d̂ is twice the edges
  const int middle = 10 * 21 + 10;
  Positions above = level.rest.vertices, through = above;
  through.row(middle) = above.row(middle + 3) + Eigen::RowVector3d(0, 0, -1e-3);
  above(middle, 2) += 1e-3;
  const double fraction = contact->build_candidates(above, through)->max_step().fraction;
  CHECK(fraction < 1);
  CHECK(contact->intersections(above + fraction * (through - above)).empty());
  CHECK(!contact->intersections(0.5 * (above + through)).empty());
  CHECK(collisions_at(*contact, folded(level, 2, 4e-4, 0, 1))->contact_count() > 100);
}

TEST_CASE("ipc: a motion with too many candidates is shortened") {
  const Level level = Level::of(0, grid({1, 1}, 60, 60, Diagonals::one_way));
  const auto contact = Ipc(Ipc::Parameters()).bind(level, Material());
  const Positions& x0 = level.rest.vertices;
  Positions x1 = x0.rowwise() + Eigen::RowVector3d(0, 0, -100);  // a translation: no limit
  CHECK(contact->build_candidates(x0, x1)->max_step().fraction == 1);
  std::mt19937 random(5);
  std::normal_distribution<double> move(0, 10);
  for (int i = 0; i < x1.size(); ++i) x1.data()[i] += move(random);
  const double fraction = contact->build_candidates(x0, x1)->max_step().fraction;
  CHECK(fraction > 0);
  CHECK(fraction < 0.1);
  CHECK(contact->intersections(x0 + fraction * (x1 - x0)).empty());
}

TEST_CASE("ipc: a model made and bound from another is as a new one, and shares what stays the same") {
  const Level level = Level::of(0, grid({0.4, 0.4}, 9, 9, Diagonals::criss_cross));
  const Positions x = level.rest.vertices.rowwise() + Eigen::RowVector3d(0, 0, 4e-4);
  Ipc::Parameters p;
  p.stiffness = 7;
  p.friction = 0.2;
  p.obstacles = {box({1, 1, 0.1}, {0.2, 0.2, -0.05}), ball(2, {0.2, 0.2, -0.5}, 0.05)};
  const Ipc model(p);
  const auto contact = model.bind(level, Material());
  const auto barrier = [&](const BoundContact& c) { return collisions_at(c, x)->value(x); };
  const auto vertices = [](const BoundContact& c) { return c.obstacles().at(1).vertices; };
  const auto rest = [](const BoundContact& c) { return dynamic_cast<const BoundIpc&>(c).rest(); };
  const double before = barrier(*contact);
  REQUIRE(before > 0);
  const Positions ball = vertices(*contact);
  const auto is_ball = [&](const Positions& y) { return y.rows() == ball.rows() && y == ball; };

  for (const auto& change :
       {+[](Ipc::Parameters& q) { q.stiffness = 14; }, +[](Ipc::Parameters& q) { q.dhat = 2e-3; },
        +[](Ipc::Parameters& q) { q.obstacles[0].translate.z() = -0.0501; },
        +[](Ipc::Parameters& q) { q.obstacles[1].radius = 0.06; },
        +[](Ipc::Parameters& q) { q.obstacles[1].subdivisions = 3; }}) {
    Ipc::Parameters q = p;
    change(q);
    const auto again = Ipc(q, model).rebind(level, Material(), *contact),
               alone = Ipc(q).bind(level, Material());
    CHECK(barrier(*again) == barrier(*alone));
    REQUIRE(vertices(*again).rows() == vertices(*alone).rows());
    CHECK(vertices(*again) == vertices(*alone));
    CHECK((barrier(*again) != before || !is_ball(vertices(*again))));
    CHECK((rest(*again) == rest(*contact)) == (q.dhat == p.dhat));
    CHECK(rest(*alone) != rest(*contact));
  }
  CHECK(barrier(*contact) == before);
  CHECK(is_ball(vertices(*contact)));
  Ipc::Parameters q = p;
  q.broad_phase = BroadPhaseKind::fcl;  // whose trees cannot be compared with the others
  CHECK(barrier(*Ipc(q, model).rebind(level, Material(), *contact)) == before);
}

TEST_CASE("ipc: a dhat larger than the cloth is refused before its pairs exceed memory") {
  const Level level = Level::of(0, grid({1, 1}, 80, 80, Diagonals::one_way));
  Ipc::Parameters p;
  p.dhat = 2 / 79.0;  // two edges
  CHECK_NOTHROW(Ipc(p).bind(level, Material()));
  p.dhat = 1000;
  CHECK_THROWS_WITH(Ipc(p).bind(level, Material()),
                    Catch::Contains("more than 2600000 pairs of the resting cloth's vertices, edges and "
                                    "triangles are within \"dhat\" of each other"));
}

#include "core/kernel/interfaces/topology.h"

#include <catch2/catch.hpp>
#include <set>

#include "core/kernel/interfaces/level.h"
#include "core/numerics/collision_detection/components.h"
#include "core/numerics/mesh/same_entries.h"
#include "core/numerics/patterns/generate.h"

using namespace drape;

namespace {

const Triangles two_triangles{{0, 1, 2}, {2, 1, 3}};

std::vector<int> row(const AdjacencyList& list, int i) {
  const auto items = list.row(i);
  return {items.begin(), items.end()};
}

}  // namespace

TEST_CASE("the topology of two triangles") {
  const Topology topology = Topology::of(two_triangles, 5);

  Eigen::MatrixXi edges(5, 2), triangle_edges(2, 3), edge_triangles(5, 2);
  edges << 1, 2, 0, 2, 0, 1, 1, 3, 2, 3;
  triangle_edges << 0, 1, 2, 3, 4, 0;
  edge_triangles << 0, 1, 0, -1, 0, -1, 1, -1, 1, -1;
  CHECK(topology.edges == edges);
  CHECK(topology.triangle_edges == triangle_edges);
  CHECK(topology.edge_triangles == edge_triangles);
  CHECK(topology.on_border == std::vector<char>{1, 1, 1, 1, 0});
  CHECK(row(topology.vertex_vertices, 1) == std::vector<int>{0, 2, 3});
  CHECK(row(topology.vertex_vertices, 3) == std::vector<int>{1, 2});
  CHECK(row(topology.vertex_triangles, 2) == std::vector<int>{0, 1});
  CHECK(row(topology.vertex_triangles, 4).empty());
}

TEST_CASE("meshes with another number of triangles have other triangles") {
  const Triangles two = grid({1, 1}, 2, 2, Diagonals::one_way).triangles, one = two.topRows(1);
  CHECK(same_entries(two, Triangles(two)));
  CHECK_FALSE(same_entries(one, two));
  CHECK_FALSE(same_entries(two, one));
  CHECK_FALSE(same_entries(two, two.colwise().reverse()));
}

TEST_CASE("hinges keep the mesh's orientation") {
  const auto hinges = Topology::of(two_triangles, 4).hinges(two_triangles);
  REQUIRE(hinges.rows() == 1);
  CHECK(hinges.row(0) == Eigen::RowVector4i(1, 2, 0, 3));

  const TriangleMesh mesh = grid({1, 1}, 6, 5, Diagonals::criss_cross);
  const Topology topology = Topology::of(mesh.triangles, 30);
  const auto many = topology.hinges(mesh.triangles);
  REQUIRE(many.rows() == topology.edges.rows() - 2 * (5 + 4));
  CHECK(components(topology) == std::vector<int>{0});
  std::set<std::vector<int>> rotations;
  for (const auto& t : mesh.triangles.rowwise())
    for (int k = 0; k < 3; ++k) rotations.insert({t[k], t[(k + 1) % 3], t[(k + 2) % 3]});
  for (int h = 0; h < many.rows(); ++h) {
    CHECK(rotations.count({many(h, 0), many(h, 1), many(h, 2)}) == 1);
    CHECK(rotations.count({many(h, 1), many(h, 0), many(h, 3)}) == 1);
  }
}

TEST_CASE("components are named by their first vertices") {
  Triangles triangles(4, 3);
  triangles << 0, 2, 4, 1, 3, 5, 4, 2, 7, 8, 9, 6;  // vertex 10 has no triangle
  CHECK(components(Topology::of(triangles, 11)) == std::vector<int>{0, 1, 6, 10});
}

TEST_CASE("topology refuses what it cannot represent") {
  Triangles t(3, 3);
  t << 0, 1, 2, 1, 0, 3, 0, 1, 4;
  CHECK_THROWS_WITH(Topology::of(t, 5), "topology: edge (0, 1) has more than two triangles");
  CHECK_THROWS_WITH(Topology::of(t, 4), "topology: triangle 2 has a vertex outside 0 … 3");
  t.row(1) << 1, 1, 3;
  CHECK_THROWS_WITH(Topology::of(t, 5), "topology: triangle 1 repeats a vertex");
}

TEST_CASE("a fan of a million triangles takes no quadratic time") {
  const int count = 1000000;  // linear: tenths of a second; quadratic: hours, which the test's limit ends
  Triangles fan(count, 3);
  for (int t = 0; t < count; ++t) fan.row(t) << 0, 1 + t, 1 + (t + 1) % count;
  const Topology topology = Topology::of(fan, count + 1);
  CHECK(topology.vertex_vertices.size(0) == count);
  CHECK_FALSE(topology.on_border[0]);
}

TEST_CASE("a level's vertex areas are thirds of its triangles") {
  const Level level = Level::of(3, grid({2, 3}, 3, 4, Diagonals::one_way));
  CHECK(level.index == 3);
  REQUIRE(level.vertex_area.size() == 12);
  CHECK(level.vertex_area.sum() == Approx(6).epsilon(1e-14));
  for (const auto& [vertex, triangles] : {std::pair(4, 6), {0, 2}, {2, 1}})  // of 1/2
    CHECK(level.vertex_area[vertex] == Approx(triangles * 0.5 / 3).epsilon(1e-14));
}

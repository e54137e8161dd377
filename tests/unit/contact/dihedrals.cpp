#include <catch2/catch.hpp>
#include <tuple>

#include "core/numerics/patterns/generate.h"
#include "tests/support/any_threads.h"
#include "tests/support/random.h"
#include "tests/support/reference_dihedrals.h"

using namespace drape;

namespace {

/// A rough sheet with a third triangle at an edge of its middle, a fin of one triangle, and a box's corner.
TriangleMesh rough_surface() {
  TriangleMesh mesh = grid({0.05, 0.05}, 12, 12, Diagonals::criss_cross);
  RandomNumbers random(3);
  for (auto v : mesh.vertices.rowwise()) v += random.vector(1e-3).transpose();
  const int n = static_cast<int>(mesh.vertices.rows()), m = static_cast<int>(mesh.triangles.rows());
  mesh.vertices.conservativeResize(n + 5, 3);
  mesh.vertices.bottomRows(5) << 0.02, 0.02, 0.01, 1, 0, 0, 1.1, 0, 0, 1, 0.1, 0, 1, 0, 0.1;
  mesh.triangles.conservativeResize(m + 4, 3);
  mesh.triangles.bottomRows(4) << mesh.triangles(m / 2, 0), mesh.triangles(m / 2, 1), n, n + 1, n + 2, n + 3,
      n + 1, n + 3, n + 4, n + 1, n + 4, n + 2;
  return mesh;
}

ObstacleSurface surface_of(const TriangleMesh& mesh) {
  const auto n = static_cast<int>(mesh.vertices.rows());
  return {mesh.vertices,
          std::make_shared<const ObstacleTopology>(
              SurfaceTopology(mesh.triangles, Topology::of_any(mesh.triangles, n))),
          {0, n}};
}

std::tuple<double, double, double> members(const Bend& b) { return {b.angle, b.curvature, b.area}; }

}  // namespace

TEST_CASE("dihedrals: bends made when asked for are those of passes over the whole surface, bit for bit") {
  const TriangleMesh mesh = rough_surface();
  const ObstacleSurface surface = surface_of(mesh);
  const ReferenceDihedrals all = ReferenceDihedrals::of(*surface.topology, surface.vertices);
  REQUIRE(std::ranges::count(all.further, 0) > 20);
  REQUIRE(std::ranges::count(all.further, 2) == 1);
  REQUIRE(std::ranges::count(all.edge_is_rim, 0) > 50);
  const Dihedrals lazy(surface);
  for (int round = 0; round < 2; ++round) {  // the second finds them made
    for (int v = 0; v < mesh.vertices.rows(); ++v) CHECK(members(lazy.vertex(v)) == members(all.vertex[v]));
    for (int e = 0; e < surface.topology->edges.rows(); ++e) {
      CHECK(members(lazy.edge(e)) == members(all.edge[e]));
      CHECK(lazy.edge_is_rim(e) == (all.edge_is_rim[e] != 0));
    }
  }
  for (const double dhat : {1e-4, 1e-3, 3e-3, 0.1}) {
    const std::vector<double> of_vertices = all.vertex_coefficients(*surface.topology, dhat);
    for (int v = 0; v < mesh.vertices.rows(); ++v) CHECK(lazy.vertex_coefficient(v, dhat) == of_vertices[v]);
    for (int e = 0; e < surface.topology->edges.rows(); ++e)
      CHECK(lazy.edge_coefficient(e, dhat) == all.edge_coefficient(e, dhat));
  }
}

TEST_CASE("dihedrals: threads that ask for the same bends at the same time get the same") {
  const ObstacleSurface surface = surface_of(rough_surface());
  const auto count = static_cast<int>(surface.vertices.rows());
  const double sum = same_with_any_threads([&] {
    const Dihedrals lazy(surface);
    return parallel_sum(64 * count, 1, [&](int begin, int) {
      const Bend bend = lazy.vertex(begin / 64);
      return bend.angle + bend.curvature + bend.area;
    });
  });
  CHECK(sum > 0);
}

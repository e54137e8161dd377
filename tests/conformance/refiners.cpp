#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "core/kernel/interfaces/level.h"
#include "core/kernel/interfaces/refiner.h"
#include "core/numerics/hierarchy/midpoint.h"
#include "core/numerics/mesh/check.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/registry.h"

using namespace drape;

namespace {

struct NamedMesh {
  std::string name;
  TriangleMesh mesh;
  bool straight;  ///< convex with a border of straight sides, so that no area may be lost
};

std::vector<NamedMesh> meshes() {
  TriangleMesh curved = random_triangulation({0.6, 0.5}, 50, 3);
  curved.vertices.col(2) = 0.3 * curved.vertices.col(0).cwiseProduct(curved.vertices.col(1));
  return {{"grid", grid({0.6, 0.5}, 6, 5, Diagonals::one_way), true},
          {"criss-cross", grid({0.6, 0.5}, 6, 5, Diagonals::criss_cross), true},
          {"smallest grid", grid({0.6, 0.5}, 2, 2, Diagonals::one_way), true},
          {"random triangulation", random_triangulation({0.6, 0.5}, 50, 2), true},
          {"disc", disc(0.4, 40), false},
          {"polygon with a hole",
           delaunay_polygon(
               {{{0, 0}, {0.8, 0}, {0.6, 0.6}, {0.1, 0.5}}, {{0.3, 0.2}, {0.5, 0.2}, {0.4, 0.35}}}, 60, 1),
           false},
          {"curved", curved, false}};
}

Eigen::Vector3d area_vector(const TriangleMesh& mesh, int t) {
  const auto v = mesh.triangles.row(t);
  const Eigen::Vector3d a = mesh.vertices.row(v[0]), b = mesh.vertices.row(v[1]), c = mesh.vertices.row(v[2]);
  return (b - a).cross(c - a) / 2;
}

double area(const TriangleMesh& mesh) {
  double sum = 0;
  for (int t = 0; t < mesh.triangles.rows(); ++t) sum += area_vector(mesh, t).norm();
  return sum;
}

/// The finer rest shape of every mesh by every refiner.
template <class Body>
void for_each_refinement(const Body& body) {
  const auto refiners = test_registry().of_kind("refiner");
  REQUIRE(refiners.size() >= 2);
  for (const RegistryEntry* entry : refiners)
    for (const NamedMesh& m : meshes()) {
      INFO(entry->name << ", " << m.name);
      const Level coarse = Level::of(0, m.mesh);
      const ProlongationMatrix weights = make_plugin_from<Refiner>(entry->name)->weights(coarse);
      REQUIRE(weights.cols() == coarse.vertex_count());
      body(m, coarse, weights, refined_rest(coarse, weights));
    }
}

}  // namespace

TEST_CASE("A refiner gives one vertex for each vertex and edge, and rows that sum to one", "[conformance]") {
  for_each_refinement(
      [](const NamedMesh&, const Level& coarse, const ProlongationMatrix& p, const TriangleMesh&) {
        REQUIRE(p.rows() == coarse.vertex_count() + coarse.topology.edges.rows());
        const Eigen::VectorXd sums = p * Eigen::VectorXd::Ones(coarse.vertex_count());
        CHECK((sums.array() - 1).abs().maxCoeff() <= 1e-15);
        // A child stays with its parent more than with any other vertex.
        for (int i = 0; i < coarse.vertex_count(); ++i)
          for (ProlongationMatrix::InnerIterator it(p, i); it; ++it) REQUIRE(it.value() <= p.coeff(i, i));
      });
}

TEST_CASE("A refiner keeps the orientation of triangles", "[conformance]") {
  for_each_refinement(
      [](const NamedMesh& m, const Level& coarse, const ProlongationMatrix&, const TriangleMesh& fine) {
        CHECK(check_mesh(fine).empty());
        for (int c = 0; c < 4 * coarse.triangle_count(); ++c)
          REQUIRE(area_vector(fine, c).dot(area_vector(m.mesh, c / 4)) > 0);
      });
}

TEST_CASE("A refiner preserves the area of flat cloths with straight sides", "[conformance]") {
  for_each_refinement(
      [](const NamedMesh& m, const Level&, const ProlongationMatrix&, const TriangleMesh& fine) {
        if (m.straight) CHECK(area(fine) == Approx(0.6 * 0.5).epsilon(1e-13));
      });
}

TEST_CASE("A refiner turns a grid into the finer grid", "[conformance]") {
  const auto sorted = [](const Positions& x) {
    std::vector<std::pair<long, long>> points;  // [µm]
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      points.emplace_back(std::lround(1e6 * x(i, 0)), std::lround(1e6 * x(i, 1)));
    std::sort(points.begin(), points.end());
    return points;
  };
  for_each_refinement(
      [&](const NamedMesh& m, const Level&, const ProlongationMatrix&, const TriangleMesh& fine) {
        if (m.name == "grid") {
          CHECK(sorted(fine.vertices) == sorted(grid({0.6, 0.5}, 11, 9, Diagonals::one_way).vertices));
        }
      });
}

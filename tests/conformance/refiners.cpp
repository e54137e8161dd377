#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "core/kernel/interfaces/level.h"
#include "core/kernel/interfaces/refiner.h"
#include "core/numerics/hierarchy/midpoint.h"
#include "core/numerics/mesh/check.h"
#include "tests/conformance/meshes.h"
#include "tests/support/registry.h"

using namespace drape;

namespace {

Eigen::Vector3d area_vector(const TriangleMesh& mesh, int t) {
  const auto v = mesh.triangles.row(t);
  const Eigen::Vector3d a = mesh.vertices.row(v[0]), b = mesh.vertices.row(v[1]), c = mesh.vertices.row(v[2]);
  return (b - a).cross(c - a) / 2;
}

/// The vertices of a flat mesh in order of their places [µm].
std::vector<std::pair<long, long>> sorted(const Positions& x) {
  std::vector<std::pair<long, long>> points;
  for (const auto& p : x.rowwise()) points.emplace_back(std::lround(1e6 * p[0]), std::lround(1e6 * p[1]));
  std::ranges::sort(points);
  return points;
}

}  // namespace

TEST_CASE("Refiners split every triangle into four alike, and keep straight borders and grids") {
  const auto refiners = test_registry().of_kind("refiner");
  REQUIRE(refiners.size() >= 2);
  std::vector<NamedMesh> meshes = meshes_to_refine();
  meshes.push_back({"smallest grid", grid({0.6, 0.5}, 2, 2, Diagonals::one_way), true});
  for (const RegistryEntry* entry : refiners)
    for (const NamedMesh& m : meshes) {
      INFO(entry->name << ", " << m.name);
      const Level coarse = Level::of(0, m.mesh);
      const ProlongationMatrix weights = make_plugin_from<Refiner>(entry->name)->weights(coarse);
      REQUIRE(weights.cols() == coarse.vertex_count());
      REQUIRE(weights.rows() == coarse.vertex_count() + coarse.topology.edges.rows());
      const Eigen::VectorXd sums = weights * Eigen::VectorXd::Ones(coarse.vertex_count());
      CHECK((sums.array() - 1).abs().maxCoeff() <= 1e-15);
      // A child stays with its parent more than with any other vertex.
      for (int i = 0; i < coarse.vertex_count(); ++i)
        for (ProlongationMatrix::InnerIterator it(weights, i); it; ++it)
          REQUIRE(it.value() <= weights.coeff(i, i));

      const TriangleMesh fine = refined_rest(coarse, weights);
      CHECK(check_mesh(fine).empty());
      double area = 0;
      for (int c = 0; c < 4 * coarse.triangle_count(); ++c) {
        REQUIRE(area_vector(fine, c).dot(area_vector(m.mesh, c / 4)) > 0);
        area += area_vector(fine, c).norm();
      }
      if (m.straight) CHECK(area == Approx(0.6 * 0.5).epsilon(1e-13));
      if (m.name == "grid")
        CHECK((sorted(fine.vertices) == sorted(grid({0.6, 0.5}, 11, 9, Diagonals::one_way).vertices)));
    }
}

TEST_CASE("Coarser levels of refiners are meshes of the level's vertices, with linear weights") {
  int found = 0;
  for (const RegistryEntry* entry : test_registry().of_kind("refiner"))
    for (const NamedMesh& m : meshes_to_refine()) {
      if (m.name == "curved") continue;
      INFO(entry->name << ", " << m.name);
      const Level fine = Level::of(0, m.mesh);
      const std::optional<CoarserMesh> made = make_plugin_from<Refiner>(entry->name)->coarser(fine);
      if (!made) continue;
      ++found;
      const auto n = static_cast<Eigen::Index>(made->vertices.size());
      CHECK(n < fine.vertex_count());
      CHECK(check_mesh(made->rest).empty());
      CHECK(std::ranges::is_sorted(made->vertices));
      CHECK(made->rest.vertices == fine.rest.vertices(made->vertices, Eigen::all));
      REQUIRE(made->weights.rows() == fine.vertex_count());
      REQUIRE(made->weights.cols() == n);
      CHECK((made->weights * Eigen::VectorXd::Ones(n) - Eigen::VectorXd::Ones(fine.vertex_count())).norm() <=
            1e-13);
      CHECK((made->weights * made->rest.vertices - fine.rest.vertices).norm() <= 1e-12);
      const std::optional<CoarserMesh> again = make_plugin_from<Refiner>(entry->name)->coarser(fine);
      CHECK(again->vertices == made->vertices);
      CHECK(again->rest.triangles == made->rest.triangles);
      CHECK((again->weights - made->weights).norm() == 0);
    }
  CHECK(found > 0);
}

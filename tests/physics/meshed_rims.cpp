// Up to its rim a flat surface is a half-space: cloth slides over the rim as if there were none.

#include <catch2/catch.hpp>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/numerics/mesh_files/io.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/command.h"
#include "tests/support/meshes.h"
#include "tests/support/slope.h"
#include "tests/support/solve.h"

using namespace drape;

namespace {

constexpr double rim = 0.053;       // x of the rim; the cloth's leading edge starts at x = 0.05 [m]
constexpr double advance = 0.3e-3;  // of the cloth in a step [m]

/// A square of 0.6 m in cells of this size, which ends at `rim`; with vertical sides, it is a box without a
/// floor.
TriangleMesh slab(double cell, bool with_sides) {
  const int columns = 1 + static_cast<int>(std::lround(0.6 / cell));
  TriangleMesh mesh = grid({0.6, 0.6}, columns, columns, Diagonals::criss_cross);
  mesh.vertices.rowwise() += Eigen::RowVector3d(rim - 0.6, -0.2951, 0);
  if (!with_sides) return mesh;
  std::set<std::pair<int, int>> sides;  // of triangles, in their direction
  for (const auto& t : mesh.triangles.rowwise())
    for (int k = 0; k < 3; ++k) sides.emplace(t[k], t[(k + 1) % 3]);
  std::map<int, int> lower;  // vertices of the border, and those below them
  for (const auto& [a, b] : sides)
    if (!sides.count({b, a})) lower.emplace(a, static_cast<int>(mesh.vertices.rows() + lower.size()));
  std::vector<Eigen::Vector3d> vertices(lower.size());
  std::vector<Eigen::Vector3i> triangles;
  for (const auto& [a, below] : lower)
    vertices[below - mesh.vertices.rows()] = mesh.vertices.row(a) - Eigen::RowVector3d(0, 0, 0.1);
  for (const auto& [a, b] : sides)
    if (!sides.count({b, a})) {
      triangles.emplace_back(b, a, lower.at(a));
      triangles.emplace_back(b, lower.at(a), lower.at(b));
    }
  append(mesh, vertices, triangles);
  return mesh;
}

/// Displacements along the slope after so many steps of `advance` on a half-space.
Eigen::VectorXd moved(double degrees, const std::string& contact, int steps) {
  const double angle = degrees * M_PI / 180, h = std::sqrt(advance / (gravity * std::sin(angle)));
  char newton[200];
  std::snprintf(
      newton, sizeof newton,
      "force_tolerance: 1e-5, max_steps: %d, step_growth: 1, iterations_per_step: 5, step_size: %.17g", steps,
      h);
  const Solved s = solve_yaml(on_a_slope(angle, 0, contact, newton));
  CHECK(s.levels.back().outcome == Outcome::max_steps_reached);
  return (s.x() - s.scene->starts.back()).col(0);
}

}  // namespace

TEST_CASE("Without friction cloth slides over the rim of a slab and of a box") {
  const Scratch folder;
  int files = 0;
  for (const double degrees : {0.1, 0.3, 0.6}) {
    // The leading vertices come within d̂ of the rim, but not past it.
    const int before = static_cast<int>(0.9 * (rim - 0.05) / advance);
    const Eigen::VectorXd expected =
        moved(degrees, "shapes\nobstacles: [{name: floor, shape: half_space}]", before);
    for (const bool with_sides : {false, true})
      for (const double cell : {0.1, 0.03}) {
        INFO(degrees << " degrees, cells of " << cell << " m" << (with_sides ? ", a box" : ""));
        const auto file = folder / (std::to_string(files++) + ".ply");
        write_mesh(file, slab(cell, with_sides));
        const std::string contact = "ipc\nobstacles: [{name: floor, mesh: " + file.string() + "}]";
        const Eigen::VectorXd on_slab = moved(degrees, contact, before);
        CHECK((on_slab - expected).cwiseAbs().maxCoeff() < 0.01 * expected.mean());
        // The second row of vertices is 2 cm behind.
        const int after = before + 10;
        CHECK(moved(degrees, contact, after).minCoeff() > 0.99 * advance * after);
      }
  }
}

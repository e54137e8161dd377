// Every contact model of the project tells the gap of each element.

#include <algorithm>
#include <catch2/catch.hpp>

#include "core/kernel/interfaces/contact_model.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/registry.h"

using namespace drape;

namespace {

/// Two flat sheets of 4×4 vertices, one 0.02 m above the other.
Level two_sheets() {
  TriangleMesh mesh = grid({0.3, 0.3}, 4, 4, Diagonals::one_way);
  const Positions lower = mesh.vertices;
  const Triangles triangles = mesh.triangles;
  const auto n = static_cast<int>(lower.rows());
  mesh.vertices.resize(2 * n, 3);
  mesh.vertices << lower, lower.rowwise() + Eigen::RowVector3d(0.011, 0.013, 0.02);
  mesh.triangles.resize(2 * triangles.rows(), 3);
  mesh.triangles << triangles, triangles.array() + n;
  return Level::of(0, mesh);
}

void check_gaps(const std::string& config) {
  const Level level = two_sheets();
  // At rest the sheets are far enough apart not to count as close at rest.
  Positions x = level.rest.vertices;
  x.bottomRows(16).col(2).array() = 0.005;
  const auto bound = make_plugin_from<ContactModel>(config)->bind(level, Material());
  REQUIRE(bound);
  const auto candidates = bound->build_candidates(x, x);
  const auto collisions = candidates->build_collisions(x);
  std::vector<double> gaps;
  collisions->append_gaps(gaps);
  REQUIRE_FALSE(gaps.empty());
  CHECK(static_cast<Eigen::Index>(gaps.size()) == collisions->stencils().rows());
  CHECK(*std::min_element(gaps.begin(), gaps.end()) == collisions->smallest_gap());
}

}  // namespace

TEST_CASE("self-contact tells the gap of every pair") { check_gaps("{type: ipc, dhat: 0.01}"); }

TEST_CASE("shapes tell the gap of every element") {
  check_gaps(
      "{type: shapes, dhat: 0.01, obstacles: [{name: floor, shape: half_space, translate: [0, 0, -0.004], "
      "normal: [0, 0, 1]}]}");
}

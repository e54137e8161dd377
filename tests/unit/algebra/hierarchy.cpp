#include "core/numerics/hierarchy/hierarchy.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/numerics/hierarchy/midpoint.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/refusal.h"

using namespace drape;

namespace {

/// Pulls every vertex half-way to vertex 0, so that P and U differ.
struct Shrinking : Refiner {
  ProlongationMatrix weights(const Level& coarse) const override {
    const ProlongationMatrix midpoints = midpoint_weights(coarse);
    ProlongationMatrix first(midpoints.rows(), midpoints.cols());
    for (int v = 0; v < first.rows(); ++v) first.insert(v, 0) = 0.5;
    return 0.5 * midpoints + first;
  }
};

/// Midpoints with a fault.
struct Faulty : Refiner {
  explicit Faulty(void (*spoil)(ProlongationMatrix&)) : spoil(spoil) {}
  ProlongationMatrix weights(const Level& coarse) const override {
    ProlongationMatrix midpoints = midpoint_weights(coarse);
    spoil(midpoints);
    return midpoints;
  }
  void (*spoil)(ProlongationMatrix&);
};

}  // namespace

TEST_CASE("what a faulty refiner returns is refused before anything is computed from it", "[hierarchy]") {
  const auto refusal = [](void (*spoil)(ProlongationMatrix&)) {
    return refusal_of([&] { Hierarchy::of(grid({2, 1}, 4, 3, Diagonals::criss_cross), Faulty(spoil), 2); });
  };
  const std::string of_level = "the refiner's result for level 0: ";
  CHECK(refusal([](ProlongationMatrix&) {}).empty());
  CHECK_THAT(refusal([](ProlongationMatrix& p) { p.conservativeResize(p.rows() - 1, p.cols()); }),
             Catch::StartsWith(of_level + "weights of 34 × 12, not 35 × 12"));
  CHECK_THAT(refusal([](ProlongationMatrix& p) { p.conservativeResize(p.rows(), 20); }),
             Catch::StartsWith(of_level + "weights of 35 × 20"));
  CHECK_THAT(refusal([](ProlongationMatrix& p) { p *= 1.01; }),
             Catch::StartsWith(of_level + "row 0 of its weights sums to 1.01"));
  CHECK_THAT(refusal([](ProlongationMatrix& p) { p.coeffRef(5, 5) = std::nan(""); }),
             Catch::StartsWith(of_level + "row 5"));
  CHECK(refusal([](ProlongationMatrix&) { throw std::runtime_error("cannot refine"); }) ==
        "the refiner: cannot refine");
  CHECK(refusal([](ProlongationMatrix&) { throw "text"; }) ==
        "the refiner: an exception that is no std::exception");
}

TEST_CASE("a level is split into children of its vertices and edges", "[hierarchy]") {
  const Level coarse = Level::of(0, grid({2, 1}, 4, 3, Diagonals::criss_cross));
  const int n = coarse.vertex_count();
  const TriangleMesh mesh = refined_rest(coarse, midpoint_weights(coarse));
  const Triangles& fine = mesh.triangles;
  REQUIRE(fine.rows() == 4 * coarse.triangle_count());

  for (int t = 0; t < coarse.triangle_count(); ++t) {
    const auto e = coarse.topology.triangle_edges.row(t);
    for (int k = 0; k < 3; ++k) CHECK(fine(4 * t + k, k) == coarse.rest.triangles(t, k));
    CHECK(fine.row(4 * t + 3) == Eigen::RowVector3i(n + e[0], n + e[1], n + e[2]));
  }
  for (int v = 0; v < n; ++v) CHECK(mesh.vertices.row(v) == coarse.rest.vertices.row(v));
  for (int i = 0; i < coarse.topology.edges.rows(); ++i) {
    const auto ends = coarse.topology.edges.row(i);
    CHECK(mesh.vertices.row(n + i) ==
          0.5 * (coarse.rest.vertices.row(ends[0]) + coarse.rest.vertices.row(ends[1])));
  }
}

TEST_CASE("rest shapes and positions follow the same operators", "[hierarchy]") {
  const Hierarchy hierarchy = Hierarchy::of(grid({1, 2}, 4, 5, Diagonals::criss_cross), Shrinking(), 3);
  const Positions& coarsest = hierarchy.levels[0].rest.vertices;
  for (int l = 0; l < 3; ++l) {
    CHECK(hierarchy.levels[l].index == l);
    CHECK(hierarchy.prolong(coarsest, 0, l, hierarchy.prolongations) == hierarchy.levels[l].rest.vertices);
  }

  const Positions x = Positions::Random(hierarchy.levels[1].vertex_count(), 3);
  CHECK(hierarchy.prolong(x, 1, 1, hierarchy.prolongations) == x);
  CHECK(hierarchy.prolong(x, 1, 2, hierarchy.prolongations) == Positions(hierarchy.prolongations[1] * x));
  CHECK(hierarchy.midpoints[1].isApprox(midpoint_weights(hierarchy.levels[1])));
  CHECK_FALSE(hierarchy.midpoints[1].isApprox(hierarchy.prolongations[1]));
  CHECK(hierarchy.prolong(coarsest, 0, 2, hierarchy.midpoints) ==
        Positions(hierarchy.midpoints[1] * Positions(hierarchy.midpoints[0] * coarsest)));

  CHECK_THROWS_WITH(hierarchy.prolong(x, 1, 3, hierarchy.prolongations),
                    "prolong: levels 1 to 3 of a hierarchy of 3");
  CHECK_THROWS_WITH(hierarchy.prolong(x, 2, 1, hierarchy.prolongations),
                    "prolong: levels 2 to 1 of a hierarchy of 3");
  CHECK_THROWS_WITH(hierarchy.prolong(coarsest, 1, 2, hierarchy.prolongations),
                    "prolong: 20 positions for the 63 vertices of level 1");
}

TEST_CASE("a faulty coarsest mesh is refused", "[hierarchy]") {
  TriangleMesh mesh = grid({1, 1}, 3, 3, Diagonals::one_way);
  CHECK_THROWS_WITH(Hierarchy::of(mesh, Shrinking(), 0), "hierarchy: at least one level is needed");
  mesh.triangles.row(2) = mesh.triangles.row(2).reverse().eval();
  CHECK_THROWS_WITH(
      Hierarchy::of(mesh, Shrinking(), 2),
      Catch::StartsWith("rest shape of level 0: ") &&
          Catch::Contains(" in the same direction in both triangles: (1, 5) in triangles 2, 3"));
}

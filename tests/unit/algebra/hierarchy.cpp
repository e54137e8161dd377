#include "core/numerics/hierarchy/hierarchy.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/numerics/hierarchy/midpoint.h"
#include "core/numerics/hierarchy/rest_interpolation.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/random.h"
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

using Spoil = void (*)(ProlongationMatrix&);

/// Midpoints with a fault.
struct Faulty : Refiner {
  explicit Faulty(Spoil spoil) : spoil(spoil) {}
  ProlongationMatrix weights(const Level& coarse) const override {
    ProlongationMatrix midpoints = midpoint_weights(coarse);
    spoil(midpoints);
    return midpoints;
  }
  Spoil spoil;
};

}  // namespace

TEST_CASE("what a faulty refiner returns is refused before anything is computed from it") {
  const auto refusal = [](Spoil spoil) {
    return refusal_of([&] { Hierarchy::of(grid({2, 1}, 4, 3, Diagonals::criss_cross), Faulty(spoil), 2); });
  };
  CHECK(refusal([](ProlongationMatrix&) {}).empty());
  CHECK(refusal([](ProlongationMatrix&) { throw std::runtime_error("cannot refine"); }) ==
        "the refiner: cannot refine");
  CHECK(refusal([](ProlongationMatrix&) { throw "text"; }) ==
        "the refiner: an exception that is no std::exception");
  const std::vector<std::pair<Spoil, std::string>> faults = {
      {[](auto& p) { p.conservativeResize(p.rows() - 1, p.cols()); }, "weights of 34 × 12, not 35 × 12"},
      {[](auto& p) { p.conservativeResize(p.rows(), 20); }, "weights of 35 × 20"},
      {[](auto& p) { p *= 1.01; }, "row 0 of its weights sums to 1.01"},
      {[](auto& p) { p.coeffRef(5, 5) = std::nan(""); }, "row 5"}};
  for (const auto& [spoil, fault] : faults)
    CHECK_THAT(refusal(spoil), Catch::StartsWith("the refiner's result for level 0: " + fault));
}

TEST_CASE("a level is split into children of its vertices and edges") {
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
  const Positions& x = coarse.rest.vertices;
  const auto& edges = coarse.topology.edges;
  CHECK(mesh.vertices.topRows(n) == x);
  CHECK(mesh.vertices.bottomRows(edges.rows()) ==
        0.5 * (x(edges.col(0), Eigen::all) + x(edges.col(1), Eigen::all)));
}

TEST_CASE("rest shapes and positions follow the same operators") {
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
  CHECK_THROWS_WITH(hierarchy.prolong(x, 1, 3, hierarchy.prolongations),
                    "prolong: levels 1 to 3 of a hierarchy of 3");
  CHECK_THROWS_WITH(hierarchy.prolong(coarsest, 1, 2, hierarchy.prolongations),
                    "prolong: 20 positions for the 63 vertices of level 1");
}

TEST_CASE("a faulty coarsest mesh is refused") {
  TriangleMesh mesh = grid({1, 1}, 3, 3, Diagonals::one_way);
  CHECK_THROWS_WITH(Hierarchy::of(mesh, Shrinking(), 0), "hierarchy: at least one level is needed");
  mesh.triangles.row(2) = mesh.triangles.row(2).reverse().eval();
  CHECK_THROWS_WITH(
      Hierarchy::of(mesh, Shrinking(), 2),
      Catch::StartsWith("rest shape of level 0: ") &&
          Catch::Contains(" in the same direction in both triangles: (1, 5) in triangles 2, 3"));
}

TEST_CASE("interpolation by rest positions reproduces them, and is by midpoints for those that rest there") {
  const Level coarse = Level::of(0, random_triangulation({1, 0.7}, 60, 3));
  const ProlongationMatrix midpoints = midpoint_weights(coarse);
  const Positions rest = midpoints * coarse.rest.vertices, rounded = rest.array() * (1 + 1e-14);
  const Positions x = Positions::Random(coarse.vertex_count(), 3);
  for (const Positions& fine_rest : {rest, rounded})
    CHECK(Positions(rest_interpolation(coarse, fine_rest) * x) == Positions(midpoints * x));

  Positions moved = rest;  // in the sheet's plane by up to 1 cm, also outside the border
  RandomNumbers random(5);
  for (auto vertex : moved.rowwise())
    vertex += Eigen::RowVector3d(random(-0.01, 0.01), random(-0.01, 0.01), 0);
  CHECK((moved - rest).cwiseAbs().maxCoeff() > 0.005);
  const ProlongationMatrix linear = rest_interpolation(coarse, moved);
  CHECK((linear * coarse.rest.vertices - moved).cwiseAbs().maxCoeff() <= 1e-14);
  const Eigen::VectorXd sums = linear * Eigen::VectorXd::Ones(coarse.vertex_count());
  CHECK((sums.array() - 1).abs().maxCoeff() <= 1e-15);
}

TEST_CASE("a vertex follows the triangle that contains its rest position, or its projection") {
  const Level coarse = Level::of(0, grid({1, 1}, 2, 2, Diagonals::one_way));
  const auto corner = coarse.rest.triangles.row(1);
  const auto inside = [&](const Positions& p) -> Eigen::RowVector3d {
    return 0.2 * p.row(corner[0]) + 0.3 * p.row(corner[1]) + 0.5 * p.row(corner[2]);
  };
  Positions rest = midpoint_weights(coarse) * coarse.rest.vertices;
  rest.row(corner[0]) = inside(coarse.rest.vertices);
  const Positions x = Positions::Random(4, 3), fine = rest_interpolation(coarse, rest) * x;
  CHECK((fine.row(corner[0]) - inside(x)).norm() <= 1e-15);
  rest(corner[0], 2) += 0.05;  // above a bent rest shape
  CHECK((rest_interpolation(coarse, rest) * x - fine).norm() <= 1e-15);
}

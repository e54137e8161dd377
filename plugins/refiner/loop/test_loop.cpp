#include <catch2/catch.hpp>

#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/meshes.h"
#include "tests/support/unregistered.h"
// After it:
#include "plugins/refiner/loop/loop.cpp"

using namespace drape;
using Row = std::map<int, double>;

namespace {

const LoopRefiner loop;

Row row(const ProlongationMatrix& weights, int i) {
  Row entries;
  for (ProlongationMatrix::InnerIterator it(weights, i); it; ++it)
    entries[static_cast<int>(it.col())] = it.value();
  return entries;
}

/// The row of the vertex on the edge from a to b.
Row edge_row(const Level& level, const ProlongationMatrix& weights, int a, int b) {
  for (int e = 0; e < level.topology.edges.rows(); ++e)
    if (level.topology.edges.row(e) == Eigen::RowVector2i(std::min(a, b), std::max(a, b)))
      return row(weights, level.vertex_count() + e);
  FAIL("no such edge");
  return {};
}

}  // namespace

TEST_CASE("Loop stencils of a regular grid") {
  // 12 13 14 15
  //  8  9 10 11   cells cut like '/'
  //  4  5  6  7
  //  0  1  2  3
  const Level level = Level::of(0, grid({1, 1}, 4, 4, Diagonals::one_way));
  const ProlongationMatrix fine = loop.weights(level);
  CHECK(
      row(fine, 5) ==
      Row{{5, 5. / 8}, {0, 1. / 16}, {1, 1. / 16}, {4, 1. / 16}, {6, 1. / 16}, {9, 1. / 16}, {10, 1. / 16}});
  CHECK(row(fine, 1) == Row{{0, 1. / 8}, {1, 3. / 4}, {2, 1. / 8}});
  CHECK(row(fine, 8) == Row{{4, 1. / 8}, {8, 3. / 4}, {12, 1. / 8}});
  for (int corner : {0, 3, 12, 15}) CHECK(row(fine, corner) == Row{{corner, 1}});
  const auto edge = [&](int a, int b) { return edge_row(level, fine, a, b); };
  CHECK(edge(5, 10) == Row{{5, 3. / 8}, {10, 3. / 8}, {6, 1. / 8}, {9, 1. / 8}});
  CHECK(edge(5, 1) == Row{{5, 3. / 8}, {1, 3. / 8}, {0, 1. / 8}, {6, 1. / 8}});
  CHECK(edge(2, 3) == Row{{2, 1. / 2}, {3, 1. / 2}});
}

TEST_CASE("Loop stencils of irregular vertices are Warren's") {
  const auto [valence, beta] =
      GENERATE(table<int, double>({{3, 3. / 16}, {4, 3. / 32}, {5, 3. / 40}, {6, 1. / 16}, {7, 3. / 56}}));
  const ProlongationMatrix fine = loop.weights(Level::of(0, wheel(valence)));
  const Row centre = row(fine, 0);
  REQUIRE(centre.size() == static_cast<std::size_t>(valence + 1));
  CHECK(centre.at(0) == Approx(1 - valence * beta).epsilon(1e-15));
  for (int u = 1; u <= valence; ++u) CHECK(centre.at(u) == Approx(beta).epsilon(1e-15));
}

TEST_CASE("corners are told by the rest angle") {
  // A wheel of k spokes turns by 360°/k at each border vertex.
  const auto [spokes, angle, corner] = GENERATE(table<int, double, bool>(
      {{11, 30, true}, {13, 30, false}, {4, 30, true}, {4, 91, false}, {11, 33, false}, {360, 0.5, true}}));
  LoopRefiner refiner;
  refiner.corner_angle = angle;
  const Level level = Level::of(0, wheel(spokes));
  const std::vector<char> corners = refiner.corners(level);
  CHECK_FALSE(corners[0]);
  for (int v = 1; v <= spokes; ++v) CHECK(static_cast<bool>(corners[v]) == corner);
  CHECK(row(refiner.weights(level), 1).size() == (corner ? 1 : 3));
}

TEST_CASE("corners stay on every level, reentrant ones too, and straight borders with them") {
  const Polygon hook{{0, 0}, {1, 0}, {1, .4}, {.4, .4}, {.4, 1}, {0, 1}};
  // The last row of an equilateral rectangle is one with half triangles, or not.
  for (const auto& [mesh, corners, area] : {std::tuple(delaunay_polygon({hook}, 120, 0), 6, 0.64),
                                            std::tuple(equilateral({0.7, 0.6}, 8, 8), 4, 0.42),
                                            std::tuple(equilateral({0.7, 0.6}, 8, 9), 4, 0.42)}) {
    const Hierarchy hierarchy = Hierarchy::of(mesh, loop, 3);
    for (const Level& level : hierarchy.levels) {
      const std::vector<char> corner = loop.corners(level);
      CHECK(std::count(corner.begin(), corner.end(), 1) == corners);
      for (int v = 0; v < level.vertex_count(); ++v) {
        const auto p = level.rest.vertices.row(v);
        if (corner[v] && corners == 4) CHECK(((p.x() == 0 || p.x() == 0.7) && (p.y() == 0 || p.y() == 0.6)));
      }
      CHECK(level.vertex_area.sum() == Approx(area).epsilon(1e-12));
    }
  }
}

TEST_CASE("Loop keeps the rectangle of a criss-cross grid but moves its vertices") {
  const Hierarchy hierarchy = Hierarchy::of(grid({0.7, 1.9}, 6, 8, Diagonals::criss_cross), loop, 3);
  for (const Level& level : hierarchy.levels) {
    for (int v = 0; v < level.vertex_count(); ++v) {
      const auto p = level.rest.vertices.row(v);
      const double to_side = std::min({p.x(), 0.7 - p.x(), p.y(), 1.9 - p.y()});
      CHECK((level.topology.on_border[v] ? std::abs(to_side) < 1e-15 : to_side > 0.01));
    }
  }
  const Positions midpoint = hierarchy.midpoints[0] * hierarchy.levels[0].rest.vertices;
  CHECK((midpoint - hierarchy.levels[1].rest.vertices).cwiseAbs().maxCoeff() > 0.01);
}

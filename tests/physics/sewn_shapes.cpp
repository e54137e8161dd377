// Cloth of flat pieces rests as the surface in space that they make when they are sewn.

#include <cmath>

#include "core/numerics/elements/dihedral_angle.h"
#include "core/numerics/elements/rest_hinge.h"
#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/faceted.h"
#include "tests/support/sewn.h"

using namespace drape;

namespace {

/// The levels of a mesh by edge midpoints.
std::vector<Level> three_levels(const TriangleMesh& mesh) {
  return Hierarchy::of(mesh, *make_plugin_from<Refiner>("midpoint"), 3).levels;
}

}  // namespace

TEST_CASE("A tube of strips that are sewn along their sides is the prism in space, on every level") {
  constexpr int n = 9;
  const TriangleMesh prism = faceted(n, {{0.1, 0}, {0.1, 0.07}, {0.1, 0.1}, {0.1, 0.19}});
  const std::vector<Level> space = three_levels(prism),
                           sewn = three_levels(as_facets(prism, n, 2 * M_PI / n));
  for (int l = 0; l < 3; ++l) {
    CHECK((space[l].vertex_area - sewn[l].vertex_area).norm() < 1e-13 * space[l].vertex_area.norm());
    for (const auto* energies : {&sewn_membranes, &bending})
      for (const std::string& energy : *energies) {
        INFO(energy << ", level " << l);
        CHECK(energy_difference(energy, space[l], sewn[l]) < 1e-12);
      }
  }
}

TEST_CASE(
    "A rectangle that is rolled up and sewn along one side has the prism's sewn_membranes, and rests flat") {
  constexpr int n = 8;
  TriangleMesh prism = faceted(n, {{0.1, 0}, {0.1, 0.1}, {0.1, 0.2}});
  TriangleMesh rolled = prism;
  rolled.uv.resize(prism.triangles.rows(), 6);
  const double side = 0.2 * std::sin(M_PI / n);
  for (Eigen::Index t = 0; t < rolled.uv.rows(); ++t) {
    const auto v = rolled.triangles.row(t);
    bool begins = false, ends = false;
    for (const int own : v) begins = begins || own % n == 0, ends = ends || own % n == n - 1;
    const bool last = begins && ends;
    for (int k = 0; k < 3; ++k)
      rolled.uv.block<1, 2>(t, 2 * k) << side * (last && v[k] % n == 0 ? n : v[k] % n),
          prism.vertices(v[k], 2);
  }
  rolled.sewing = Sewing{};
  const std::vector<Level> space = three_levels(prism), sewn = three_levels(rolled);
  for (int l = 0; l < 3; ++l) {
    for (const std::string& energy : sewn_membranes)
      CHECK(energy_difference(energy, space[l], sewn[l]) < 1e-12);
    for (Eigen::Index h = 0; h < sewn[l].hinges.rows(); ++h)
      CHECK(std::abs(DihedralAngle<double>(rest_vectors(sewn[l], h).data()).angle()) < 1e-15);
  }
}

TEST_CASE("A disc of two halves is the disc, wherever the halves lie and however they are turned") {
  const TriangleMesh whole = disc(0.2, 90);
  TriangleMesh halves = as_piece(whole);
  const std::vector<char> left = left_half(whole);
  const auto [degrees, mirrored] = GENERATE(table<double, bool>({{0, false}, {35, false}, {200, true}}));
  place_piece(halves, left, degrees, mirrored, {0.7, -3});
  const std::vector<Level> space = three_levels(whole), sewn = three_levels(halves);
  for (int l = 0; l < 3; ++l)
    for (const auto* energies : {&sewn_membranes, &bending})
      for (const std::string& energy : *energies) {
        INFO(energy << ", level " << l);
        CHECK(energy_difference(energy, space[l], sewn[l]) < 1e-12);
      }
  CHECK(energy_difference("quadratic_bending", space[1], sewn[1]) < 1e-12);
  // In millimetres.
  halves.uv *= 1000;
  halves.sewing->uv_length = 1e-3;
  CHECK(energy_difference("stvk", sewn[0], Level::of(0, halves)) < 1e-12);
  CHECK(energy_difference("hinge", sewn[0], Level::of(0, halves)) < 1e-12);
}

TEST_CASE("A cushion of two squares that share their texture coordinates is the square folded flat") {
  constexpr int n = 6;
  const TriangleMesh front = grid({0.3, 0.3}, n, n, Diagonals::one_way);
  TriangleMesh cushion = front;
  std::vector<int> back(n * n);
  int count = n * n;
  for (int v = 0; v < n * n; ++v) {
    const int column = v % n, row = v / n;
    const bool border = column == 0 || row == 0 || column == n - 1 || row == n - 1;
    back[v] = border ? v : count++;
  }
  cushion.vertices.conservativeResize(count, 3);
  for (int v = 0; v < n * n; ++v) cushion.vertices.row(back[v]) = front.vertices.row(v);
  const Eigen::Index m = front.triangles.rows();
  cushion.triangles.conservativeResize(2 * m, 3);
  for (Eigen::Index t = 0; t < m; ++t)
    for (int k = 0; k < 3; ++k) {  // mirrored, so that no triangle has the vertices of a front one
      const int v = front.triangles(t, k);
      cushion.triangles(m + t, k) = back[v / n * n + n - 1 - v % n];
    }
  TriangleMesh sewn = as_piece(cushion);
  sewn.sewing->seam_angle = M_PI;
  const std::vector<Level> space = three_levels(cushion), pieces = three_levels(sewn);
  for (int l = 0; l < 3; ++l)
    for (const auto* energies : {&sewn_membranes, &bending})
      for (const std::string& energy : *energies) {
        INFO(energy << ", level " << l);
        CHECK(energy_difference(energy, space[l], pieces[l]) < 1e-12);
      }
}

TEST_CASE("The apex of a disc without a sector has the sector's angle as its defect, sewn or in space") {
  constexpr int n = 24;
  const double removed = GENERATE(0.3, 1.0, 2.5);
  const TriangleMesh cone = faceted_cone(n, removed, 0.05), dart = as_sector(cone, n, removed, 0.05);
  const Level space = Level::of(0, cone), sewn = Level::of(0, dart);
  for (const Level* level : {&space, &sewn}) {
    double around = 0;
    for (const int t : level->topology.vertex_triangles.row(0)) {
      const Eigen::Matrix3d x = rest_corners(level->rest, t);
      const Eigen::Vector3d a = x.col(1) - x.col(0), b = x.col(2) - x.col(0);
      around += std::atan2(a.cross(b).norm(), a.dot(b));
    }
    CHECK(std::abs(2 * M_PI - around - removed) < 1e-12);
  }
  for (const std::string& energy : sewn_membranes) CHECK(energy_difference(energy, space, sewn) < 1e-11);
  // With the cone's own angle at each of its edges it bends as the cone in space does.
  const int edge = static_cast<int>(
      std::ranges::find_if(space.hinge_edges, [&](int e) { return space.topology.edges(e, 0) == 0; }) -
      space.hinge_edges.begin());
  const double fold = DihedralAngle<double>(rest_vectors(space, edge).data()).angle();
  REQUIRE(std::abs(fold) > 0.01);
  const Level facets = Level::of(0, as_facets(cone, n, fold));
  for (const std::string& energy : bending) CHECK(energy_difference(energy, space, facets) < 1e-11);
}

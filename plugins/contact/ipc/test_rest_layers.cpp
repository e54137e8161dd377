#include <catch2/catch.hpp>

#include "core/numerics/contact_forces/barrier.h"
#include "core/numerics/model/required.h"
#include "core/numerics/patterns/generate.h"
#include "plugins/contact/ipc/ipc.h"
#include "tests/support/evaluate.h"
#include "tests/support/meshes.h"

using namespace drape;
using namespace drape::ipc;

namespace {

constexpr double stiffness = 7, dhat = 1e-3;

std::unique_ptr<BoundContact> bound(const Level& level) {
  Ipc::Parameters p;
  p.stiffness = stiffness;
  p.dhat = dhat;
  return Ipc(p).bind(level, Material());
}

/// Two sheets of this side, one `gap` above the other, that nothing connects.
Level two_sheets(double gap, int columns, double side = 0.1) {
  const TriangleMesh sheet = grid({side, side}, columns, columns, Diagonals::one_way);
  return Level::of(0, both_of(sheet, sheet, {0, 0, gap}));
}

/// The upper sheet moved to `gap` above the lower one.
Positions with_gap(const Level& sheets, double gap) {
  Positions x = sheets.rest.vertices;
  x.bottomRows(x.rows() / 2).col(2).setConstant(gap);
  return x;
}

/// A book of two leaves, one of them turned up about the spine by this angle.
TriangleMesh book(int columns, double side, double angle) {
  TriangleMesh mesh = grid({2 * side, side}, 2 * columns - 1, columns, Diagonals::one_way);
  for (auto v : mesh.vertices.rowwise()) {
    const double out = v[0] - side;
    v[0] = out > 0 ? std::cos(angle) * out : -out;
    v[2] = out > 0 ? std::sin(angle) * out : 0;
  }
  return mesh;
}

}  // namespace

TEST_CASE("ipc: layers that are near at rest are in equilibrium there, and resist below that gap") {
  for (const int columns : {4, 21})
    for (const double gap : {0.9e-3, 0.5e-3, 0.3e-3}) {
      const Level sheets = two_sheets(gap, columns);
      const auto contact = bound(sheets);
      CHECK(collisions_at(*contact, sheets.rest.vertices)->value(sheets.rest.vertices) == 0);
      const Positions x = with_gap(sheets, gap / 2);
      const auto set = collisions_at(*contact, x);
      CHECK(set->smallest_gap() == Approx(gap / 2));
      const Positions g = gradient_of(*set, x);
      const double lift = -g.bottomRows(g.rows() / 2).col(2).sum(),
                   pressure = -stiffness * barrier(0.5).first;
      CAPTURE(columns, gap, lift / (pressure * 0.01));
      // Vertices lie above vertices, where up to six triangles each count, and edges above edges.
      CHECK(lift >= pressure * 0.01);
      CHECK(lift <= 8 * pressure * 0.01);
      CHECK(contact->remark().empty());
    }
}

TEST_CASE("ipc: layers that touch at rest are pushed apart by up to a quarter of dhat") {
  const Level sheets = two_sheets(0, 6);
  const auto contact = bound(sheets);
  for (const double gap : {1e-6, 0.24e-3, 0.26e-3})
    CHECK((collisions_at(*contact, with_gap(sheets, gap))->contact_count() > 0) == (gap < dhat / 4));
}

TEST_CASE("ipc: the leaves of a book that is shut at rest have a barrier, but for its spine") {
  const std::pair<int, double> books[] = {{5, 0.1}, {21, 0.1}, {41, 0.02}};  // edges of 25, 5 and 0.5 mm
  for (const auto& [columns, side] : books) {
    CAPTURE(columns);
    const Level shut = Level::of(0, book(columns, side, 0));
    const auto contact = bound(shut);
    const Positions x = book(columns, side, 2e-4 / side).vertices;
    const Positions g = gradient_of(*collisions_at(*contact, x), x);
    REQUIRE(g.norm() > 0);
    for (int v = 0; v < x.rows(); ++v) {
      // Two millimetres around the spine are one neighbourhood; elsewhere the leaves push each other apart.
      if (shut.rest.vertices(v, 0) > 0.01 && x(v, 2) > 0) CHECK(g(v, 2) < 0);
      if (shut.rest.vertices(v, 0) < 1e-3) CHECK(g.row(v).norm() < 2e-2 * g.rowwise().norm().maxCoeff());
    }
    CHECK(contact->remark().empty() == (side == 0.1));
  }
}

TEST_CASE("ipc: neighbours along the cloth have no barrier, and the model's remark says so") {
  const auto contacts = [](const Level& level) {
    return collisions_at(*bound(level), level.rest.vertices)->contact_count();
  };
  const Level fine = Level::of(0, grid({0.02, 0.02}, 41, 41, Diagonals::criss_cross));  // edges of half of d̂
  CHECK(contacts(fine) == 0);
  CHECK_THAT(bound(fine)->remark(), Catch::Contains("have no barrier") && Catch::Contains("0.001 m"));
  // Slivers whose long edges are far above d̂.
  CHECK(contacts(
            Level::of(0, mesh_of({{0, 0, 0}, {0.1, 0, 0}, {0.05, 3e-4, 0}, {0.05, 0.1, 0}, {0.05, -3e-4, 0}},
                                 {{0, 1, 2}, {0, 2, 3}, {2, 1, 3}, {1, 0, 4}}))) == 0);
}

TEST_CASE("ipc: layers of a cloth that is smaller than dhat have a barrier, and neighbours have none") {
  const Level sheets = two_sheets(0.5e-3, 6, 1e-3);
  const auto contact = bound(sheets);
  const auto forces = [&](const Positions& x) { return gradient_of(*collisions_at(*contact, x), x); };
  const Positions g = forces(with_gap(sheets, 0.2e-3));
  CHECK(forces(sheets.rest.vertices).cwiseAbs().maxCoeff() < 1e-9 * g.cwiseAbs().maxCoeff());
  CHECK((g.col(2).head(g.rows() / 2).array() > 0).all());
  CHECK((g.col(2).tail(g.rows() / 2).array() < 0).all());
}

TEST_CASE("ipc: two edges have not the gap at rest of a vertex and a triangle of the same four vertices") {
  // Vertex 0 lies half of d̂ above the triangle 1, 2, 3; edge 0-1 is far from edge 2-3.
  const Level level = Level::of(
      0, mesh_of({{0.05, 0, 0.5e-3}, {0, 0, 0}, {0.1, -0.05, 0}, {0.1, 0.05, 0}, {0.05, 0.05, 0.05}},
                 {{0, 1, 4}, {4, 1, 3}, {1, 2, 3}}));
  const auto contact = bound(level);
  Positions x = level.rest.vertices;
  CHECK(collisions_at(*contact, x)->value(x) == 0);
  x.row(0) << 0.12, 0, 0.96e-3;  // edge 0-1 passes 0.8 d̂ above edge 2-3
  const auto set = collisions_at(*contact, x);
  CHECK(set->contact_count() == 1);
  CHECK(set->smallest_gap() == Approx(0.8e-3).epsilon(1e-3));
}

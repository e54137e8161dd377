#include "core/numerics/model/lone_pins.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/numerics/hierarchy/hierarchy.h"
#include "tests/support/equilibrium.h"
#include "tests/support/strip.h"

using namespace drape;

namespace {

/// A square that hangs in its own plane from the vertex next to a point of it.
struct HungSquare {
  Hierarchy hierarchy;
  int held;  ///< vertex of every level

  HungSquare(const TriangleMesh& mesh, int levels, const Eigen::RowVector2d& near)
      : hierarchy(Hierarchy::of(mesh, *make_plugin_from<Refiner>("midpoint"), levels)) {
    (mesh.vertices.leftCols<2>().rowwise() - near).rowwise().squaredNorm().minCoeff(&held);
  }

  /// Towards the centre of mass, so that nothing turns.
  Eigen::RowVector3d down() const {
    const Level& level = hierarchy.levels.front();
    return (level.vertex_area.transpose() * level.rest.vertices / level.vertex_area.sum() -
            level.rest.vertices.row(held))
        .normalized();
  }

  LevelModel model(int index) const {
    const Level& level = hierarchy.levels[index];
    Material m;
    m.poisson_ratio = 0.3;
    m.bending_modulus = 1e7;  // so that no compression buckles
    m.density = 1;            // strains of a thousandth at the pin
    const std::string gravity = "{type: gravity, acceleration: " + text(Eigen::Vector3d(down())) + "}";
    const std::vector<NamedEnergy> energies = named_energies({"neo_hookean", "hinge", gravity});
    return {level, m, energies, {{held, level.rest.vertices.row(held).transpose()}}};
  }

  /// Mean displacement along gravity at rest [m].
  double sag(const LevelModel& model) const {
    const Positions& rest = model.level().rest.vertices;
    const Eigen::VectorXd& area = model.level().vertex_area;
    return area.dot((equilibrium_of(model, rest, 1e-6) - rest) * down().transpose()) / area.sum();
  }
};

}  // namespace

TEST_CASE("A coarse cloth hangs from a lone pin as low as the finest one", "[physics]") {
  row("\nMean sag of a square that hangs in its plane from one vertex, coarse over finest, edges h and "
      "h/2^k");
  row("%12s %14s %4s %8s %11s", "cells", "held at", "k", "plain", "effective");
  for (const std::string& cells : all_triangulations)
    for (const auto& [where, near] :
         {std::pair("corner", Eigen::RowVector2d(0, 0)), std::pair("other corner", Eigen::RowVector2d(1, 0)),
          std::pair("side", Eigen::RowVector2d(0.5, 0)), std::pair("inside", Eigen::RowVector2d(0.25, 0.25))})
      for (const int k : {1, 2, 3}) {
        const HungSquare square(triangulated(cells, {1, 1}, 0.125), k + 1, near);
        const LevelModel coarse = square.model(0), finest = square.model(k);
        const std::vector<int> lone =
            lone_pins(coarse, [&] { return std::make_shared<const LevelModel>(finest); });
        REQUIRE(lone.size() == 1);
        const double sag = square.sag(finest), plain = square.sag(coarse) / sag,
                     effective = square.sag(coarse.with_effective_membranes(k, lone)) / sag;
        row("%12s %14s %4d %8.3f %11.3f", cells.c_str(), where, k, plain, effective);
        INFO(cells << ", " << where << ", " << k);
        // Inside a one-way grid the stiffness depends on the direction, and its mean is taken.
        CHECK(std::abs(effective - 1) < (std::string(where) == "inside" ? 0.15 : 0.06));
        CHECK(plain < 0.85);
      }
}

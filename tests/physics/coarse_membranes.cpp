// Membranes of coarse levels: they buckle below the mesh, and are softer around lone pins.

#include "core/numerics/hierarchy/fineness.h"
#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/model/lone_pins.h"
#include "core/numerics/patterns/delaunay.h"
#include "core/numerics/solve/newton.h"
#include "tests/support/meshes.h"
#include "tests/support/sewn.h"
#include "tests/support/strip.h"

using namespace drape;

namespace {

/// A model of these energies, each by its YAML, which is its name too.
LevelModel model_of(const Level& level, const Material& material, const std::vector<std::string>& all,
                    const std::vector<DirichletVertex>& pins = {}) {
  std::vector<NamedEnergy> energies;
  for (const std::string& yaml : all) energies.push_back({yaml, make_plugin_from<Energy>(yaml)});
  return {level, material, energies, pins};
}

/// The model's equilibrium from a start (n×3) [m], by plain Newton steps of this size [s] down to this force
/// residual; the test ends if there is none.
Positions equilibrium_of(const LevelModel& model, Positions start, double force_tolerance,
                         double step_size = NewtonParameters().step_size) {
  PlainObjective objective(model);
  Observer silent;
  model.set_dirichlet(start);
  const LevelResult result = minimise(
      objective, start, {.step_size = step_size, .force_tolerance = force_tolerance}, {Stopwatch(), silent});
  INFO(result.message);
  REQUIRE(has_converged(result.outcome));
  return result.x;
}

constexpr double edge = 0.05;    // of the coarse level [m]
constexpr int levels_below = 3;  // of the finest level

/// Cloth that buckles at a strain of 2.5e-4 between clamps one coarse edge apart.
const Material fabric = [] {
  Material m;
  m.thickness = 0.005 * edge;
  m.membrane_modulus = m.bending_modulus = 1e6;
  m.poisson_ratio = 0;
  return m;
}();

/// D of the hinge energy on a grid [J].
const double plate_stiffness = fabric.bending_modulus * std::pow(fabric.thickness, 3) / 4;

/// The force per width [N/m] at which a plate of this stiffness buckles between clamps an edge h apart, less
/// what the finest level still resists.
double buckling_force(double stiffness, double h) {
  return 4 * M_PI * M_PI * stiffness / (h * h * (1 - std::pow(4.0, -levels_below)));
}

/// A level's vertices for whose rest place held(x) holds, at their places in `x`, in the plane.
template <class Held>
std::vector<DirichletVertex> clamped_at(const Level& level, const Positions& x, const Held& held) {
  std::vector<DirichletVertex> clamped;
  for (int i = 0; i < level.vertex_count(); ++i)
    if (held(level.rest.vertices(i, 0))) clamped.push_back({i, Eigen::Vector3d(x(i, 0), x(i, 1), 0)});
  return clamped;
}

/// A strip of `cells` coarse cells between clamps, which are a cell wide at either end.
struct CompressedStrip {
  int cells;
  double strain, width = 2 * edge;
  Hierarchy hierarchy = Hierarchy::of(grid({(cells + 2) * edge, width}, cells + 3, 3, Diagonals::criss_cross),
                                      *make_plugin_from<Refiner>("midpoint"), levels_below + 1);

  double length() const { return cells * edge; }
  /// Energy of the buckled strip by Euler's load of a column with clamped ends [J].
  double euler() const { return 4 * M_PI * M_PI * plate_stiffness / length() * strain * width; }

  /// The right clamp moved to the left, and a wave in between.
  Positions start(const Level& level) const {
    Positions x = level.rest.vertices;
    const double height = 2 * length() * std::sqrt(strain) / M_PI;
    for (auto v : x.rowwise()) {
      const double along = std::clamp(v[0] - edge, 0.0, length());
      v[0] -= strain * along;
      v[2] = height * std::pow(std::sin(M_PI * along / length()), 2);
    }
    return x;
  }

  LevelModel model(int index, const std::string& membrane) const {
    const Level& level = hierarchy.levels[index];
    const auto clamped = clamped_at(level, start(level),
                                    [&](double x) { return x - edge < 1e-9 || x - edge > length() - 1e-9; });
    return model_of(level, fabric, {membrane, "hinge"}, clamped);
  }

  /// Energy at rest over Euler's.
  double solved(const LevelModel& model) const {
    return model.value(equilibrium_of(model, start(model.level()), 1e-5, 0.01)) / euler();
  }
};

/// Random panels of an edge by eight, with sides of h/8, three side by side and sewn to each other: so that
/// no coarse vertex lies between clamps that are an edge apart.
TriangleMesh random_panels(unsigned seed) {
  const Eigen::Vector2d size(edge, 8 * edge);
  const double vertices = OutlineSize::of(grid(size, 2, 2, Diagonals::one_way)).vertices(edge / 8);
  std::vector<Eigen::Vector3d> places;
  std::vector<Eigen::Vector3i> triangles;
  CornerUv uv(0, 6);
  for (int p = 0; p < 3; ++p) {
    TriangleMesh own = as_piece(random_triangulation(size, static_cast<int>(vertices), 3 * seed + p));
    place_piece(own, std::vector<char>(own.triangles.rows(), 1), 0, false, {2 * p * edge, 0});
    std::vector<int> number;
    for (const auto& x : own.vertices.rowwise()) {
      const Eigen::Vector3d place = x.transpose() + Eigen::Vector3d(p * edge, 0, 0);
      const auto same =
          std::ranges::find_if(places, [&](const auto& other) { return (other - place).norm() < 1e-9; });
      number.push_back(static_cast<int>(same - places.begin()));
      if (same == places.end()) places.push_back(place);
    }
    for (const auto& t : own.triangles.rowwise())
      triangles.emplace_back(number[t[0]], number[t[1]], number[t[2]]);
    uv = (CornerUv(uv.rows() + own.uv.rows(), 6) << uv, own.uv).finished();
  }
  TriangleMesh all = mesh_of(places, triangles);
  all.uv = uv;
  all.sewing = Sewing{};
  return all;
}

}  // namespace

TEST_CASE("A coarse strip between clamps has about the energy of the buckled cloth") {
  table("Energy of a strip compressed by 5 % between clamps, over Euler's; coarse edges h, finest h/8",
        "membrane", "length/h", "finest", "coarse, plain", "buckling");
  for (const std::string membrane : {"neo_hookean", "stvk"})
    for (const int cells : {1, 2, 4, 8, 16}) {
      const CompressedStrip strip{cells, 0.05};
      const LevelModel plain = strip.model(0, membrane);
      const double finest = strip.solved(strip.model(levels_below, membrane)), coarse = strip.solved(plain),
                   buckling = strip.solved(plain.with_effective_membranes(levels_below));
      row(membrane, cells, finest, coarse, buckling);
      // Hinges bend over half a cell on either side, so a strip with clamps is longer by a cell: 1/8 of h on
      // the finest level and h on the coarse one, which halves the load of short strips that buckle there.
      CHECK(finest == Approx(std::pow(cells / (cells + 0.125), 2)).epsilon(0.1));
      CHECK(buckling <= coarse * (1 + 1e-9));
      CHECK(buckling < 4 * finest);
      CHECK(buckling > 0.25 * finest);
      if (cells == 1) CHECK(coarse > 50 * finest);
    }
}

TEST_CASE("A strip of one coarse edge has about the energy of the buckled cloth on random meshes, too") {
  table("The same of 8 h of cloth between seams that are h apart, coarsened from random meshes", "seed",
        "vertices", "finest", "coarse, plain", "buckling");
  std::vector<double> found;
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u}) {
    const CompressedStrip strip{
        1, 0.05, 8 * edge,
        Hierarchy::of(random_panels(seed), *make_plugin_from<Refiner>("coarsen"), 1, levels_below)};
    const Level& level = strip.hierarchy.levels[0];
    const Fineness fineness = Fineness::of(strip.hierarchy, 0);
    const LevelModel plain = strip.model(0, "neo_hookean");
    const double finest = strip.solved(strip.model(levels_below, "neo_hookean")),
                 coarse = strip.solved(plain),
                 buckling =
                     strip.solved(plain.with_effective_membranes(fineness).with_local_folds(fineness, false));
    row(seed, level.vertex_count(), finest, coarse, buckling);
    CHECK(buckling < 3);
    CHECK(coarse > 20 * finest);
  }
}

TEST_CASE("A strip that hangs or bends under its weight is the same with a membrane that buckles") {
  // Heavy and soft enough to stretch and to bend visibly, with a compressive stress below the bound.
  const Level level = Level::of(0, grid({0.4, 0.1}, 9, 3, Diagonals::criss_cross));
  const Positions& rest = level.rest.vertices;
  Material m = fabric;
  m.density = 1000;
  m.bending_modulus = 1e8;
  for (const bool hangs : {true, false}) {
    const LevelModel plain = model_of(
        level, m, {"neo_hookean", "hinge", hangs ? "{type: gravity, acceleration: [9.81, 0, 0]}" : "gravity"},
        clamped_at(level, rest, [&](double x) { return x < (hangs ? 1e-9 : 0.051); }));
    const Positions expected = equilibrium_of(plain, rest, 1e-8),
                    found = equilibrium_of(plain.with_effective_membranes(2), rest, 1e-8);
    const double moved = (expected - rest).rowwise().norm().maxCoeff(),
                 difference = (found - expected).rowwise().norm().maxCoeff();
    row(hangs ? "Hanging strip" : "Cantilever", "moves by [m]", moved, "difference", difference);
    CHECK(moved > 1e-4);
    CHECK(difference < 1e-4 * moved);
  }
}

TEST_CASE("The membrane energy of a rolled sheet falls with h as of chords, up to the bound") {
  constexpr double radius = 0.03, side = 0.1, remainder = 0.01;
  table("Membrane energy of a sheet rolled to a radius of 30 mm, per area [J/m²]", "h [m]", "plain",
        "E d e²/2", "buckling", "s e/area");
  double last = std::numeric_limits<double>::infinity();
  for (const int cells : {2, 4, 8, 16, 32, 64}) {
    const double h = side / cells;
    const Level level = Level::of(0, grid({side, side}, cells + 1, cells + 1, Diagonals::criss_cross));
    const Positions x = rolled(level.rest.vertices, radius);
    const double chord = 2 * radius * std::sin(h / (2 * radius)) / h, strain = (1 - chord * chord) / 2;
    const double stiffness = fabric.membrane_modulus * fabric.thickness;
    const double bound = std::min(buckling_force(plate_stiffness, h), stiffness * strain);
    const auto density = [&](const LevelModel& model) {
      return model.value(x, Roles{EnergyRole::membrane}) / (side * side);
    };
    const LevelModel model = model_of(level, fabric, {"stvk", "hinge"});
    const double plain = density(model), buckling = density(model.with_effective_membranes(levels_below));
    const double elastic = stiffness * strain * strain / 2,
                 wrinkled = bound * strain - bound * bound / (2 * stiffness);
    row(h, plain, elastic, buckling, wrinkled);
    CHECK(plain == Approx(elastic).epsilon(1e-9));
    CHECK(buckling == Approx((1 - remainder) * wrinkled + remainder * elastic).epsilon(1e-9));
    CHECK(buckling < last);
    last = buckling;
  }
}

TEST_CASE("A sheared panel carries the stress of a tension field") {
  // Wrinkles run at 45°: along them E ε with ε = γ/2, across them -σ (Wong and Pellegrino 2006, section 3).
  table("Shear stress over E gamma of a panel sheared by gamma = 0.005; without wrinkles 1 / 2(1 + nu)",
        "membrane", "nu", "plain", "buckling", "theory");
  constexpr double shear = 0.005, step = 1e-6;
  for (const std::string membrane : {"neo_hookean", "stvk"})
    for (const double nu : {0.0, 0.3}) {
      Material m = fabric;
      m.poisson_ratio = nu;
      const Level level = Level::of(0, grid({0.4, 0.2}, 9, 5, Diagonals::one_way));
      const LevelModel model = model_of(level, m, {membrane, "hinge"});
      const double unit = m.membrane_modulus * shear;
      const auto stress = [&](const LevelModel& of) {
        const auto energy = [&](double gamma) {
          Positions x = level.rest.vertices;
          x.col(0) += gamma * x.col(1);
          return of.value(x, {EnergyRole::membrane});
        };
        return (energy(shear + step) - energy(shear - step)) / (2 * step * 0.4 * 0.2 * m.thickness * unit);
      };
      const double sigma =
          buckling_force(make_plugin_from<Energy>("hinge")->plate_stiffness(m), edge) / m.thickness;
      const double theory = (unit / 2 + (1 - nu) * sigma) / (2 * unit);
      const double plain = stress(model), buckling = stress(model.with_effective_membranes(levels_below));
      row(membrane, nu, plain, buckling, theory);
      CHECK(plain == Approx(1 / (2 * (1 + nu))).epsilon(0.02));
      CHECK(buckling == Approx(theory).epsilon(0.03));
    }
}

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
  Eigen::Vector3d down() const {
    const Level& level = hierarchy.levels.front();
    return (level.vertex_area.transpose() * level.rest.vertices / level.vertex_area.sum() -
            level.rest.vertices.row(held))
        .normalized()
        .transpose();
  }

  LevelModel model(int index) const {
    const Level& level = hierarchy.levels[index];
    Material m;
    m.poisson_ratio = 0.3;
    m.bending_modulus = 1e7;  // so that no compression buckles
    m.density = 1;            // strains of a thousandth at the pin
    const std::string gravity = filled("{type: gravity, acceleration: $}", down());
    return model_of(level, m, {"neo_hookean", "hinge", gravity},
                    {{held, level.rest.vertices.row(held).transpose()}});
  }

  /// Mean displacement along gravity at rest [m].
  double sag(const LevelModel& model) const {
    const Positions& rest = model.level().rest.vertices;
    const Eigen::VectorXd& area = model.level().vertex_area;
    return area.dot((equilibrium_of(model, rest, 1e-6) - rest) * down()) / area.sum();
  }
};

}  // namespace

TEST_CASE("A coarse cloth hangs from a lone pin as low as the finest one") {
  table("Mean sag of a square that hangs in its plane from one vertex, coarse over finest, edges h and h/2^k",
        "cells", "held at", "k", "plain", "effective");
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
        row(cells, where, k, plain, effective);
        // Inside a one-way grid the stiffness depends on the direction, and its mean is taken.
        CHECK(std::abs(effective - 1) < (std::string(where) == "inside" ? 0.15 : 0.06));
        CHECK(plain < 0.85);
      }
}

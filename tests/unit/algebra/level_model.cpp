#include "core/numerics/model/level_model.h"

#include <catch2/catch.hpp>

#include "core/numerics/elements/linear_energy.h"
#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/model/lone_pins.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/meshes.h"
#include "tests/support/refusal.h"
#include "tests/support/registry.h"
#include "tests/support/test_energies.h"

using namespace drape;

namespace {

const Level oblong = Level::of(0, grid({2, 1}, 4, 3, Diagonals::one_way));

/// Forces that vary over the vertices, with energy `at_origin` at x = 0.
std::shared_ptr<Energy> slope(const Level& level, double size, double at_origin = 0) {
  return energy_of(LinearEnergy(size * level.rest.vertices.array().cos(), at_origin), EnergyRole::external);
}

/// ½ Σ |x_i|², of elements, or of none although it is not linear.
struct OriginSprings : NoEnergy {
  explicit OriginSprings(Stencils elements) : elements(std::move(elements)) {}
  double value(const Positions& x) const override { return 0.5 * x.squaredNorm(); }
  double add_gradient(const Positions& x, Positions& g) const override {
    g += x;
    return value(x);
  }
  Stencils stencils() const override { return elements; }
  Stencils elements;
};

/// A bending energy with the stiffness of a plate, or a membrane that keeps the bound it buckles at.
struct Shell : CopyingEnergy<OriginSprings> {
  double stiffness;
  mutable double bound = -1;
  Shell(EnergyRole role, double stiffness)
      : CopyingEnergy(OriginSprings(each_vertex(1)), role), stiffness(stiffness) {}
  double plate_stiffness(const Material&) const override { return stiffness; }
  std::unique_ptr<BoundEnergy> bind_buckling(const Level& level, const Material& material,
                                             double s) const override {
    bound = s;
    return bind(level, material);
  }
};

using Make = std::unique_ptr<BoundEnergy> (*)();

/// Binds to what a function makes, or throws with it.
struct Binding : Energy {
  Make make;
  explicit Binding(Make make) : make(make) {}
  EnergyRole role() const override { return EnergyRole::external; }
  std::unique_ptr<BoundEnergy> bind(const Level&, const Material&) const override { return make(); }
};

/// The oblong sheet with these energies.
LevelModel oblong_model(const std::vector<NamedEnergy>& energies, const LevelModel* before = nullptr) {
  return {oblong, Material(), energies, {}, {}, before};
}

}  // namespace

TEST_CASE("an energy that cannot be bound, or is not what it says, is refused by name") {
  const auto refusal = [](Make make) {
    return refusal_of([&] {
      oblong_model({{"slope", slope(oblong, 2)}, {"wind", std::make_shared<Binding>(make)}});
    });
  };
  CHECK(refusal([]() -> std::unique_ptr<BoundEnergy> { return nullptr; }) ==
        "energy wind: bind returned null; return an object, which may have no elements");
  CHECK(refusal([]() -> std::unique_ptr<BoundEnergy> { throw std::runtime_error("cannot bind"); }) ==
        "energy wind: cannot bind");
  CHECK(refusal([]() -> std::unique_ptr<BoundEnergy> { throw 42; }) ==
        "energy wind: an exception that is no std::exception");
  CHECK_THAT(refusal([]() -> std::unique_ptr<BoundEnergy> {
               return std::make_unique<OriginSprings>(Stencils(0, 1));
             }),
             Catch::StartsWith("energy wind has no elements, so it counts as linear, but"));
}

TEST_CASE("an energy that replaces the gradient is refused by name, before another one writes to it") {
  struct Replacing : NoEnergy {
    double add_gradient(const Positions&, Positions& g) const override {
      g = Positions::Zero(3, 3);
      return 0;
    }
    Stencils stencils() const override { return each_vertex(12); }
  };
  for (const EnergyRole role : {EnergyRole::membrane, EnergyRole::limit}) {
    const LevelModel model = oblong_model(
        {{"short", energy_of(Replacing(), role)}, {"springs", energy_of(OriginSprings(each_vertex(12)))}});
    CHECK(refusal_of([&] { model.force_residual(oblong.rest.vertices); }) ==
          "energy short: add_gradient has changed the size of g to 3 rows, not 12; add to its rows");
  }
}

TEST_CASE("linear energies are evaluated together, and limits apart; parts have names of their own") {
  const Level level = Level::of(0, grid({2, 1}, 150, 100, Diagonals::one_way));
  const OriginSprings springs(each_vertex(level.vertex_count()));
  const std::vector<NamedEnergy> energies = {{"load", slope(level, 2)},
                                             {"load 2", energy_of(springs)},
                                             {"limit", energy_of(springs, EnergyRole::limit)},
                                             {"load", slope(level, -0.5, 3)}};
  const LevelModel first(level, Material(), energies, {}), later(level, Material(), energies, {}, {}, &first);
  const Positions x = level.rest.vertices.array() + 0.7, forces = 1.5 * level.rest.vertices.array().cos();
  for (const LevelModel* model : {&first, &later}) {
    std::vector<std::string> names;
    double expected = 0;
    for (const auto& [name, joules] : model->energy_parts(x)) {
      names.push_back(name);
      if (name != "limit") expected += joules;
    }
    CHECK(names == std::vector<std::string>{"load", "load 2", "limit", "load 3"});
    Positions g = Positions::Constant(1, 3, 7);  // of another size, and not zero
    CHECK(model->gradient(x, g) == Approx(expected).epsilon(1e-12));
    CHECK(model->value(x) == Approx(expected).epsilon(1e-12));
    CHECK((g - (x - forces)).norm() < 1e-12 * g.norm());
    CHECK(model->load_norm(x) == Approx(2.5 / 1.5 * forces.norm()).epsilon(1e-12));
  }
}

TEST_CASE("A model refuses an energy whose stencils differ from those of the model before") {
  const auto model = [](const Stencils& stencils, const LevelModel* before = nullptr) {
    return oblong_model({{"springs", energy_of(OriginSprings(stencils))}}, before);
  };
  const Stencils two{{0}, {1}};
  const LevelModel before = model(two);
  CHECK_NOTHROW(model(two, &before));
  for (const Stencils& other : {Stencils{{0}, {2}}, Stencils{{0}, {1}, {2}, {3}}, Stencils{{0, 1}, {2, 3}}})
    CHECK_THROWS_WITH(model(other, &before),
                      Catch::StartsWith("energy springs changes its stencils with a parameter"));
}

TEST_CASE("A pinned vertex is lone if none of its neighbours is pinned, on the coarse level and the finest") {
  const Hierarchy levels =
      Hierarchy::of(grid({2, 2}, 3, 3, Diagonals::one_way), *make_plugin_from<Refiner>("midpoint"), 2);
  const Level &coarse = levels.levels[0], &finest = levels.levels[1];
  const auto model = [](const Level& level, const std::vector<int>& vertices) {
    std::vector<DirichletVertex> held;
    for (const int v : vertices) held.push_back({v, level.rest.vertices.row(v).transpose()});
    return std::make_shared<const LevelModel>(level, Material(), std::vector<NamedEnergy>{}, held);
  };
  const auto lone = [&](const std::vector<int>& here, const std::vector<int>& there) {
    return lone_pins(*model(coarse, here), [&] { return model(finest, there); });
  };
  CHECK(lone({0, 8}, {0, 8}) == std::vector<int>{0, 8});
  CHECK(lone({0, 1, 8}, {0, 1, 8}) == std::vector<int>{8});
  CHECK(lone({0, 8}, {0, finest.topology.vertex_vertices.row(0).front(), 8}) == std::vector<int>{8});
  CHECK(lone_pins(*model(coarse, {0, 1}), []() -> std::shared_ptr<const LevelModel> { throw 0; }).empty());

  // Cloth softens at the pin, also at the tip of a slit, although a full turn has no axis.
  TriangleMesh slit = wheel(8);
  append(slit, {slit.vertices.row(1)}, {});
  slit.triangles(7, 2) = 9;
  for (const Level& level : {coarse, Level::of(0, slit)}) {
    const Eigen::VectorXd softening = softening_at_pins(level, {0}, 0.3, 1);
    REQUIRE(softening.size() == 8);
    for (int t = 0; t < 8; ++t) {
      const bool at_pin = (level.rest.triangles.row(t).array() == 0).any();
      CHECK((at_pin ? softening[t] < 0.8 && softening[t] > 0.3 : softening[t] == 1));
    }
  }
}

TEST_CASE("Membranes of coarse levels buckle at the stress of a clamped column of the mesh's size") {
  const auto membrane = std::make_shared<Shell>(EnergyRole::membrane, 0);
  const LevelModel model = oblong_model({{"membrane", membrane},
                                         {"bending", std::make_shared<Shell>(EnergyRole::bending, 2)},
                                         {"more bending", std::make_shared<Shell>(EnergyRole::bending, 1)}});
  // s = σ d A with σ d = 4 π² D / (h² - h_L²), h² = 2 A, h_L = h 2^-k.
  const double area = 1.0 / 6, h2 = 2 * area, pi = std::acos(-1);
  for (const int k : {1, 2, 3}) {
    const LevelModel buckling = model.with_effective_membranes(k);
    CHECK(membrane->bound == Approx(4 * pi * pi * 3 / (h2 - h2 / std::pow(4, k)) * area));
    CHECK(buckling.pattern() == model.pattern());
    CHECK(buckling.unbuckling_membranes().empty());
    CHECK(buckling.value(oblong.rest.vertices) == model.value(oblong.rest.vertices));
  }
  oblong_model({{"membrane", membrane}}).with_effective_membranes(1);
  CHECK(membrane->bound == 0);
  // Several membranes keep their laws: each alone would wrinkle where their sum is taut.
  const auto first = std::make_shared<Shell>(EnergyRole::membrane, 0),
             second = std::make_shared<Shell>(EnergyRole::membrane, 0);
  const LevelModel several = oblong_model({{"first", first}, {"second", second}}).with_effective_membranes(1);
  CHECK((first->bound == -1 && second->bound == -1));
  CHECK(several.unbuckling_membranes() == std::vector<std::string>{"first", "second"});
  const auto plain =
      std::make_shared<CopyingEnergy<OriginSprings>>(OriginSprings(each_vertex(1)), EnergyRole::membrane);
  const LevelModel kept = oblong_model({{"plain", plain}}).with_effective_membranes(1);
  CHECK(kept.unbuckling_membranes() == std::vector<std::string>{"plain"});
  CHECK(kept.value(oblong.rest.vertices) == oblong_model({{"plain", plain}}).value(oblong.rest.vertices));
}

TEST_CASE("A law that reads its triangle's area reads that at rest, also at a lone pin") {
  const Level level = Level::of(0, grid({2, 2}, 3, 3, Diagonals::one_way));
  const LevelModel model(
      level, Material(),
      {{"sized", make_plugin_from<Energy>("{type: formula, constants: {c: {value: 1, unit: m^4 kg s^-2}}, "
                                          "energy: \"c*(g11^2 + g22^2)/area\"}")}},
      {});
  const Positions x = 1.05 * level.rest.vertices;
  CHECK(model.with_effective_membranes(1, {0}).value(x) <= model.value(x) * (1 + 1e-12));  // never stiffer
}

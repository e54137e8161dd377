#include "core/numerics/model/level_model.h"

#include <catch2/catch.hpp>

#include "core/numerics/elements/linear_energy.h"
#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/model/lone_pins.h"
#include "core/numerics/patterns/generate.h"
#include "tests/support/refusal.h"
#include "tests/support/registry.h"

using namespace drape;

namespace {

/// Forces that vary over the vertices, with energy `at_origin` at x = 0.
class Slope : public Energy {
 public:
  Slope(double size, double at_origin) : size_(size), at_origin_(at_origin) {}

  EnergyRole role() const override { return EnergyRole::external; }
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material&) const override {
    return std::make_unique<Bound>(size_ * level.rest.vertices.array().cos(), at_origin_);
  }

 private:
  class Bound : public BoundEnergy {
   public:
    Bound(const Positions& forces, double at_origin) : forces_(forces), at_origin_(at_origin) {}
    double value(const Positions& x) const override { return at_origin_ + forces_.value(x); }
    double add_gradient(const Positions& x, Positions& g) const override {
      return at_origin_ + forces_.add_gradient(x, g);
    }
    Stencils stencils() const override { return Stencils(0, 1); }
    void add_hessian(const Positions&, Projection, BlockSink&) const override {}

   private:
    LinearEnergy forces_;
    double at_origin_;
  };

  double size_, at_origin_;
};

/// ½ Σ |x_i|², as an energy or a limit.
class OriginSprings : public Energy, public BoundEnergy {
 public:
  OriginSprings(EnergyRole role, int count) : role_(role), count_(count) {}

  EnergyRole role() const override { return role_; }
  std::unique_ptr<BoundEnergy> bind(const Level& level, const Material&) const override {
    return std::make_unique<OriginSprings>(role_, level.vertex_count());
  }
  double value(const Positions& x) const override { return 0.5 * x.squaredNorm(); }
  double add_gradient(const Positions& x, Positions& g) const override {
    g += x;
    return value(x);
  }
  Stencils stencils() const override { return Eigen::VectorXi::LinSpaced(count_, 0, count_ - 1); }
  void add_hessian(const Positions&, Projection, BlockSink& sink) const override {
    const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
    for (int i = 0; i < count_; ++i) sink.add(i, 0, 0, one.data());
  }

 private:
  EnergyRole role_;
  int count_;
};

/// A bending energy with the stiffness of a plate, or a membrane that keeps the bound it buckles at.
struct Shell : OriginSprings {
  double stiffness;
  mutable double bound = -1;
  Shell(EnergyRole role, double stiffness) : OriginSprings(role, 1), stiffness(stiffness) {}
  double plate_stiffness(const Material&) const override { return stiffness; }
  std::unique_ptr<BoundEnergy> bind_buckling(const Level& level, const Material& material,
                                             double s) const override {
    bound = s;
    return bind(level, material);
  }
};

/// Binds to this, or throws without it.
struct Binding : Energy {
  std::unique_ptr<BoundEnergy> (*make)();
  explicit Binding(std::unique_ptr<BoundEnergy> (*make)()) : make(make) {}
  EnergyRole role() const override { return EnergyRole::external; }
  std::unique_ptr<BoundEnergy> bind(const Level&, const Material&) const override { return make(); }
};

/// ½ Σ z², which is not linear, without elements.
struct NotLinear : BoundEnergy {
  double value(const Positions& x) const override { return 0.5 * x.col(2).squaredNorm(); }
  double add_gradient(const Positions& x, Positions& g) const override {
    g.col(2) += x.col(2);
    return value(x);
  }
  Stencils stencils() const override { return Stencils(0, 1); }
  void add_hessian(const Positions&, Projection, BlockSink&) const override {}
};

}  // namespace

TEST_CASE("an energy that cannot be bound, or is not what it says, is refused by name", "[level_model]") {
  const Level level = Level::of(0, grid({2, 1}, 4, 3, Diagonals::one_way));
  const auto refusal = [&](std::unique_ptr<BoundEnergy> (*make)()) {
    return refusal_of([&] {
      LevelModel(level, Material(),
                 {{"slope", std::make_shared<Slope>(2, 0)}, {"wind", std::make_shared<Binding>(make)}}, {});
    });
  };
  CHECK(refusal([]() -> std::unique_ptr<BoundEnergy> { return nullptr; }) ==
        "energy wind: bind returned null; return an object, which may have no elements");
  CHECK(refusal([]() -> std::unique_ptr<BoundEnergy> { throw std::runtime_error("cannot bind"); }) ==
        "energy wind: cannot bind");
  CHECK_THAT(refusal([]() -> std::unique_ptr<BoundEnergy> { return std::make_unique<NotLinear>(); }),
             Catch::Matchers::StartsWith("energy wind has no elements, so it counts as linear, but"));
}

TEST_CASE("linear energies are evaluated together, and limits apart", "[level_model]") {
  const Level level = Level::of(0, grid({2, 1}, 150, 100, Diagonals::one_way));
  const auto slope = [](double size, double at_origin) { return std::make_shared<Slope>(size, at_origin); };
  const auto springs = std::make_shared<OriginSprings>(EnergyRole::membrane, 0);
  const auto limit = std::make_shared<OriginSprings>(EnergyRole::limit, 0);
  const LevelModel model(level, Material(),
                         {{"a", slope(2, 0)}, {"springs", springs}, {"limit", limit}, {"b", slope(-0.5, 3)}},
                         {});
  const Positions x = level.rest.vertices.array() + 0.7;

  double expected = 0;
  for (const auto& [name, energy] : model.energy_parts(x))
    if (name != "limit") expected += energy;
  Positions g = Positions::Constant(1, 3, 7);  // of another size, and not zero
  CHECK(model.gradient(x, g) == Approx(expected).epsilon(1e-12));
  CHECK(model.value(x) == Approx(expected).epsilon(1e-12));
  const Positions forces = 1.5 * level.rest.vertices.array().cos();
  CHECK((g - (x - forces)).norm() < 1e-12 * g.norm());
  CHECK(model.load_norm(x) == Approx(2.5 / 1.5 * forces.norm()).epsilon(1e-12));
}

TEST_CASE("the parts of the energy have names of their own and sum to it", "[level_model]") {
  const Level level = Level::of(0, grid({2, 1}, 4, 3, Diagonals::one_way));
  const auto slope = [](double size) { return std::make_shared<Slope>(size, 0); };
  const std::vector<NamedEnergy> energies = {
      {"load", slope(2)}, {"load 2", slope(5)}, {"load", slope(-0.5)}, {"other", slope(1)}};
  const LevelModel model(level, Material(), energies, {});
  const LevelModel later(level, Material(), energies, {}, {}, &model);
  const Positions x = level.rest.vertices.array() + 0.7;
  for (const LevelModel* own : {&model, &later}) {
    std::vector<std::string> names;
    double sum = 0;
    for (const auto& [name, joules] : own->energy_parts(x)) names.push_back(name), sum += joules;
    CHECK(names == std::vector<std::string>{"load", "load 2", "load 3", "other"});
    CHECK(sum == Approx(own->energy(x)).epsilon(1e-12));
  }
}

TEST_CASE("A model refuses an energy whose stencils differ from those of the model before", "[level_model]") {
  using Make = std::unique_ptr<BoundEnergy> (*)();
  struct Stenciled : OriginSprings {
    explicit Stenciled(Stencils own) : OriginSprings(EnergyRole::membrane, 0), own(std::move(own)) {}
    Stencils stencils() const override { return own; }
    Stencils own;
  };
  const Make two = [] { return std::unique_ptr<BoundEnergy>(new Stenciled(Stencils{{0}, {1}})); };
  const Make four = [] { return std::unique_ptr<BoundEnergy>(new Stenciled(Stencils{{0}, {1}, {2}, {3}})); };
  const Make pairs = [] { return std::unique_ptr<BoundEnergy>(new Stenciled(Stencils{{0, 1}, {2, 3}})); };
  const Make other = [] { return std::unique_ptr<BoundEnergy>(new Stenciled(Stencils{{0}, {2}})); };
  const Level level = Level::of(0, grid({2, 1}, 4, 3, Diagonals::one_way));
  const auto model = [&](Make make, const LevelModel* before) {
    return LevelModel(level, Material(), {{"springs", std::make_shared<Binding>(make)}}, {}, {}, before);
  };
  const std::vector<Make> kinds = {two, four, pairs, other};
  for (std::size_t i = 0; i < kinds.size(); ++i)
    for (std::size_t j = 0; j < kinds.size(); ++j) {
      CAPTURE(i, j);
      const LevelModel before = model(kinds[i], nullptr);
      if (i == j)
        CHECK_NOTHROW(model(kinds[j], &before));
      else
        CHECK_THROWS_WITH(model(kinds[j], &before),
                          Catch::StartsWith("energy springs changes its stencils with a parameter"));
    }
}

TEST_CASE("A pinned vertex is lone if none of its neighbours is pinned, on the coarse level and the finest",
          "[level_model]") {
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
  CHECK(lone({0, 8}, {0, *finest.topology.vertex_vertices.begin(0), 8}) == std::vector<int>{8});
  CHECK(lone_pins(*model(coarse, {0, 1}), []() -> std::shared_ptr<const LevelModel> { throw 0; }).empty());

  const Eigen::VectorXd softening = softening_at_pins(coarse, {0}, 0.3, 1);
  REQUIRE(softening.size() == 8);
  for (int t = 0; t < 8; ++t) {
    const bool at_pin = (coarse.rest.triangles.row(t).array() == 0).any();
    CHECK((at_pin ? softening[t] < 0.8 && softening[t] > 0.3 : softening[t] == 1));
  }
}

TEST_CASE("Cloth at the tip of a slit softens, although a full turn has no axis", "[level_model]") {
  TriangleMesh slit{Positions::Zero(10, 3), Triangles(8, 3)};
  for (int i = 0; i < 9; ++i) {
    const double angle = i * std::acos(-1) / 4;
    slit.vertices.row(i + 1) << std::cos(angle), std::sin(angle), 0;
    if (i < 8) slit.triangles.row(i) << 0, i + 1, i + 2;
  }
  const Eigen::VectorXd softening = softening_at_pins(Level::of(0, slit), {0}, 0.3, 1);
  CHECK(softening.minCoeff() > 0.3);
  CHECK(softening.maxCoeff() < 0.8);
}

TEST_CASE("Membranes of coarse levels buckle at the stress of a clamped column of the mesh's size",
          "[level_model]") {
  const Level level = Level::of(0, grid({2, 1}, 4, 3, Diagonals::one_way));
  const auto membrane = std::make_shared<Shell>(EnergyRole::membrane, 0);
  const LevelModel model(level, Material(),
                         {{"membrane", membrane},
                          {"bending", std::make_shared<Shell>(EnergyRole::bending, 2)},
                          {"more bending", std::make_shared<Shell>(EnergyRole::bending, 1)}},
                         {});
  // s = σ d A with σ d = 4 π² D / (h² - h_L²), h² = 2 A, h_L = h 2^-k.
  const double area = 1.0 / 6, h2 = 2 * area, pi = std::acos(-1);
  for (const int k : {1, 2, 3}) {
    const LevelModel buckling = model.with_effective_membranes(k);
    CHECK(membrane->bound == Approx(4 * pi * pi * 3 / (h2 - h2 / std::pow(4, k)) * area));
    CHECK(buckling.pattern() == model.pattern());
    CHECK(buckling.value(level.rest.vertices) == model.value(level.rest.vertices));
  }
  LevelModel(level, Material(), {{"membrane", membrane}}, {}).with_effective_membranes(1);
  CHECK(membrane->bound == 0);
}

#include <catch2/catch.hpp>

#include "core/mesh/generate.h"
#include "core/model/level_model.h"
#include "core/numerics/newton.h"

using namespace drape;

namespace {

/// Constant forces, whose Hessian is zero.
class Weight : public Energy, public BoundEnergy {
 public:
  explicit Weight(int vertices) : vertices_(vertices) {}
  EnergyRole role() const override { return EnergyRole::external; }
  std::unique_ptr<BoundEnergy> bind(const Level&, const Material&) const override {
    return std::make_unique<Weight>(*this);
  }
  double value(const Positions& x) const override { return x.col(2).sum(); }
  double add_gradient(const Positions& x, Positions& g) const override {
    g.col(2).array() += 1;
    return value(x);
  }
  Stencils stencils() const override {
    Stencils s(vertices_, 1);
    for (int i = 0; i < vertices_; ++i) s(i, 0) = i;
    return s;
  }
  void add_hessian(const Positions&, Projection, BlockSink& sink) const override {
    const double zero[9] = {};
    for (int i = 0; i < vertices_; ++i) sink.add(i, 0, 0, zero);
  }

 private:
  int vertices_;
};

}  // namespace

TEST_CASE("Mass is added to a singular matrix whatever the step size, and never 0", "[newton]") {
  const Level level = Level::of(0, grid({1, 1}, 4, 4, Diagonals::one_way));
  const LevelModel model(level, Material(), {{"weight", std::make_shared<Weight>(16)}}, {});
  for (const NewtonForm form : {NewtonForm::quasistatic, NewtonForm::statics})
    for (const double step_size : {1e9, 1e200}) {
      NewtonParameters p;
      p.form = form;
      p.step_size = step_size;
      PlainObjective objective(model);
      Observer silent;
      const LevelResult r = minimise(objective, level.rest.vertices, p, {Stopwatch(), silent});
      CAPTURE(int(form), step_size, r.message);
      CHECK(r.outcome == Outcome::infeasible);
    }
}

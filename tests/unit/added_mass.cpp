#include <catch2/catch.hpp>

#include "core/numerics/model/level_model.h"
#include "core/numerics/patterns/generate.h"
#include "core/numerics/solve/newton.h"
#include "tests/support/weight.h"

using namespace drape;

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

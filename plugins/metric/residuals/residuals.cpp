#include <cmath>

#include "core/kernel/interfaces/metric.h"
#include "core/kernel/plugin/bounds.h"
#include "core/kernel/plugin/plugin.h"
#include "core/numerics/linear_algebra/block_cholesky.h"
#include "core/numerics/model/level_model.h"

namespace drape {

/// How far a state is from an equilibrium of the plain model of its level (docs/theory/method.md, section 2).
class Residuals : public Metric {
 public:
  double step_size = 0.1;  ///< h

  static void declare(Declaration<Residuals>& d) {
    d.add("step_size", &Residuals::step_size,
          "h of the implicit step whose Newton direction the decrement measures")
        .unit("s")
        .between(bounds::smallest_time_step, bounds::largest_time_step)
        .source("Li et al. 2021 (C-IPC)");
  }

  MetricDeclaration declaration() const override {
    return {.columns = {{.name = "force_residual_plain",
                         .label = "force residual of the plain model",
                         .unit = "1",
                         .shown = Shown::stored},
                        {.name = "decrement_plain",
                         .label = "decrement of the plain model",
                         .unit = "m/s",
                         .shown = Shown::stored}}};
  }

 private:
  MetricResult measure(const MetricInput& input) const override {
    return {{{"force_residual_plain", input.model.force_residual(input.x)},
             {"decrement_plain", decrement(input.model, input.x)}},
            {}};
  }

  /// ‖p‖ / (h √n) of the first Newton direction of an implicit step from x, with the clamped matrix.
  double decrement(const LevelModel& model, const Positions& x) const {
    Positions g, p;
    model.energy_gradient(x, g);
    const BlockMatrix matrix = model.energy_hessian(x, Projection::clamp);
    BlockCholesky cholesky;
    cholesky.analyse(matrix.pattern, model.fixed());
    const double h = step_size;
    if (!cholesky.factorise(matrix, model.masses() / (h * h))) return std::nan("");
    cholesky.solve(g, p);
    return std::sqrt(p.squaredNorm() * 3 / std::max(1, cholesky.unknowns())) / h;
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Metric, drape::Residuals>(
      "residuals", "Force residual and Newton decrement of a state under its level's plain model.");
}

#include "core/kernel/plugin/plugin.h"
#include "core/numerics/solve/progression.h"
#include "core/numerics/solve/resumable_solver.h"

namespace drape {

/// Solves coarse to fine, each level under its own energy, in the style of Sensitive Couture (Umetani et al.
/// 2011). The finest level is plain Newton from a better start.
class CascadicSolver : public ResumableSolver {
 public:
  struct Parameters {
    Interpolation prolongation = Interpolation::midpoint;
    NewtonParameters newton;
    static void declare(Declaration<Parameters>& d) {
      d.add_choice("prolongation", &Parameters::prolongation,
                   {{"midpoint", Interpolation::midpoint}, {"refiner", Interpolation::refiner}})
          .description(
              "prolongs a level's state: linearly over the rest shape, on grids by edge midpoints, or by the "
              "experiment's refiner")
          .source("docs/theory/method.md section 3");
      d.add_section("newton", &Parameters::newton).description("settings of the Newton solves");
    }
  };
  explicit CascadicSolver(const Parameters& parameters) : p_(parameters) {}

  Interpolation interpolation() const override { return p_.prolongation; }

  std::vector<LevelResult> resume(const Problem& problem, const MethodState& from,
                                  Observer& observer) const override {
    const auto objective = [&](int level) { return std::make_unique<PlainObjective>(problem.model(level)); };
    return solve_progressively(problem, problem.hierarchy.weights(p_.prolongation), objective, p_.newton,
                               from, observer);
  }

 private:
  Parameters p_;
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Solver, drape::CascadicSolver>(
      "cascadic", "Coarse to fine, each level under its own energy (style of Sensitive Couture).");
}

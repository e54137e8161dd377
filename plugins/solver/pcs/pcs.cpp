#include "core/numerics/newton_state.h"
#include "core/numerics/progression.h"
#include "core/plugin/plugin.h"
#include "proxy_objective.h"

namespace drape {

/// Which matrix makes the directions on the coarse levels.
enum class ProxyMatrix { coarse, galerkin };

/// Progressive cloth simulation: coarse levels minimise the finest level's energy, the finest level is
/// plain Newton (Zhang et al. 2022; docs/method.md, section 3).
class PcsSolver : public ResumableSolver {
 public:
  struct Parameters {
    ProxyMatrix hessian = ProxyMatrix::galerkin;
    int depth = 2;
    NewtonParameters newton;
    static void declare(Declaration<Parameters>& d) {
      d.add_choice("hessian", &Parameters::hessian,
                   {{"coarse", ProxyMatrix::coarse}, {"galerkin", ProxyMatrix::galerkin}})
          .meaning("matrix on coarse levels: the plain coarse model's, or a finer one's carried down")
          .source("PCS section 4.2 for coarse; galerkin is a departure");
      d.add("depth", &Parameters::depth)
          .at_least(1)
          .at_most(8)
          .meaning(
              "levels between the galerkin matrix and the level it is made for, where there are so many");
      d.add_section("newton", &Parameters::newton).meaning("settings of the Newton solves");
    }
  };
  explicit PcsSolver(const Parameters& parameters) : p_(parameters) {}

  std::vector<LevelResult> resume(const Problem& problem, const MethodState& from,
                                  Observer& observer) const override {
    const int depth = p_.hessian == ProxyMatrix::galerkin ? p_.depth : 0;
    const auto objective = [&](int level) -> std::unique_ptr<Objective> {
      if (level < problem.finest()) return std::make_unique<ProxyObjective>(problem, level, depth);
      return std::make_unique<PlainObjective>(*problem.models[level]);
    };
    return solve_progressively(problem, problem.hierarchy.prolongations, objective, p_.newton, from,
                               observer);
  }

 private:
  Parameters p_;
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Solver, drape::PcsSolver>(
      "pcs", "Progressive cloth simulation: coarse levels minimise the finest level's shell energy.");
}

#include "core/kernel/plugin/plugin.h"
#include "core/numerics/solve/progression.h"
#include "plugins/solver/pcs/proxy_parts.h"

namespace drape {

/// Progressive cloth simulation: coarse levels minimise the finest level's energy, the finest level is
/// plain Newton (Zhang et al. 2022; docs/theory/method.md, section 3).
struct PcsSolver : Progression {
  ProxyInterpolation seen_by;
  ProxyMatrix hessian = ProxyMatrix::galerkin;
  int depth = 2;
  bool effective = true;  ///< membranes of coarse levels
  bool relaxes = true;    ///< a coarse level, after its proxy

  static void declare(Declaration<PcsSolver>& d) {
    d.add_section("interpolation", &PcsSolver::seen_by)
        .description("how a coarse level sees the fine mesh whose energy it minimises");
    d.add_choice("hessian", &PcsSolver::hessian,
                 {{"coarse", ProxyMatrix::coarse}, {"galerkin", ProxyMatrix::galerkin}})
        .description(
            "matrix on coarse levels: that of the plain coarse model, or the Galerkin product of the proxy")
        .source("PCS section 4.2 for coarse; galerkin is a departure");
    d.add("depth", &PcsSolver::depth)
        .at_least(1)
        .at_most(8)
        .description(
            "how many levels above a coarse level the Hessian is that the Galerkin product restricts, at "
            "most the finest; for energies that are evaluated on the finest level");
    d.add_choice("membranes", &PcsSolver::effective, {{"plain", false}, {"effective", true}})
        .description(
            "how membranes of coarse levels act, unless they are seen by the refiner: by their own laws, or "
            "as the finest level's do, which buckle below the coarse mesh and give way at lone pins")
        .source("PCS section 4 for plain; effective is a departure (docs/theory/locking.md)");
    d.add_choice("relaxation", &PcsSolver::relaxes, {{"plain", true}, {"none", false}})
        .description(
            "what a coarse level minimises after its proxy: its own energy, which makes folds as "
            "sharp as the level allows, or nothing")
        .source("PCS section 4 for none; plain is a departure (docs/theory/locking.md)");
    declare_newton(d);
  }

  Interpolation interpolation() const override { return seen_by.state; }

  std::unique_ptr<Objective> objective(const Problem& problem, int level) const override {
    if (level == problem.finest()) return Progression::objective(problem, level);
    return std::make_unique<ProxyObjective>(
        problem, level, proxy_parts(problem, level, depth, seen_by),
        ProxyOptions{hessian, relaxes, effective && seen_by.membrane == Interpolation::midpoint});
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Solver, drape::PcsSolver>(
      "pcs", "Progressive cloth simulation: coarse levels minimise the finest level's shell energy.");
}

#include <memory>
#include <string>

#include "core/kernel/plugin/plugin.h"
#include "core/numerics/solve/progression.h"
#include "plugins/solver/pcs/proxy_objective.h"

namespace drape {

void ProxyInterpolation::declare(Declaration<ProxyInterpolation>& d) {
  const auto add = [&](const char* name, Interpolation ProxyInterpolation::*value, const std::string& section,
                       const char* description) {
    d.add_choice(name, value, {{"midpoint", Interpolation::midpoint}, {"refiner", Interpolation::refiner}},
                 description)
        .source("PCS section " + section + "; midpoint: docs/theory/locking.md");
  };
  add("membrane", &ProxyInterpolation::membrane, "4",
      "surface on which stretching is measured: the coarse one, or the refiner's, which locks");
  add("bending", &ProxyInterpolation::bending, "4",
      "surface on which bending is measured: the coarse one with folds at its edges, or the refiner's");
  add("external", &ProxyInterpolation::external, "4", "surface on which loads and handles act");
  add("state", &ProxyInterpolation::state, "4.3", "prolongs a level's state to the next level");
}

/// Progressive cloth simulation: coarse levels minimise the finest level's energy, the finest level is
/// plain Newton (Zhang et al. 2022; docs/theory/method.md, section 3).
struct PcsSolver : Progression, ProxyOptions {
  static void declare(Declaration<PcsSolver>& d) {
    d.add_section("interpolation", &PcsSolver::seen_by,
                  "how a coarse level sees the fine mesh whose energy it minimises");
    d.add_choice(
         "hessian", &PcsSolver::hessian,
         {{"coarse", ProxyMatrix::coarse}, {"galerkin", ProxyMatrix::galerkin}},
         "matrix on coarse levels: that of the plain coarse model, or the Galerkin product of the proxy")
        .source("PCS section 4.2 for coarse; galerkin is a departure");
    d.add("depth", &PcsSolver::depth,
          "how many levels above a coarse level the Hessian is that the Galerkin product restricts, at "
          "most the finest; for energies that are evaluated on the finest level")
        .between(1, 8);
    d.add_choice("membranes", &PcsSolver::effective, {{"plain", false}, {"effective", true}},
                 "how membranes of coarse levels act, unless they are seen by the refiner or, until a level "
                 "relaxes, have no midpoint factor: by their own laws, or as the finest level's do, which "
                 "buckle below the coarse mesh and give way at lone pins")
        .source("PCS section 4; effective: docs/theory/locking.md");
    d.add_choice("relaxation", &PcsSolver::relaxes, {{"plain", true}, {"none", false}},
                 "what a coarse level minimises after its proxy: its own energy, which makes folds as "
                 "sharp as the level allows, or nothing")
        .source("PCS section 4 has none; plain: docs/theory/locking.md");
    declare_newton(d);
  }

  Interpolation interpolation() const override { return seen_by.state; }

  std::unique_ptr<Objective> objective(const Problem& problem, int level) const override {
    if (level == problem.finest()) return Progression::objective(problem, level);
    return std::make_unique<ProxyObjective>(problem, level, *this);
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Solver, drape::PcsSolver>(
      "pcs", "Progressive cloth simulation: coarse levels minimise the finest level's shell energy.");
}

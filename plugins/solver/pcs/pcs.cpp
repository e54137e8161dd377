#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/kernel/plugin/plugin.h"
#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/model/level_model.h"
#include "core/numerics/solve/progression.h"
#include "plugins/solver/pcs/proxy_objective.h"

namespace drape {

/// Interpolation through which a proxy's energies see the fine mesh, for each role.
struct ProxyInterpolation {
  Interpolation membrane = Interpolation::midpoint;
  Interpolation bending = Interpolation::midpoint;
  Interpolation external = Interpolation::midpoint;
  Interpolation state = Interpolation::midpoint;

  static void declare(Declaration<ProxyInterpolation>& d) {
    const auto add = [&](const char* name, Interpolation ProxyInterpolation::*value,
                         const std::string& section, const char* description) {
      d.add_choice(name, value, {{"midpoint", Interpolation::midpoint}, {"refiner", Interpolation::refiner}},
                   description)
          .source("PCS section " + section +
                  " for refiner; midpoint is a departure (docs/theory/locking.md)");
    };
    add("membrane", &ProxyInterpolation::membrane, "4",
        "surface on which stretching is measured: the coarse one, or the refiner's, which locks");
    add("bending", &ProxyInterpolation::bending, "4",
        "surface on which bending is measured: the coarse one with folds at its edges, or the refiner's");
    add("external", &ProxyInterpolation::external, "4", "surface on which loads and handles act");
    add("state", &ProxyInterpolation::state, "4.3", "prolongs a level's state to the next level");
  }
};

/// Progressive cloth simulation: coarse levels minimise the finest level's energy, the finest level is
/// plain Newton (Zhang et al. 2022; docs/theory/method.md, section 3).
struct PcsSolver : Progression {
  ProxyInterpolation seen_by;
  ProxyMatrix hessian = ProxyMatrix::galerkin;
  int depth = 2;
  bool effective = true;  ///< membranes of coarse levels
  bool relaxes = true;    ///< a coarse level, after its proxy

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
        .source("PCS section 4 for plain; effective is a departure (docs/theory/locking.md)");
    d.add_choice("relaxation", &PcsSolver::relaxes, {{"plain", true}, {"none", false}},
                 "what a coarse level minimises after its proxy: its own energy, which makes folds as "
                 "sharp as the level allows, or nothing")
        .source("PCS section 4 for none; plain is a departure (docs/theory/locking.md)");
    declare_newton(d);
  }

  Interpolation interpolation() const override { return seen_by.state; }

  std::unique_ptr<Objective> objective(const Problem& problem, int level) const override {
    if (level == problem.finest()) return Progression::objective(problem, level);
    return std::make_unique<ProxyObjective>(
        problem, level, [this, &problem, level] { return parts(problem, level); },
        ProxyOptions{hessian, relaxes, effective && seen_by.membrane == Interpolation::midpoint});
  }

  /// Parts of the proxy of a coarse level for the finest model. An energy that midpoint refinement multiplies
  /// by a known factor (Energy::midpoint_factor) is evaluated on the level itself, any other on the finest
  /// one. The matrix of the latter is that of the model `depth` levels up, at most the finest. The parts
  /// refer to the problem's hierarchy.
  std::vector<ProxyPart> parts(const Problem& problem, int level) const {
    const int above = problem.finest() - level;
    std::vector<ProxyPart> parts;
    const auto add = [&](const ProxyPart& wanted, EnergyRole role) {
      for (ProxyPart& part : parts)
        if (part.above == wanted.above && part.factor == wanted.factor &&
            part.interpolation == wanted.interpolation) {
          part.roles.add(role);
          return;
        }
      parts.push_back(wanted);
      parts.back().roles.add(role);
    };
    for (const auto& [role, interpolated_by] : {std::pair(EnergyRole::membrane, seen_by.membrane),
                                                std::pair(EnergyRole::external, seen_by.external),
                                                std::pair(EnergyRole::position, seen_by.external),
                                                std::pair(EnergyRole::bending, seen_by.bending)}) {
      ProxyPart part;
      const auto factor = problem.model(level)->midpoint_factor(role);
      if (interpolated_by == Interpolation::midpoint && factor) {
        part.factor = std::pow(*factor, above);
      } else {
        part.above = above;
        part.matrix_above = std::min(depth, above);
        part.interpolation = &problem.hierarchy.weights(interpolated_by);
      }
      add(part, role);
    }
    return parts;
  }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Solver, drape::PcsSolver>(
      "pcs", "Progressive cloth simulation: coarse levels minimise the finest level's shell energy.");
}

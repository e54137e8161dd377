#include "core/kernel/plugin/plugin.h"
#include "core/numerics/solve/progression.h"
#include "core/numerics/solve/resumable_solver.h"
#include "plugins/solver/pcs/proxy_parts.h"

namespace drape {

/// What a coarse level minimises after its proxy.
enum class Relaxation {
  plain,  ///< the level's own energy, with folds of its own stiffness
  none    ///< nothing: the proxy's equilibrium is the level's state
};

/// How a membrane on a coarse level answers compression.
enum class Compression {
  buckling,  ///< at the stress at which the cloth buckles below the mesh
  elastic    ///< by the membrane's law, as on the finest level
};

/// Progressive cloth simulation: coarse levels minimise the finest level's energy, the finest level is
/// plain Newton (Zhang et al. 2022; docs/theory/method.md, section 3).
class PcsSolver : public ResumableSolver {
 public:
  struct Parameters {
    ProxyInterpolation interpolation;
    ProxyMatrix hessian = ProxyMatrix::galerkin;
    int depth = 2;
    Compression compression = Compression::buckling;
    Relaxation relaxation = Relaxation::plain;
    NewtonParameters newton;
    static void declare(Declaration<Parameters>& d) {
      d.add_section("interpolation", &Parameters::interpolation)
          .description("how a coarse level sees the fine mesh whose energy it minimises");
      d.add_choice("hessian", &Parameters::hessian,
                   {{"coarse", ProxyMatrix::coarse}, {"galerkin", ProxyMatrix::galerkin}})
          .description(
              "matrix on coarse levels: that of the plain coarse model, or the Galerkin product of the proxy")
          .source("PCS section 4.2 for coarse; galerkin is a departure");
      d.add("depth", &Parameters::depth)
          .at_least(1)
          .at_most(8)
          .description(
              "how many levels above a coarse level the Hessian is that the Galerkin product restricts, at "
              "most the finest; for energies that are evaluated on the finest level");
      d.add_choice("compression", &Parameters::compression,
                   {{"elastic", Compression::elastic}, {"buckling", Compression::buckling}})
          .description(
              "how membranes of coarse levels answer compression, unless they are seen by the refiner: by "
              "their law, or at the stress at which the cloth buckles below the mesh")
          .source("PCS section 4 for elastic; buckling is a departure (docs/theory/locking.md)");
      d.add_choice("relaxation", &Parameters::relaxation,
                   {{"plain", Relaxation::plain}, {"none", Relaxation::none}})
          .description(
              "what a coarse level minimises after its proxy: its own energy, which makes folds as "
              "sharp as the level allows, or nothing")
          .source("PCS section 4 for none; plain is a departure (docs/theory/locking.md)");
      d.add_section("newton", &Parameters::newton).description("settings of the Newton solves");
    }
  };
  explicit PcsSolver(const Parameters& parameters) : p_(parameters) {}

  Interpolation interpolation() const override { return p_.interpolation.state; }

  std::vector<LevelResult> resume(const Problem& problem, const MethodState& from,
                                  Observer& observer) const override {
    const auto objective = [&](int level) -> std::unique_ptr<Objective> {
      if (level == problem.finest()) return std::make_unique<PlainObjective>(problem.model(level));
      return std::make_unique<ProxyObjective>(
          problem, level, proxy_parts(problem, level, p_.depth, p_.interpolation),
          ProxyOptions{p_.hessian, p_.relaxation == Relaxation::plain, buckles()});
    };
    return solve_progressively(problem, problem.hierarchy.weights(p_.interpolation.state), objective,
                               p_.newton, from, observer);
  }

 private:
  bool buckles() const {
    return p_.compression == Compression::buckling && p_.interpolation.membrane == Interpolation::midpoint;
  }

  Parameters p_;
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Solver, drape::PcsSolver>(
      "pcs", "Progressive cloth simulation: coarse levels minimise the finest level's shell energy.");
}

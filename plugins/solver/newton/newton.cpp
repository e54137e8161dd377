#include "core/kernel/plugin/plugin.h"
#include "core/numerics/solve/progression.h"

namespace drape {

/// Solves each level from the scene's start under its own energy (docs/theory/method.md, section 3).
struct NewtonSolver : Progression {
  static void declare(Declaration<NewtonSolver>& d) { declare_newton(d); }
  bool refines() const override { return false; }
};

}  // namespace drape

DRAPE_PLUGIN(registry) {
  registry.add<drape::Solver, drape::NewtonSolver>(
      "newton", "Direct solve of every level on its own from the scene's start (C-IPC's implicit stepping).");
}

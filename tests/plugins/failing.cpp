// An energy and a method that fail in the middle of a run, or report what is not so.

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string>

#include "core/kernel/interfaces/energy.h"
#include "core/kernel/interfaces/solver.h"
#include "core/kernel/plugin/plugin.h"
#include "core/numerics/step/newton_parameters.h"

namespace {

using drape::Positions;

/// Zero, until it throws.
class BoundFailing final : public drape::BoundEnergy {
 public:
  BoundFailing(int gradients, int values) : gradients_(gradients), values_(values) {}

  double value(const Positions&) const override { return counted(values_, "value"); }
  double add_gradient(const Positions&, Positions&) const override { return counted(gradients_, "gradient"); }
  drape::Stencils stencils() const override { return drape::Stencils::Zero(1, 1); }
  void add_hessian(const Positions&, drape::Projection, drape::BlockSink&) const override {}

 private:
  static double counted(std::atomic<int>& left, const char* what) {
    if (left >= 0 && left-- == 0) throw std::runtime_error(std::string("the test's ") + what + " fails");
    return 0;
  }
  mutable std::atomic<int> gradients_, values_;
};

struct FailingEnergy final : drape::Energy {
  int level = 0, gradients = -1, values = -1;
  static void declare(drape::Declaration<FailingEnergy>& d) {
    using E = FailingEnergy;
    const std::string when = "before it throws; -1: never";
    d.add("level", &E::level, "that it fails on").at_least(0).source("test");
    d.add("gradients", &E::gradients, when).at_least(-1).source("test");
    d.add("values", &E::values, when).at_least(-1).source("test");
  }
  drape::EnergyRole role() const override { return drape::EnergyRole::bending; }
  std::unique_ptr<drape::BoundEnergy> bind(const drape::Level& bound, const drape::Material&) const override {
    const bool here = bound.index == level;
    return std::make_unique<BoundFailing>(here ? gradients : -1, here ? values : -1);
  }
};

/// Takes every level's start for a converged result. On one level it first has a command run, and throws, or
/// reports something else.
struct FailingSolver final : drape::Solver {
  int level = 0;
  std::string command, throws, reports;
  drape::NewtonParameters newton;  // which every method is given
  static void declare(drape::Declaration<FailingSolver>& d) {
    using S = FailingSolver;
    d.add("level", &S::level, "that it fails on").at_least(0).source("test");
    d.add("command", &S::command, "that the shell runs there").source("test");
    d.add("throws", &S::throws, "error, memory or other: what it throws after that").source("test");
    d.add("reports", &S::reports, "what it reports there (see solve)").source("test");
    d.add_section("newton", &S::newton, "not used");
  }

  std::vector<drape::LevelResult> solve(const drape::Problem& problem,
                                        drape::Observer& observer) const override {
    std::vector<drape::LevelResult> results;
    for (int l = 0; l <= problem.finest() && reports != "no_level"; ++l) {
      observer.level_started(l);
      if (l == level) fail();
      drape::LevelResult result;
      result.level = l;
      result.x = problem.starts[l];
      const std::string reported = l == level ? reports : "";
      if (reported == "level_nine") result.level = 9;
      if (reported == "level_zero") result.level = 0, result.x = problem.starts[0];
      if (reported == "no_vertices") result.x.resize(0, 3);
      if (reported == "not_a_number") result.x(0, 0) = std::nan("");
      if (reported == "moved_pins") result.x.array() += 0.1;
      if (reported == "residual") result.force_residual = 1;
      if (reported == "rounding") result.outcome = drape::Outcome::converged_to_rounding;
      results.push_back(result);
      if (reported != "to_nobody") observer.level_finished(result);
    }
    return results;
  }

 private:
  void fail() const {
    if (!command.empty() && std::system(command.c_str()) != 0)
      throw std::runtime_error("the test's command fails");
    if (throws == "error") throw std::runtime_error("the test's method fails");
    if (throws == "memory") throw std::bad_alloc();
    if (throws == "other") throw 17;
  }
};

}  // namespace

DRAPE_PLUGIN(registry) {
  registry.add<drape::Energy, FailingEnergy>("failing", "An energy that throws.");
  registry.add<drape::Solver, FailingSolver>("failing", "A method that throws.");
}

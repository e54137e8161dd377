#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/kernel/interfaces/contact_model.h"
#include "core/kernel/interfaces/load_stepping.h"
#include "core/kernel/interfaces/refiner.h"

namespace drape {

struct Hierarchy;
class LevelModel;

/// Input of a method: the levels of one cloth, as long as the hierarchy lives.
struct Problem {
  const Hierarchy& hierarchy;
  std::vector<std::shared_ptr<const LevelModel>> models;  ///< the plain model of every level at the start
  std::vector<Positions> starts;  ///< of every level, with Dirichlet vertices at their targets (n×3) [m]
  std::unique_ptr<LoadStepping> load_stepping;  ///< null without a schedule

  int finest() const { return static_cast<int>(models.size()) - 1; }
  /// The plain model of a level under the current load.
  std::shared_ptr<const LevelModel> model(int level) const {
    return load_stepping ? load_stepping->model(level) : models[level];
  }
};

/// How a level ended, from the best to the worst.
enum class Outcome {
  converged,
  converged_to_rounding,     ///< as near to equilibrium as round-off allows, though above the tolerance
  refined_early_on_request,  ///< an observer asked for the next level
  saddle,                    ///< forces vanish, but a motion lowers the energy (Stability)
  max_steps_reached,
  stalled,
  infeasible,
  cancelled
};
/// Its name in results; empty for a number that is none.
const char* to_string(Outcome outcome);
/// Whether a level is at rest.
inline bool has_converged(Outcome outcome) { return outcome <= Outcome::converged_to_rounding; }

/// One Newton iteration, for observers.
struct IterationRow {
  int level = 0, step = 0, iteration = 0;
  std::optional<double> time;          ///< pseudo-time, with a schedule
  double seconds = 0;                  ///< since the method's start
  double flops = 0;                    ///< of the level's factorisations and multigrid cycles so far
  double energy = 0;                   ///< E_l, the plain energy of the level [J]
  std::optional<double> proxy_energy;  ///< F_l, if the method minimises a proxy [J]
  double decrement = 0;  ///< bound of ‖p‖ / (h √n) for the first h [m/s]; not Newton's √(gᵀH⁻¹g)
  double force_residual = 0;           ///< of the objective, after the iteration [1]
  double step_length = 0;              ///< α of the line search
  double step_size = 0;                ///< h [s]; +∞ for the static form
  std::optional<int> contacts;         ///< closer than d̂, if the level has a contact model
  std::optional<double> smallest_gap;  ///< of them [m]; +∞ without one
};

/// Whether an equilibrium is a minimum, by its unprojected Hessian H (docs/theory/method.md, section 2).
struct Stability {
  enum Verdict : int { stable, marginal, unstable } verdict = stable;
  double lowest_eigenvalue = 0;  ///< of M⁻¹H [1/s²]
  double curvature_ratio = 0;    ///< the least vᵀHv / vᵀH⁺v, H⁺ the projected Hessian [1]
  double extent = 0;             ///< share of the mass that this v moves (its participation ratio) [1]
  bool by_factorisation = true;  ///< of H; else by iterations with multigrid
};
/// Its name in results; empty for a number that is none.
const char* to_string(Stability::Verdict verdict);

/// Result of one level.
struct LevelResult {
  int level = 0;
  Outcome outcome = Outcome::converged;
  std::string message;  ///< remarks on the start, then what stopped it if it did not converge
  Positions x;
  /// Whether no coarser level counts towards its cost. False for a level whose refinement failed, so that it
  /// started from the scene's start all the same: the attempt counts.
  bool from_initial_state = false;
  int steps = 0, iterations = 0, factorisations = 0, analyses = 0;
  double flops = 0;  ///< of factorisations, of which a failed one counts in full, and multigrid cycles
  double seconds = 0;
  std::map<std::string, double> seconds_by_phase;
  double decrement = 0;
  double force_residual = 0;           ///< of the objective [1]
  std::optional<double> smallest_gap;  ///< where the level has a contact model [m]; +∞ without a contact
  ContactStiffness contact_stiffness;  ///< at the end, of each contact model [Pa]
  LoadSteppingState load_stepping;     ///< at the end
  std::optional<Stability> stability;  ///< of the last equilibrium that was tested
  int saddles_left = 0;                ///< unstable equilibria from which the level went on
};

/// The stability of a level's end in results: the verdict, `untested` for an equilibrium that was not judged,
/// empty for an end that is none.
const char* stability_word(const LevelResult& result);

struct NewtonState;
struct MethodState;

/// Sees every iteration and level of a run; progress bars, recorders and cancellation are observers.
class Observer {
 public:
  virtual ~Observer() = default;
  virtual void level_started([[maybe_unused]] int level) {}
  virtual void iteration([[maybe_unused]] const IterationRow& row, [[maybe_unused]] const Positions& x) {}
  /// An increment of load stepping has ended at x.
  virtual void increment_finished([[maybe_unused]] const IncrementRow& row,
                                  [[maybe_unused]] const Positions& x) {}
  virtual void level_finished([[maybe_unused]] const LevelResult& result) {}
  virtual bool stop_requested() { return false; }
  /// Whether to end the level now and begin the next one. Not asked on the finest level.
  virtual bool refine_requested() { return false; }
  /// Asked at the beginning of every step: whether to call checkpoint() with the state there.
  virtual bool checkpoint_due() { return false; }
  virtual void checkpoint([[maybe_unused]] const NewtonState& state) {}
};

/// A method: a schedule of Newton solves over the levels of a problem, each reported to the observer. A run
/// does not take its word for what has converged (docs/reference/guarantees.md).
class Solver {
 public:
  static constexpr const char* kind = "solver";  ///< in the registry
  virtual ~Solver() = default;
  /// Results of the levels reached, in order. Only misuse throws.
  virtual std::vector<LevelResult> solve(const Problem& problem, Observer& observer) const = 0;
  /// Whether the solver can resume an interrupted solve of the same problem.
  virtual bool can_resume() const { return false; }
  /// Continues from a state, with the results of finished levels at the front; bit for bit as if `solve` had
  /// not been interrupted. A state without a finished level or one under way begins its level from the start.
  /// By default begins from the start.
  virtual std::vector<LevelResult> resume(const Problem& problem, [[maybe_unused]] const MethodState& from,
                                          Observer& observer) const {
    return solve(problem, observer);
  }
  /// Which prolongation the method's states are measured and shown with on finer meshes.
  virtual Interpolation interpolation() const { return Interpolation::midpoint; }
};

}  // namespace drape

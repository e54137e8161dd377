#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/hierarchy/hierarchy.h"
#include "core/model/conditions.h"
#include "core/model/contact_model.h"
#include "core/model/level_model.h"

namespace drape {

/// Everything that a method starts from. Refers to objects that the experiment owns.
struct Problem {
  const Hierarchy& hierarchy;
  std::vector<const LevelModel*> models;  ///< the plain model of every level
  std::vector<Positions> starts;          ///< the scene's start on every level, held vertices in place
  Conditions* conditions = nullptr;       ///< that change while a level is solved; null where none do

  int finest() const { return static_cast<int>(models.size()) - 1; }
  /// A level's state carried to the next one by `weights` (n_{l+1} × n_l), held vertices put in place.
  Positions carry_up(const ProlongationMatrix& weights, int level, const Positions& x) const;
};

/// How a solve ended. `refined_early`: on request, so that the next level could begin; `handed_on`: the same,
/// as the experiment's `refine_at` asks; `converged_to_rounding`: as near to equilibrium as doubles allow,
/// which is not as near as the tolerance asks.
enum class Outcome {
  converged,
  out_of_steps,
  stalled,
  cancelled,
  infeasible,
  refined_early,
  handed_on,
  converged_to_rounding
};
const char* to_string(Outcome outcome);
/// Whether a level is at equilibrium.
inline bool has_converged(Outcome outcome) {
  return outcome == Outcome::converged || outcome == Outcome::converged_to_rounding;
}
/// Whether a level ended as its experiment asked.
inline bool ended_as_asked(Outcome outcome) {
  return has_converged(outcome) || outcome == Outcome::handed_on;
}
/// The one that says more of what went wrong: in rising order converged, converged_to_rounding,
/// refined_early, out_of_steps, stalled, infeasible, cancelled; handed_on counts as converged.
Outcome worse_of(Outcome a, Outcome b);
/// As above, of outcomes in words, as results have them.
bool has_converged(const std::string& outcome);
bool ended_as_asked(const std::string& outcome);

/// One Newton iteration, as observers see it.
struct IterationRow {
  int level = 0, step = 0, iteration = 0;
  std::optional<double> time;          ///< pseudo-time, where conditions change
  double seconds = 0;                  ///< since the method's start
  double flops = 0;                    ///< of the level's factorisations so far
  double energy = 0;                   ///< E_l, the plain energy of the level [J]
  std::optional<double> proxy_energy;  ///< F_l where the method minimises that [J]
  double decrement = 0;                ///< ‖p‖ / (h √n) [m/s]
  double force_residual = 0;           ///< of what is minimised, after the iteration [1]
  double step_length = 0;              ///< α of the line search
  double step_size = 0;                ///< h [s]; +∞ for the static form
  std::optional<int> contacts;         ///< closer than d̂; absent without a contact model
  std::optional<double> smallest_gap;  ///< of them [m]; +∞ without one
};

/// The state a method reached on one level and how.
struct LevelResult {
  int level = 0;
  Outcome outcome = Outcome::converged;
  std::string message;  ///< what stopped it, if not convergence, after what is to be said of how it was begun
  Positions x;
  bool afresh = false;  ///< begun from the scene's start, so that no other level's work is in it
  int steps = 0, iterations = 0, factorisations = 0, analyses = 0;
  double flops = 0;  ///< of the factorisations; one that breaks off counts in full
  double seconds = 0;
  std::map<std::string, double> seconds_by_phase;
  double decrement = 0;
  double force_residual = 0;           ///< of what was minimised [1]
  std::optional<double> smallest_gap;  ///< where the level has a contact model [m]; +∞ without a contact
  ConditionsState conditions;          ///< that it reached, where they change
};

struct NewtonState;
struct MethodState;

/// Sees every iteration and level of a run; progress bars, recorders and cancellation are observers.
class Observer {
 public:
  virtual ~Observer() = default;
  virtual void level_started(int level) { (void)level; }
  virtual void iteration(const IterationRow& row, const Positions& x) { (void)row, (void)x; }
  /// What the level came to under one of its conditions; x is as it was before the next ones.
  virtual void change_finished(const ChangeRow& row, const Positions& x) { (void)row, (void)x; }
  virtual void level_finished(const LevelResult& result) { (void)result; }
  virtual bool stop_requested() { return false; }
  /// Whether the level is to end as it is and the next one to begin. Not asked on the finest level.
  virtual bool refine_requested() { return false; }
  /// Asked at the beginning of every step: whether checkpoint is to be given the state there.
  virtual bool checkpoint_due() { return false; }
  virtual void checkpoint(const NewtonState& state) { (void)state; }
};

/// A method: a schedule of Newton solves over the levels of a problem.
class Solver {
 public:
  virtual ~Solver() = default;
  /// Results of the levels reached, in order. Only misuse throws.
  virtual std::vector<LevelResult> solve(const Problem& problem, Observer& observer) const = 0;
  /// The prolongations, [l]: n_{l+1} × n_l, that carry the method's states up where they are measured or
  /// shown on a finer mesh. Unless the method says otherwise, the surface stays where it is.
  virtual std::vector<ProlongationMatrix> interpolation(const Hierarchy& hierarchy) const;
};

/// A Solver that can also go on where an earlier solve of the same problem was
/// (core/numerics/newton_state.h).
class ResumableSolver : public Solver {
 public:
  std::vector<LevelResult> solve(const Problem& problem, Observer& observer) const final;
  /// As `solve`, with the results of finished levels at the front, and bit for bit as if it had not been
  /// interrupted. A state without any finished level and none under way begins on its level from the start.
  virtual std::vector<LevelResult> resume(const Problem& problem, const MethodState& from,
                                          Observer& observer) const = 0;
};

}  // namespace drape

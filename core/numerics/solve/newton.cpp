#include "core/numerics/solve/newton.h"

#include <cmath>
#include <limits>
#include <optional>

#include "core/kernel/files/message_text.h"
#include "core/numerics/solve/dirichlet_enforcer.h"
#include "core/numerics/solve/newton_report.h"
#include "core/numerics/solve/newton_state.h"
#include "core/numerics/solve/start_fault.h"
#include "core/numerics/stability/saddle_exit.h"

namespace drape {
namespace {

/// The Dirichlet penalty doubles when the force residual falls to this multiple of the tolerance.
constexpr double near_equilibrium = 10;
/// Pins that were stopped move on after a full step once forces are within this multiple of the load.
constexpr double relaxed_residual = 1;
/// Steps of an increment after which they move on in any case.
constexpr int max_steps_between_moves = 5;
/// Force residual below which contacts count as carrying the load and no more.
constexpr double balanced = 1;
/// Drift of the centroid, in bounding box diagonals, after which the cloth counts as falling without end.
constexpr double max_drift = 100;

/// How a level ends.
struct End {
  Outcome outcome;
  std::string message = {};
  std::string after_pins = {};  // follows the text of pins that are short of their targets
};

/// The loop over the implicit steps of one minimisation: what comes between them, and how the level ends.
class Newton {
 public:
  Newton(Objective& objective, Positions x, const NewtonParameters& parameters, const LevelRun& run)
      : f_(objective),
        p_(parameters),
        run_(run),
        result_(run.before),
        iterate_(objective, result_),
        check_(iterate_, parameters),
        step_(
            iterate_, check_, parameters, [this](int k) { report(k); }, [this] { return is_to_end(); },
            run.hierarchy),
        dirichlet_(iterate_, step_, run.load_stepping != nullptr),
        load_(run.load_stepping, iterate_, dirichlet_, run.observer),
        saddle_exit_(
            iterate_, step_.factor(), check_, parameters, [this] { report(0); },
            [this] { return run_.observer.stop_requested(); }) {
    result_.x = std::move(x);
    result_.level = f_.model().level().index;
  }

  LevelResult run() {
    if (run_.from)
      restore(*run_.from);
    else if (!begin())
      return finish({Outcome::infeasible, "energy or forces at the start are not finite: " +
                                              fault_at_start(f_, iterate_.x(), iterate_.gradient())});
    for (bool step_begun = run_.from != nullptr;; step_begun = false) {
      if (!step_begun)
        if (const std::optional<End> end = begin_step_unless_ended()) return finish(*end);
      if (run_.observer.checkpoint_due()) run_.observer.checkpoint(state());
      if (const std::optional<End> end = requested_end()) return finish(*end);
      if (const std::string failure = step_.solve(); !failure.empty()) {
        stuck_ = step_.factor().fault().empty() && (dirichlet_.active() || is_at_rounding_floor());
        // Round-off may hide descent within the level's own tolerance.
        stuck_ = stuck_ || (saddle_exit_.end_tightening() && check_.in_tolerance());
        if (!stuck_) return finish({Outcome::stalled, failure});
        step_.controller().abandon_step();
      }
      // A resumed run repeats the step, from the last checkpoint.
      if (step_.interrupted() && run_.observer.stop_requested())
        return finish({Outcome::cancelled, "stopped on request"});
      if (const double drift = check_.drift(); drift > max_drift)
        return finish({Outcome::infeasible, drift_text(drift, max_drift, f_.model())});
      // A step without descent says nothing of the forces: increase_penalty() follows, which moves pins, too.
      if (dirichlet_.is_moving() && !stuck_) move_on_if_relaxed();
    }
  }

 private:
  /// Returns false if the start has no finite energy and forces.
  bool begin() {
    f_.contacts().set_stiffness(run_.stiffness);
    f_.contacts().begin_step(iterate_.x());
    iterate_.evaluate();
    if (std::isfinite(iterate_.energy()))
      iterate_.update_residual();
    else
      result_.force_residual = std::numeric_limits<double>::quiet_NaN();
    if (!std::isfinite(iterate_.force_residual())) return false;
    dirichlet_.enforce();
    check_.restart_drift();  // what pins carry along has not drifted
    check_.set_slack(load_.slack());
    return true;
  }

  /// The state at the beginning of a step.
  NewtonState state() const {
    NewtonState s;
    s.so_far = result_;
    s.so_far.seconds += watch_.seconds();
    load_.store_progress(s.so_far);
    s.iterate = iterate_.state();
    s.step = step_.state();
    s.check = check_.state();
    s.dirichlet = dirichlet_.state();
    s.load_stepper = load_.state();
    s.contacts = f_.contacts().memory();
    s.switched_to_plain = switched_to_plain_;
    s.saddle_exit = saddle_exit_.state();
    return s;
  }

  void restore(const NewtonState& s) {
    result_ = s.so_far;
    iterate_.restore(s.iterate);
    check_.restore(s.check);
    load_.restore(s.load_stepper);
    saddle_exit_.restore(s.saddle_exit);
    switched_to_plain_ = s.switched_to_plain;
    if (switched_to_plain_) f_.switch_to_plain();
    dirichlet_.restore(s.dirichlet);
    f_.contacts().restore(s.contacts, iterate_.x());
    iterate_.evaluate();
    step_.restore(s.step);
  }

  /// Between two steps: ends the level, or does what the state calls for and begins the next step.
  std::optional<End> begin_step_unless_ended() {
    while (true) {
      bool at_floor = stuck_ || (check_.is_idle() && (dirichlet_.active() || is_at_rounding_floor()));
      stuck_ = false;
      // Pins that contact blocks can squeeze gaps until no step descends, or until steps only stir round-off:
      // they end at their targets or are found out of reach, before the level may end.
      if (at_floor && dirichlet_.active()) {
        increase_penalty();
        at_floor = false;
      }
      while (step_.factor().fault().empty() && dirichlet_.has_penalty() && check_.is_within(near_equilibrium))
        increase_penalty();
      if (!step_.factor().fault().empty()) return End{Outcome::stalled, step_.factor().fault()};
      if (at_floor || load_.steps() == p_.max_steps) saddle_exit_.end_tightening();
      saddle_exit_.limit_tightening();
      const bool in_tolerance = !dirichlet_.active() && check_.in_tolerance();
      const bool at_equilibrium = in_tolerance || at_floor;
      if (at_equilibrium && !load_.loading() && switch_to_plain()) continue;
      if (at_equilibrium && (!load_.loading() || load_.ends_increment()) && leave_saddle()) continue;
      if (saddle_exit_.is_stopped()) return End{Outcome::cancelled, "stopped on request"};
      if (at_equilibrium && !load_.loading()) return end_at_equilibrium(in_tolerance);
      if (load_.loading() && !dirichlet_.active() &&
          (at_equilibrium || load_.advances_at_once(step_.step_length()))) {
        advance_increment(at_equilibrium);
        if (load_.blocked()) return End{Outcome::infeasible, load_.blocked_text()};
      }
      if (check_.is_cycling()) damp_cycle();
      if (load_.steps() == p_.max_steps)
        return End{Outcome::max_steps_reached, max_steps_text(result_, p_, check_)};
      follow_contact_forces();
      step_.begin();
      return std::nullopt;
    }
  }

  /// Raises the stiffness of barriers that carry too much, once the forces nearly balance: before, contacts
  /// carry the motion's impacts. In increments that make room, motion is slow, and what presses is the load.
  void follow_contact_forces() {
    if (!(iterate_.force_residual() < balanced) && !load_.makes_room()) return;
    if (!f_.contacts().raise_stiffness(iterate_.x(), f_.model().material().mean_membrane_modulus())) return;
    start_over();
  }

  /// After the energy has changed at one x.
  void start_over() {
    check_.restart();
    iterate_.evaluate();
    iterate_.update_residual();
  }

  std::optional<End> requested_end() {
    if (run_.observer.stop_requested()) return End{Outcome::cancelled, "stopped on request"};
    if (run_.finer_follows && run_.observer.refine_requested())
      return End{Outcome::refined_early_on_request,
                 "refined on request; force residual " + three_digits(iterate_.force_residual())};
    return std::nullopt;
  }

  /// Asked within steps of several iterations.
  bool is_to_end() { return run_.observer.stop_requested() || check_.drift() > max_drift; }

  bool is_at_rounding_floor() { return check_.is_at_rounding_floor(step_.factor()); }

  /// At the equilibrium of a proxy, restarts with the plain energy. Returns false if there is
  /// nothing to switch to, or if Dirichlet targets are infeasible.
  bool switch_to_plain() {
    if (dirichlet_.infeasible() || !f_.switch_to_plain()) return false;
    switched_to_plain_ = true;
    step_.controller().restart();
    start_over();
    return true;
  }

  /// At an equilibrium: if it is a saddle, goes on from a state of lower energy.
  bool leave_saddle() {
    const bool is_balanced = iterate_.force_residual() < balanced;
    if (dirichlet_.infeasible() || !is_balanced || !saddle_exit_.leave(!load_.loading())) return false;
    start_over();
    return true;
  }

  End end_at_equilibrium(bool in_tolerance) {
    load_.report_increment();
    const bool is_balanced = in_tolerance || iterate_.force_residual() < balanced;
    const std::string rounding = in_tolerance ? "" : rounding_text(result_, p_, check_.rounding_residual());
    if (dirichlet_.infeasible())
      return {Outcome::infeasible, "", is_balanced ? "the rest of the cloth is at equilibrium" : rounding};
    if (is_balanced && saddle_exit_.at_saddle()) return {Outcome::saddle, saddle_exit_.text()};
    if (!saddle_exit_.fault().empty()) add_to_message("stability not tested: " + saddle_exit_.fault());
    if (in_tolerance) return {Outcome::converged};
    return {is_balanced ? Outcome::converged_to_rounding : Outcome::stalled, rounding};
  }

  /// Steps repeat each other: damps the lag of friction, which such steps mostly come from, or h.
  void damp_cycle() {
    if (!f_.contacts().damp_lag()) step_.controller().limit_step_size();
    check_.restart_cycle();
  }

  void advance_increment(bool at_equilibrium) {
    note_unreached_targets();
    f_.contacts().end_lag_damping();
    step_.controller().end_limit();
    saddle_exit_.restart();
    load_.advance(at_equilibrium);
    check_.set_slack(load_.slack());
    check_.restart();
    dirichlet_.enforce();
    check_.restart_drift();
  }

  /// Moves pins on that limits or contact stopped, once the cloth has made room. It need not be at
  /// equilibrium.
  void move_on_if_relaxed() {
    const bool relaxed = step_.step_length() == 1 && iterate_.force_residual() <= relaxed_residual;
    if (!relaxed && load_.steps() % max_steps_between_moves != 0) return;
    dirichlet_.move_on();
    check_.restart();
    check_.restart_drift();
  }

  /// The next increment has other targets, so what this one did not reach would be forgotten: the first such
  /// increment stays in the level's message.
  void note_unreached_targets() {
    constexpr const char* begin = "at pseudo-time ";
    if (dirichlet_.infeasible() && result_.message.find(begin) == std::string::npos)
      add_to_message(begin + three_digits(*load_.time()) + " " + dirichlet_.message());
  }

  void increase_penalty() {
    check_.restart();
    dirichlet_.increase_penalty();
  }

  void report(int iteration) {
    run_.observer.iteration(iteration_row(iterate_, step_, load_, iteration, run_.clock.seconds()),
                            iterate_.x());
  }

  void add_to_message(const std::string& text) {
    result_.message += (result_.message.empty() || text.empty() ? "" : "; ") + text;
  }

  LevelResult finish(const End& end) {
    result_.outcome = end.outcome;
    const bool failed = !has_converged(end.outcome) && end.outcome != Outcome::cancelled &&
                        end.outcome != Outcome::refined_early_on_request && result_.x.allFinite();
    add_to_message(f_.remark());
    add_to_message(end.message);
    // At a start without finite forces pins have not been enforced.
    if (failed && std::isfinite(result_.force_residual) && (dirichlet_.active() || dirichlet_.infeasible()))
      add_to_message(dirichlet_.message());
    add_to_message(end.after_pins);
    if (failed) add_to_message(weak_barrier(f_.model().with_stiffness(f_.contacts().stiffness()), result_.x));
    load_.store_progress(result_);
    result_.seconds += watch_.seconds();
    result_.analyses += step_.factor().analyses();
    record_contacts(f_.contacts(), result_);
    return std::move(result_);
  }

  Objective& f_;
  const NewtonParameters& p_;
  const LevelRun& run_;
  const Stopwatch watch_;
  LevelResult result_;
  Iterate iterate_;
  EquilibriumCheck check_;
  NewtonStep step_;
  DirichletEnforcer dirichlet_;
  LoadStepper load_;
  SaddleExit saddle_exit_;
  bool switched_to_plain_ = false;  // the proxy was replaced by the plain energy
  bool stuck_ = false;  // the last step found no descent, at the rounding floor or with pins under way
};

}  // namespace

LevelResult minimise(Objective& objective, Positions x, const NewtonParameters& parameters,
                     const LevelRun& run) {
  return Newton(objective, std::move(x), parameters, run).run();
}

}  // namespace drape

#include "core/numerics/step/newton_step.h"

#include <algorithm>
#include <cmath>

#include "core/kernel/files/message_text.h"

namespace drape {

namespace {

/// Residual fraction of the force tolerance at which an implicit step counts as solved.
constexpr double solved_fraction = 0.1;
/// Residual fraction below which round-off can mask descent; the step counts as solved.
constexpr double round_off_fraction = 1e-4;
/// Newton iterations of a step after obstacles have moved. Its end state is friction's next reference, and a
/// single iteration overshoots.
constexpr int iterations_after_obstacle_motion = 30;

}  // namespace

NewtonStep::NewtonStep(Iterate& iterate, EquilibriumCheck& check, const NewtonParameters& parameters,
                       std::function<void(int)> report, std::function<bool()> interrupt,
                       const Hierarchy* hierarchy)
    : iterate_(iterate),
      check_(check),
      p_(parameters),
      report_(std::move(report)),
      interrupt_(std::move(interrupt)),
      controller_(parameters),
      factor_(iterate, parameters, hierarchy) {}

void NewtonStep::restore(const State& s) {
  step_.begin(iterate_.x(), s.max_iterations);
  controller_.restore(s.controller);
  line_search_.set_step_length(s.step_length);
  factor_.restore(s.factor);
}

double NewtonStep::step_size() const {
  return controller_.is_static() ? controller_.state().cycle_limit : controller_.step_size();
}

bool NewtonStep::factorise(bool with_inertia) {
  const double longest = 1 / (StepController::max_step_size * StepController::max_step_size);
  const double mass_shift = controller_.mass_shift();
  return factor_.update(with_inertia ? mass_shift : std::min(longest, mass_shift),
                        line_search_.step_length());
}

void NewtonStep::begin() {
  ActiveContacts& contacts = iterate_.objective().contacts();
  const bool had_friction = contacts.has_friction();
  int iterations = p_.iterations_per_step;
  if (contacts.advected() && had_friction)
    iterations = std::max(iterations, iterations_after_obstacle_motion);
  step_.begin(iterate_.x(), iterations);
  contacts.begin_step(iterate_.x());
  if (had_friction || contacts.has_friction()) iterate_.evaluate();
}

std::string NewtonStep::solve() {
  controller_.begin_step();
  interrupted_ = false;
  for (int k = 0; k < step_.max_iterations(); ++k) {
    if (std::string fault = iterate(); !fault.empty()) return fault;
    const bool at_equilibrium = check_.in_tolerance();
    report_(k);  // with the force residual that was checked
    if (at_equilibrium) break;
    if (k + 1 == step_.max_iterations()) continue;
    interrupted_ = interrupt_();
    if (interrupted_) break;
    step_.evaluate(iterate_, controller_.inverse_h2());
    if (is_solved_to(solved_fraction)) break;
  }
  ++iterate_.result().steps;
  check_.note_step(step_.inertia());
  controller_.end_step(iterate_.force_residual());
  return "";
}

/// Whether the step's gradient is below this fraction of the force tolerance. A tolerance above the load
/// itself leaves convergence to the decrement, and says nothing of a step.
bool NewtonStep::is_solved_to(double fraction) const {
  return free_norm(step_.gradient(), iterate_.fixed()) <=
         fraction * std::min(check_.force_tolerance(), 1.0) * iterate_.residual_scale();
}

std::string NewtonStep::iterate() {
  LevelResult& result = iterate_.result();
  while (true) {
    step_.evaluate(iterate_, controller_.inverse_h2());
    if (!factor_.solve(controller_.mass_shift(), line_search_.step_length(), step_.gradient(), direction_))
      return factor_.fault();
    direction_ *= -1;
    if (line_search_.search(iterate_, step_, direction_)) break;
    if (is_solved_to(round_off_fraction)) {
      line_search_.set_step_length(1);  // a step that round-off keeps from moving counts as a full one
      break;
    }
    // The step is too long for its quadratic model: damp it more.
    if (!controller_.damp())
      return "the line search found no descent " +
             (controller_.is_static()
                  ? "(the direction's slope is " + three_digits(line_search_.slope()) + ")"
                  : "at any step size down to " + three_digits(StepController::min_step_size) + " s") +
             iterate_.limit_text();
  }
  const double length = std::sqrt(direction_.squaredNorm() / std::max(iterate_.free_count(), 1.0));
  // A bound of what the first h would give: ‖p‖ rises with h, and ‖p‖/h² falls.
  const double shrunk = std::max(p_.step_size / controller_.step_size(), 1.0);
  const double decrement = length / p_.step_size * shrunk * shrunk;
  check_.note_decrement(decrement);
  result.decrement = decrement;
  ++result.iterations;
  iterate_.update_residual();
  controller_.end_iteration(line_search_.step_length());
  return "";
}

}  // namespace drape

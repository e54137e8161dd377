#include "core/kernel/solve/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/kernel/linear_algebra/block_cholesky.h"
#include "core/kernel/mesh/message_text.h"
#include "core/kernel/model/stretch_limit.h"
#include "core/kernel/model/weak_barrier.h"
#include "core/kernel/solve/dirichlet_enforcer.h"
#include "core/kernel/solve/newton_state.h"
#include "core/kernel/solve/rounding_floor.h"
#include "core/kernel/solve/start_fault.h"

namespace drape {

namespace {

/// Armijo constant of the line search.
constexpr double sufficient_decrease = 1e-4;
constexpr double min_step_length = 1e-6;
/// A step length below this shows that h was too long.
constexpr double short_step = 0.25;
/// Residual fraction of the force tolerance at which an implicit step counts as solved.
constexpr double solved_fraction = 0.1;
/// Residual fraction below which round-off can mask descent; the step counts as solved.
constexpr double round_off_fraction = 1e-4;
/// Marks a step without a step length along the direction of an updated Hessian.
constexpr double no_updated_direction = 2;
/// Relative differences of energies below this are round-off.
constexpr double energy_noise = 1e-12;
/// The Dirichlet penalty doubles when the force residual falls to this multiple of the tolerance.
constexpr double near_equilibrium = 10;
/// At equilibrium, an increment that advances by less than this fraction is blocked …
constexpr double blocked_increment = 1e-3;
/// … and infeasible after so many blocked attempts in a row, …
constexpr int max_blocked_increments = 20;
/// … or at once below this gap, as a fraction of the bounding box diagonal: cloth between two surfaces that
/// close cannot widen its gaps.
constexpr double min_gap = 1e-7;
/// Extrapolate at most four times the last increment.
constexpr double max_trust = 4;
/// Trust the predictor so far that equilibrium corrects this fraction of its displacement.
constexpr double predictor_error = 0.1;
/// Smallest pass of the predictor, as a fraction of its whole reach.
constexpr double min_pass = 1e-3;
constexpr int max_passes = 100;
/// The predictor stops once it has reduced the smallest gap to this fraction.
constexpr double gap_reduction = 0.5;
/// Newton iterations of a step after obstacles have moved. Its end state is friction's next reference, and a
/// single iteration overshoots.
constexpr int iterations_after_obstacle_motion = 30;
/// Near a strain limit full steps gain no margin, and forces stay a thousand times the load: after 20 such
/// steps divide h by 16. h grows again once forces are of the load's size, or after 20 steps without a stall.
constexpr double stall_residual = 1e3, recovered_residual = 10, back_off = 16;
constexpr int max_stall_count = 20;
constexpr double min_step_size = 1e-8;
constexpr double max_added_mass = 1 / (min_step_size * min_step_size);
/// Steps between checks of the residual on the next level, which costs an evaluation of its contacts and
/// forces.
constexpr int residual_check_interval = 4;
/// Drift of the centroid, in bounding box diagonals, after which the cloth counts as falling without end.
constexpr double max_drift = 100;
/// Fractions of the PSD projection that `adaptive` tries, in this order.
constexpr double blends[] = {0, 0.05, 0.1, 0.2, 0.4, 0.7, 1};
static_assert(std::size(blends) == psd_blend_count);

/// The state of one minimisation; each member function is one phase of an iteration.
class Newton {
 public:
  Newton(Objective& objective, Positions x, const NewtonParameters& parameters, const LevelRun& run)
      : f_(objective),
        model_(objective.model()),
        p_(parameters),
        run_(run),
        observer_(run.observer),
        load_stepping_(run.load_stepping),
        dirichlet_(model_),
        h_(parameters.step_size) {
    result_.x = std::move(x);
    result_.level = model_.level().index;
    result_.message = run.remark;
    result_.seconds_by_phase = run.spent;
    for (const auto& [phase, seconds] : run.spent) result_.seconds += seconds;
    update_constraints();
    const Positions& rest = model_.level().rest.vertices;
    bounding_box_diagonal_ = (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm();
  }

  LevelResult run() {
    if (run_.from)
      restore(*run_.from);
    else if (!begin())
      return finish(Outcome::infeasible,
                    "energy or forces at the start are not finite: " + fault_at_start(f_, result_.x, g_));
    bool stuck = false;  // the last step found no descent, at the rounding floor
    for (bool step_begun = run_.from != nullptr;; step_begun = false) {
      if (!step_begun) {
        bool at_floor = stuck || (idle_.many() && is_at_rounding_floor());
        stuck = false;
        if (at_floor && dirichlet_.active()) {
          increase_penalty();
          at_floor = false;
        }
        while (dirichlet_.active() && result_.force_residual <= near_equilibrium * p_.force_tolerance)
          increase_penalty();
        const bool in_tolerance = !dirichlet_.active() && converged();
        const bool at_equilibrium = in_tolerance || at_floor;
        const bool loading = load_stepping_ && !load_stepping_->finished();
        if (at_equilibrium && !loading) {
          if (switch_to_plain()) continue;
          return finish_at_equilibrium(in_tolerance);
        }
        if (run_.finer_follows && early_refinement_due())
          return finish(Outcome::refined_early_at_tolerance, "");
        // The remainder of an increment waits for equilibrium: each partial increment shrinks gaps tenfold,
        // and a step widens them only twofold.
        const bool at_once = loading && !load_stepping_->equilibrates() && load_stepping_->complete();
        if (loading && !dirichlet_.active() && (at_equilibrium || at_once)) {
          advance_increment(at_equilibrium);
          if (blocked_increments_ >= max_blocked_increments)
            return finish(Outcome::infeasible, "the increment to pseudo-time " +
                                                   three_digits(load_stepping_->time()) +
                                                   " cannot be completed" + limited_by());
        }
        if (result_.steps - increment_start_.steps == p_.max_steps)
          return finish(Outcome::max_steps_reached,
                        "no equilibrium within max_steps = " + std::to_string(p_.max_steps) +
                            "; force residual " + three_digits(result_.force_residual) +
                            (dirichlet_.active() ? "; " + dirichlet_.message(result_.x) : ""));
        begin_step();
      }
      if (observer_.checkpoint_due()) observer_.checkpoint(state());
      if (observer_.stop_requested()) return finish(Outcome::cancelled, "stopped on request");
      if (run_.finer_follows && observer_.refine_requested())
        return finish(Outcome::refined_early_on_request,
                      "refined on request; force residual " + three_digits(result_.force_residual));
      const double step_size = h_;
      if (!step()) {
        stuck = is_at_rounding_floor();
        if (!stuck) return finish(Outcome::stalled, message_);
        h_ = step_size;
        added_mass_ = 0;
      }
      const double drift = (free_centroid() - initial_centroid_).norm() / bounding_box_diagonal_;
      if (drift > max_drift)
        return finish(Outcome::infeasible,
                      "nothing holds the cloth: it has drifted by " + three_digits(drift) +
                          " of its diagonals and does not come to rest; pin it, put something under it, or "
                          "raise the friction");
    }
  }

 private:
  /// Returns false if the start has no finite energy and forces.
  bool begin() {
    f_.contacts().begin_step(result_.x);
    evaluate();
    if (std::isfinite(energy_)) update_residual();
    if (!std::isfinite(energy_) || !std::isfinite(result_.force_residual)) return false;
    initial_centroid_ = free_centroid();
    enforce_dirichlet();
    return true;
  }

  /// The state after begin_step().
  NewtonState state() const {
    NewtonState s;
    s.so_far = result_;
    s.so_far.seconds += watch_.seconds();
    s.step_size = h_;
    s.step_length = alpha_;
    s.residual_scale = scale_;
    s.psd_blend = blend_;
    std::copy_n(decrements_, 3, s.decrements.begin());
    s.limited_by = limit_.by;
    s.switched_to_plain = switched_to_plain_;
    s.dirichlet = dirichlet_.state();
    if (load_stepping_) s.so_far.load_stepping = load_stepping_->state();
    s.increment_start = increment_start_;
    s.response = response_;
    s.blocked_increments = blocked_increments_;
    s.iterations_of_step = iterations_of_step_;
    s.stall_count = stall_count_;
    s.backed_off = backed_off_;
    s.idle = idle_.state();
    s.initial_centroid = {initial_centroid_.x(), initial_centroid_.y(), initial_centroid_.z()};
    s.contacts = f_.contacts().memory();
    s.pattern = f_.pattern_state();
    s.analysis = cholesky_.analysis();
    s.factor_age = factor_age_;
    if (cholesky_.has_factor() && factor_age_ < p_.hessian_update_interval) {
      s.factor_shift = factor_shift_;
      s.factor_values = factored_->values;
    }
    return s;
  }

  void restore(const NewtonState& s) {
    result_ = s.so_far;
    h_ = s.step_size;
    alpha_ = s.step_length;
    scale_ = s.residual_scale;
    blend_ = s.psd_blend;
    std::copy_n(s.decrements.begin(), 3, decrements_);
    limit_.by = s.limited_by;
    factor_age_ = s.factor_age;
    origin_ = result_.x;
    switched_to_plain_ = s.switched_to_plain;
    if (switched_to_plain_) f_.switch_to_plain();
    dirichlet_.restore(s.dirichlet);
    update_constraints();
    increment_start_ = s.increment_start;
    response_ = s.response;
    blocked_increments_ = s.blocked_increments;
    iterations_of_step_ = s.iterations_of_step;
    stall_count_ = s.stall_count;
    backed_off_ = s.backed_off;
    idle_.restore(s.idle);
    initial_centroid_ << s.initial_centroid[0], s.initial_centroid[1], s.initial_centroid[2];
    f_.contacts().restore(s.contacts, origin_);
    evaluate();
    if (s.analysis.count == 0) return;
    const std::shared_ptr<const BlockPattern> pattern = f_.restore(s.pattern, origin_);
    cholesky_.restore(pattern, s.analysis);
    if (s.factor_values.empty()) return;
    BlockMatrix matrix(pattern);
    if (s.factor_values.size() != matrix.values.size())
      throw std::runtime_error("the checkpoint's factor belongs to another matrix; run the experiment again");
    matrix.values = s.factor_values;
    cholesky_.factorise(matrix, s.factor_shift * model_.masses());
    restored_matrix_ = std::move(matrix);
    factored_ = &restored_matrix_;
    factor_shift_ = s.factor_shift;
  }

  bool is_static() const { return p_.form == NewtonForm::statics; }
  double inverse_h2() const { return is_static() ? 0 : 1 / (h_ * h_); }

  /// Centroid of the free vertices.
  Eigen::RowVector3d free_centroid() const {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (Eigen::Index i = 0; i < result_.x.rows(); ++i)
      if (!fixed_[i]) sum += result_.x.row(i);
    return sum / std::max(free_count_, 1.0);
  }

  bool converged() {
    if (!(result_.force_residual <= p_.force_tolerance)) return false;  // also false for NaN
    if (p_.decrement_tolerance > 0 &&
        (result_.iterations < 3 || *std::max_element(decrements_, decrements_ + 3) > p_.decrement_tolerance))
      return false;
    update_friction();
    return result_.force_residual <= p_.force_tolerance;
  }

  /// Updates friction's lagged normal forces and tangents to the current state: equilibrium is a fixed point
  /// of the lagging.
  void update_friction() {
    if (!f_.contacts().has_friction()) return;
    f_.contacts().update_lagging(result_.x);
    evaluate();
    update_residual();
  }

  /// Whether all forces are within their round-off bounds. Assembles the Hessian, so it is called only once
  /// progress has stopped.
  bool is_at_rounding_floor() {
    idle_.restart();
    update_friction();
    factor_age_ = p_.hessian_update_interval;  // assemble() overwrites the factor's matrix
    const RoundingFloor floor = rounding_floor(assemble(Projection::none), result_.x, g_, fixed_);
    rounding_residual_ = floor.norm / scale_;
    return floor.reached;
  }

  /// Whether a tolerance asks for early refinement. Never at the start, under load stepping, or before
  /// Dirichlet vertices have reached their targets.
  bool early_refinement_due() const {
    if (result_.steps == 0 || load_stepping_ || dirichlet_.active() || dirichlet_.infeasible()) return false;
    if (result_.force_residual < p_.early_refinement_tolerance) return true;
    return p_.early_refinement_ratio > 0 && result_.steps % residual_check_interval == 0 &&
           result_.force_residual < p_.early_refinement_ratio * run_.residual_on_next_level(result_.x);
  }

  /// At the equilibrium of a proxy: continues with the plain energy, like a new start. False if there is
  /// none.
  bool switch_to_plain() {
    if (dirichlet_.infeasible() || !f_.switch_to_plain()) return false;
    switched_to_plain_ = true;
    h_ = p_.step_size;
    factor_age_ = p_.hessian_update_interval;
    stall_count_ = 0;
    backed_off_ = false;
    idle_.restart();
    evaluate();
    update_residual();
    return true;
  }

  LevelResult finish_at_equilibrium(bool in_tolerance) {
    if (load_stepping_) report_increment();
    if (!dirichlet_.infeasible())
      return in_tolerance ? finish(Outcome::converged, "")
                          : finish(Outcome::converged_to_rounding,
                                   "the force residual is " + three_digits(result_.force_residual) +
                                       ", above force_tolerance = " + three_digits(p_.force_tolerance) +
                                       ": round-off alone accounts for up to " +
                                       three_digits(rounding_residual_) + " here, and no step lowers it");
    return finish(Outcome::infeasible,
                  dirichlet_.message(result_.x) + "; the rest of the cloth is at equilibrium");
  }

  /// Begins the next increment or continues the current one, as far as limits and contact allow.
  void advance_increment(bool at_equilibrium) {
    const bool begins = load_stepping_->complete();
    if (begins && (at_equilibrium || load_stepping_->increment() > 0)) report_increment();
    if (begins) increment_start_ = {result_.steps, result_.iterations, run_.clock.seconds()};
    const Positions from = result_.x;
    double applied = at_equilibrium && !begins ? extrapolate() : 0;
    Positions predicted = result_.x;
    // If the predictor gains no more than the last time, the obstacles advance without it.
    if (applied < 1 && applied * (1 - response_.fraction) <= response_.fraction) {
      const BoundContacts before = model_.contacts();
      limit_ = load_stepping_->advance(result_.level, result_.x);
      applied += limit_.fraction * (1 - applied);
      predicted = from;  // the cloth has not responded yet
      model_changed(before, result_.x);
    }
    limit_.fraction = applied;
    response_ = at_equilibrium && !load_stepping_->complete()
                    ? IncrementResponse{from, std::move(predicted), applied}
                    : IncrementResponse();
    initial_centroid_ = free_centroid();
    f_.contacts().barrier(result_.x);  // evaluates the contacts for smallest_gap()
    const bool closed =
        f_.contacts().any() && f_.contacts().smallest_gap() < min_gap * bounding_box_diagonal_;
    blocked_increments_ = at_equilibrium && limit_.fraction < blocked_increment
                              ? (closed ? max_blocked_increments : blocked_increments_ + 1)
                              : 0;
    factor_age_ = p_.hessian_update_interval;
    idle_.restart();
    enforce_dirichlet();
  }

  /// Largest extrapolation factor: smaller the more equilibrium has corrected the last prediction.
  double trust_factor() const {
    const double displacement = (response_.predicted - response_.from).norm();
    const double correction = (result_.x - response_.predicted).norm();
    return correction * max_trust < predictor_error * displacement || displacement == 0
               ? max_trust
               : std::max(predictor_error * displacement / correction, 1 / max_trust);
  }

  /// Predictor for an increment that is applied in parts: extrapolates the cloth's response to the last part,
  /// as far as the trust factor allows. In each pass first the cloth moves as far as contact and limits
  /// allow, then the obstacles follow. Returns the fraction applied of the remaining increment; 0 without a
  /// response.
  double extrapolate() {
    const double last = response_.fraction;
    if (last == 0) return 0;
    const Positions from = result_.x, direction = (from - response_.from) * ((1 - last) / last);
    const double reach = std::min(1.0, trust_factor() * last / (1 - last)),
                 gap = f_.contacts().smallest_gap();
    if (reach < blocked_increment) return 0;
    double applied = 0, pass = reach;
    for (int tries = 0; tries < max_passes && applied < reach && pass >= min_pass * reach; ++tries) {
      const Positions here = result_.x;
      pass = std::min(pass, reach - applied);
      trial_ = from + (applied + pass) * direction;
      if (const double allowed = allowed_to(trial_); allowed < 1) {
        pass *= 0.5 * allowed;  // leaves room for the obstacles to follow
        if (pass < min_pass * reach) break;
        trial_ = from + (applied + pass) * direction;
      }
      const BoundContacts before = model_.contacts();
      if (!is_finite_at(trial_) || !load_stepping_->advance_by(pass / (1 - applied), result_.level, trial_)) {
        pass *= 0.5;
        continue;
      }
      result_.x = trial_;
      model_changed(before, here);
      applied += pass;
      if (f_.contacts().smallest_gap() < gap_reduction * gap) break;
      pass *= 2;
    }
    return applied;
  }

  double allowed_to(const Positions& x) {
    PhaseTimer t(result_.seconds_by_phase, "step filter");
    return f_.max_step(result_.x, x).fraction;
  }

  bool is_finite_at(const Positions& x) {
    PhaseTimer t(result_.seconds_by_phase, "gradient");
    return std::isfinite(f_.gradient(x, trial_g_));
  }

  /// The model has changed; its contacts were `before` with the cloth at `from`.
  void model_changed(const BoundContacts& before, const Positions& from) {
    PhaseTimer t(result_.seconds_by_phase, "gradient");  // builds collisions
    f_.model_changed(before, from, result_.x);
  }

  void report_increment() {
    IncrementRow row;
    row.level = result_.level;
    row.increment = load_stepping_->increment();
    row.time = load_stepping_->time();
    row.steps = result_.steps - increment_start_.steps;
    row.iterations = result_.iterations - increment_start_.iterations;
    row.seconds = run_.clock.seconds() - increment_start_.seconds;
    row.energy = energy_ - f_.contacts().friction(result_.x);
    row.force_residual = result_.force_residual;
    row.max_constraint_violation = dirichlet_.max_violation(result_.x);
    observer_.increment_finished(row, result_.x);
  }

  /// Moves Dirichlet vertices to the model's targets, the whole cloth with them by a Newton predictor. If
  /// limits or contact block that move, a penalty takes over.
  void enforce_dirichlet() {
    if (f_.enforces_dirichlet()) dirichlet_.begin(result_.x);
    update_constraints();
    if (!dirichlet_.active()) return;
    if (move_to_targets() < 1) {
      dirichlet_.begin_penalty(limit_.by);
      update_constraints();
    }
  }

  /// Near equilibrium under the penalty: moves Dirichlet vertices to their targets if nothing blocks them,
  /// else increases the penalty or declares them infeasible.
  void increase_penalty() {
    idle_.restart();
    if (move_to_targets(true) < 1) {
      dirichlet_.increase_penalty(result_.x, limit_.by);
      update_constraints();
    }
  }

  /// Moves Dirichlet vertices towards their targets and the other vertices by the linearised response, as far
  /// as limits and contact allow; with `whole`, only if the whole move is feasible. Returns the feasible
  /// fraction.
  double move_to_targets(bool whole = false) {
    const Positions displacement = dirichlet_.displacement_to_targets(result_.x);
    std::vector<char> fixed = fixed_;
    fixed_ = model_.fixed();
    origin_ = result_.x;
    factor_age_ = p_.hessian_update_interval;
    factorise();
    factored_->multiply(displacement, r_);
    for (const DirichletVertex& d : model_.dirichlet()) r_.row(d.vertex).setZero();
    cholesky_.solve(r_, direction_);
    direction_ = displacement - direction_;
    factor_age_ = p_.hessian_update_interval;
    trial_ = result_.x + direction_;
    model_.set_dirichlet(trial_);
    limit_ = f_.max_step(result_.x, trial_);
    double fraction = limit_.fraction;
    while (fraction > min_step_length) {
      if (fraction < 1) trial_ = result_.x + fraction * direction_;
      if (std::isfinite(f_.gradient(trial_, trial_g_))) break;
      fraction *= 0.5;
    }
    fixed_ = std::move(fixed);
    if (fraction == 1) {
      dirichlet_.set_satisfied();
      result_.x = trial_;
    } else if (!whole && fraction > min_step_length) {
      result_.x = trial_;
    }
    update_constraints();
    return fraction;
  }

  /// To be called when fixed vertices or the penalty have changed; re-evaluates the objective.
  void update_constraints() {
    fixed_ = dirichlet_.fixed();
    free_count_ = static_cast<double>(std::count(fixed_.begin(), fixed_.end(), 0));
    f_.set_penalty(dirichlet_.penalty());
    if (g_.rows() == 0) return;
    evaluate();
    update_residual();
  }

  void evaluate() {
    PhaseTimer t(result_.seconds_by_phase, "gradient");
    energy_ = f_.gradient(result_.x, g_);
  }

  void begin_step() {
    origin_ = result_.x;
    iterations_of_step_ = p_.iterations_per_step;
    if (f_.contacts().advected() && f_.contacts().has_friction())
      iterations_of_step_ = std::max(iterations_of_step_, iterations_after_obstacle_motion);
    const bool had_friction = f_.contacts().has_friction();
    f_.contacts().begin_step(origin_);
    if (had_friction || f_.contacts().has_friction()) evaluate();
  }

  /// Solves the implicit step that begin_step() began. Returns false if there is no descent.
  bool step() {
    updated_alpha_ = no_updated_direction;
    for (int k = 0; k < iterations_of_step_; ++k) {
      if (!iterate(k)) return false;
      if (converged()) break;
      if (k + 1 == iterations_of_step_) continue;
      shifted_gradient();
      if (is_solved_to(solved_fraction)) break;
    }
    ++result_.steps;
    idle_.note(energy_, result_.force_residual, noise_of_energy());
    adapt_step_size();
    return true;
  }

  /// Adapts h to the last step length along the direction of an updated Hessian, and to stalls.
  void adapt_step_size() {
    stall_count_ = result_.force_residual > stall_residual ? std::max(stall_count_, 0) + 1
                                                           : std::min(stall_count_, 0) - 1;
    if (stall_count_ == max_stall_count) {
      backed_off_ = true;
      stall_count_ = 0;
      h_ = std::max(h_ / back_off, min_step_size);
    }
    if (result_.force_residual < recovered_residual || stall_count_ == -max_stall_count) backed_off_ = false;
    if (backed_off_) return;
    if (updated_alpha_ == 1) h_ = std::max(h_, std::min(h_ * p_.step_growth, p_.step_size_limit));
    if (updated_alpha_ < short_step) h_ /= p_.step_growth;
  }

  /// Whether the residual force of the implicit step is below this fraction of the force tolerance.
  bool is_solved_to(double fraction) const {
    return free_norm(r_, fixed_) <= fraction * p_.force_tolerance * scale_;
  }

  bool iterate(int iteration) {
    while (true) {
      shifted_gradient();
      factorise();
      {
        PhaseTimer t(result_.seconds_by_phase, "solve");
        cholesky_.solve(r_, direction_);
        direction_ *= -1;
      }
      if (line_search()) break;
      if (is_solved_to(round_off_fraction)) {
        alpha_ = 1;  // of a zero step
        break;
      }
      // A stale factor may give no descent: update the Hessian first. If that does not help, the step is too
      // long for its quadratic model: damp it more.
      if (factor_age_ > 0) {
        factor_age_ = p_.hessian_update_interval;
        continue;
      }
      if (is_static()) {
        if (add_mass()) continue;
        message_ = "the line search found no descent (the direction's slope is " + three_digits(slope_) +
                   ")" + limited_by();
        return false;
      }
      h_ /= 4;
      factor_age_ = p_.hessian_update_interval;
      if (h_ < min_step_size) {
        message_ = "the line search found no descent at any step size down to 1e-8 s" + limited_by();
        return false;
      }
    }
    const double decrement = std::sqrt(direction_.squaredNorm() / std::max(free_count_, 1.0)) / h_;
    decrements_[result_.iterations % 3] = decrement;
    result_.decrement = decrement;
    ++result_.iterations;
    added_mass_ = 0;
    update_residual();
    report(iteration);
    update_factor_age();
    return true;
  }

  /// Shortens the static form's direction by adding mass. In free fall the matrix is positive definite only
  /// by round-off, and the direction so long that contact cuts the step to nothing.
  bool add_mass() {
    factor_age_ = p_.hessian_update_interval;
    added_mass_ = std::max(10 * added_mass_, first_added_mass());
    return added_mass_ < max_added_mass;
  }

  /// Positive for every step size, since multiplication increases it.
  double first_added_mass() const { return std::max(1e-3 / (p_.step_size * p_.step_size), 1e-30); }

  /// Names what limited the last step, for messages.
  std::string limited_by() const { return limit_.by.empty() ? "" : "; the step is limited by " + limit_.by; }

  /// Ages the factor. A shortened step along the direction of an old factor makes it stale; only the
  /// direction of an updated Hessian tells about h.
  void update_factor_age() {
    if (factor_age_ == 0) updated_alpha_ = std::min(updated_alpha_, alpha_);
    const bool stale = factor_age_ > 0 && alpha_ < 1;
    factor_age_ = stale ? p_.hessian_update_interval : factor_age_ + 1;
  }

  /// r = ∇F(x) + M (x − x^t) / h², zero on fixed vertices.
  void shifted_gradient() {
    r_ = g_;
    inertia_ = 0;
    const double s = inverse_h2();
    for (Eigen::Index i = 0; i < r_.rows(); ++i) {
      if (fixed_[i]) {
        r_.row(i).setZero();
        continue;
      }
      const double m = s * model_.masses()[i];
      const Eigen::RowVector3d moved = result_.x.row(i) - origin_.row(i);
      r_.row(i) += m * moved;
      inertia_ += 0.5 * m * moved.squaredNorm();
    }
  }

  double inertia_at(const Positions& x) const {
    double sum = 0;
    const double s = inverse_h2();
    if (s > 0)
      for (Eigen::Index i = 0; i < x.rows(); ++i)
        sum += 0.5 * s * model_.masses()[i] * (x.row(i) - origin_.row(i)).squaredNorm();
    return sum;
  }

  void factorise() {
    if (cholesky_.has_factor() && factor_age_ < p_.hessian_update_interval) return;
    factor_age_ = 0;
    const bool adaptive = p_.projection != Projection::none && p_.psd_blend == PsdBlend::adaptive;
    if (adaptive && factorise_adaptive()) return;
    const BlockMatrix& matrix = assemble(p_.projection);
    if (!adaptive && try_factor(matrix, 0)) return;
    // Without projection, or with a rigid mode in the static form: add mass until it factorises.
    for (double shift = first_added_mass(); shift < 1e30; shift *= 10)
      if (try_factor(matrix, shift)) return;
    throw std::runtime_error(
        "the Newton matrix is not positive definite with any shift: it holds NaN or infinite entries");
  }

  /// Factorises the Hessian with the smallest PSD blend for which it is positive definite. Starts at the last
  /// blend, or at the next smaller one after a full step.
  bool factorise_adaptive() {
    constexpr int last = static_cast<int>(std::size(blends)) - 1;
    for (blend_ = alpha_ == 1 ? std::max(blend_ - 1, 0) : blend_; blend_ <= last; ++blend_)
      if (try_factor(assemble({p_.projection, blends[blend_]}), 0)) return true;
    blend_ = last;
    return false;
  }

  const BlockMatrix& assemble(Projection projection) {
    PhaseTimer t(result_.seconds_by_phase, "hessian");
    return f_.matrix(result_.x, projection);
  }

  bool try_factor(const BlockMatrix& matrix, double extra_shift) {
    {
      PhaseTimer t(result_.seconds_by_phase, "analyse");
      cholesky_.analyse(matrix.pattern, fixed_);
    }
    PhaseTimer t(result_.seconds_by_phase, "factorise");
    ++result_.factorisations;
    result_.flops += cholesky_.flops();
    factored_ = &matrix;
    factor_shift_ = inverse_h2() + added_mass_ + extra_shift;
    return cholesky_.factorise(matrix, factor_shift_ * model_.masses());
  }

  /// Backtracking line search from the largest step that limits and contact allow. Updates x, g and the
  /// energy.
  bool line_search() {
    slope_ = r_.cwiseProduct(direction_).sum();
    if (!(slope_ < 0)) return false;
    {
      PhaseTimer t(result_.seconds_by_phase, "step filter");
      trial_ = result_.x + direction_;
      limit_ = f_.max_step(result_.x, trial_);
    }
    PhaseTimer t(result_.seconds_by_phase, "gradient");
    const double force_before = free_norm(r_, fixed_);
    for (alpha_ = limit_.fraction; alpha_ >= min_step_length; alpha_ *= 0.5) {
      trial_ = result_.x + alpha_ * direction_;
      const double energy = f_.gradient(trial_, trial_g_);
      if (!std::isfinite(energy)) continue;
      const double change = energy - energy_ + inertia_at(trial_) - inertia_;
      bool accept = change <= sufficient_decrease * alpha_ * slope_;
      if (!accept && std::abs(change) <= noise_of_energy())
        accept = shifted_norm(trial_, trial_g_) < force_before;
      if (!accept) continue;
      result_.x.swap(trial_);
      g_.swap(trial_g_);
      energy_ = energy;
      return true;
    }
    return false;
  }

  /// Energy differences below this are round-off [J]. The scale includes the load, because terms of the
  /// energy cancel while their round-off does not.
  double noise_of_energy() const {
    return energy_noise * (std::abs(energy_ + inertia_) + scale_ * std::sqrt(free_count_));
  }

  double shifted_norm(const Positions& x, const Positions& g) const {
    double sum = 0;
    const double s = inverse_h2();
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      if (!fixed_[i]) sum += (g.row(i) + s * model_.masses()[i] * (x.row(i) - origin_.row(i))).squaredNorm();
    return std::sqrt(sum);
  }

  void update_residual() {
    scale_ = f_.residual_scale(result_.x, g_);
    result_.force_residual = free_norm(g_, fixed_) / scale_;
  }

  void report(int iteration) {
    IterationRow row;
    row.level = result_.level;
    row.step = result_.steps;
    row.iteration = iteration;
    const ActiveContacts& contacts = f_.contacts();
    row.energy = energy_ - contacts.friction(result_.x);
    if (f_.is_proxy()) {
      row.proxy_energy = row.energy;
      row.energy = f_.plain_energy(result_.x);
    }
    if (contacts.any()) {
      row.contacts = contacts.count();
      row.smallest_gap = contacts.smallest_gap();
    }
    row.decrement = result_.decrement;
    row.force_residual = result_.force_residual;
    row.step_length = alpha_;
    row.step_size = is_static() ? std::numeric_limits<double>::infinity() : h_;
    if (load_stepping_) row.time = load_stepping_->time();
    row.seconds = run_.clock.seconds();
    row.flops = result_.flops;
    observer_.iteration(row, result_.x);
  }

  void add_to_message(const std::string& text) {
    if (!result_.message.empty() && !text.empty()) result_.message += "; ";
    result_.message += text;
  }

  LevelResult finish(Outcome outcome, const std::string& message) {
    result_.outcome = outcome;
    add_to_message(message);
    const bool failed =
        !succeeded(outcome) && outcome != Outcome::cancelled && outcome != Outcome::refined_early_on_request;
    if (failed && result_.x.allFinite()) add_to_message(weak_barrier(model_, result_.x));
    if (load_stepping_) result_.load_stepping = load_stepping_->state();
    result_.seconds += watch_.seconds();
    result_.analyses = cholesky_.analyses();
    if (f_.contacts().any()) {
      result_.smallest_gap = f_.contacts().smallest_gap();
      // Collisions are built while energies are evaluated.
      result_.seconds_by_phase["collisions"] = f_.contacts().seconds_building();
      result_.seconds_by_phase["gradient"] -= f_.contacts().seconds_building();
    }
    return std::move(result_);
  }

  Objective& f_;
  const LevelModel& model_;
  const NewtonParameters& p_;
  const LevelRun& run_;
  const Stopwatch watch_;
  Observer& observer_;
  LoadStepping* load_stepping_;
  DirichletEnforcer dirichlet_;
  std::vector<char> fixed_;         // one flag a vertex: 1 where it is fixed now
  IncrementStart increment_start_;  // of the current increment
  IncrementResponse response_;      // to its last part
  int blocked_increments_ = 0;
  bool switched_to_plain_ = false;  // the proxy was replaced by the plain energy
  IdleSteps idle_;
  double rounding_residual_ = 0;  // bound on the residual by round-off, at the last check
  int stall_count_ = 0;           // consecutive steps
  bool backed_off_ = false;       // h was reduced and does not grow
  int iterations_of_step_ = 1;    // maximum of the current step

  BlockCholesky cholesky_;
  const BlockMatrix* factored_ = nullptr;  // of the factor: the objective's or restored_matrix_
  BlockMatrix restored_matrix_;
  double factor_shift_ = 0;
  LevelResult result_;
  std::string message_;
  StepLimit limit_;
  Positions origin_, g_, r_, direction_, trial_, trial_g_;
  double energy_ = 0, inertia_ = 0, slope_ = 0, alpha_ = 1, scale_ = 1;
  Eigen::RowVector3d initial_centroid_;
  double bounding_box_diagonal_ = 1;
  double h_, free_count_ = 0, updated_alpha_ = no_updated_direction;
  int blend_ = std::size(blends) - 1;
  double decrements_[3] = {};
  int factor_age_ = 0;
  double added_mass_ = 0;  // of the static form, as 1/h² [1/s²]
};

}  // namespace

LevelResult minimise(Objective& objective, Positions x, const NewtonParameters& parameters,
                     const LevelRun& run) {
  return Newton(objective, std::move(x), parameters, run).run();
}

}  // namespace drape

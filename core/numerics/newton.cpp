#include "core/numerics/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/mesh/message_text.h"
#include "core/model/stretch_limit.h"
#include "core/model/weak_barrier.h"
#include "core/numerics/block_cholesky.h"
#include "core/numerics/hard_positions.h"
#include "core/numerics/newton_state.h"
#include "core/numerics/rounding_floor.h"
#include "core/numerics/start_fault.h"

namespace drape {

namespace {

constexpr double sufficient_decrease = 1e-4;
constexpr double shortest_step = 1e-6;
/// A line search that leaves less than this of a step says that h was too long.
constexpr double shortened = 0.25;
/// An implicit step is solved to this part of the force tolerance.
constexpr double solved_part = 0.1;
/// Where no more than this part of it is left, rounding may hide the descent: then there is none to be made.
constexpr double rounded_part = 1e-4;
/// In place of a step length, where a step had none along the direction of a new matrix.
constexpr double no_fresh_direction = 2;
/// Differences of energies below this part of them are rounding, not descent.
constexpr double energy_noise = 1e-12;
/// Held vertices that are pulled are pulled harder at this many times the force tolerance.
constexpr double near_equilibrium = 10;
/// A change of conditions of which less than this part is made at equilibrium is held up; so often in turn,
/// and it is given up.
constexpr double held_up = 1e-3;
constexpr int most_held_up = 20;
/// At once where a gap is below this part of the cloth's diagonal: pinched between two that close, it does
/// not widen.
constexpr double pinched = 1e-7;
/// A cloth's answer to a part of a change is trusted for so many times as much at most, and else for so much
/// that equilibrium corrects this part of the way. It is followed in so many passes at most, none of less
/// than this part of it, and no farther than where this part of the smallest gap is left: there it leads into
/// what is in the way.
constexpr double most_trusted = 4, wrong_part = 0.1, shortest_pass = 1e-3, squeezed = 0.5;
constexpr int most_passes = 100;
/// Newton iterations of a step after obstacles have moved: friction counts from what it ends with, and
/// one iteration overshoots.
constexpr int carried_iterations = 30;
/// A cloth that is a hair from a limit slides along it: each full step widens what it leaves of the limit no
/// more than the limit's own curve takes away, and forces stay a thousand times the load. After so many such
/// steps h is divided, again and again, until they are as large as loads are, or have been well below that
/// for as long.
constexpr double strained = 1e3, relaxed = 10, slowing = 16;
constexpr int most_strained = 20;
constexpr double smallest_step_size = 1e-8;
constexpr double most_added_mass = 1 / (smallest_step_size * smallest_step_size);
/// In steps: the residual on the next level costs an evaluation of its contacts and forces.
constexpr int residual_check_interval = 4;
/// Free vertices that have gone this many diagonals of the cloth together fall or slide without end.
constexpr double lost_after = 100;
/// Shares of the projection that `least` tries, in turn.
constexpr double shares[] = {0, 0.05, 0.1, 0.2, 0.4, 0.7, 1};
static_assert(std::size(shares) == projection_share_count);

/// The state of one minimisation; each member function is one phase of an iteration.
class Newton {
 public:
  Newton(Objective& objective, Positions x, const NewtonParameters& parameters, const LevelRun& run)
      : f_(objective),
        model_(objective.model()),
        p_(parameters),
        run_(run),
        observer_(run.observer),
        conditions_(run.conditions),
        hard_(model_),
        h_(parameters.step_size) {
    result_.x = std::move(x);
    result_.level = model_.level().index;
    result_.message = run.remark;
    result_.seconds_by_phase = run.spent;
    for (const auto& [phase, seconds] : run.spent) result_.seconds += seconds;
    take_positions();
    const Positions& rest = model_.level().rest.vertices;
    diagonal_ = (rest.colwise().maxCoeff() - rest.colwise().minCoeff()).norm();
  }

  LevelResult run() {
    if (run_.from)
      restore(*run_.from);
    else if (!begin())
      return finish(Outcome::infeasible,
                    "energy or forces at the start are not finite: " + fault_at_start(f_, result_.x, g_));
    bool stuck = false;  // the last step found no descent but in what rounding makes of the forces
    for (bool step_begun = run_.from != nullptr;; step_begun = false) {
      if (!step_begun) {
        bool at_floor = stuck || (idle_.many() && is_at_rounding_floor());
        stuck = false;
        if (at_floor && hard_.pulling()) {
          pull_on();
          at_floor = false;
        }
        while (hard_.pulling() && result_.force_residual <= near_equilibrium * p_.force_tolerance) pull_on();
        const bool in_tolerance = !hard_.pulling() && converged();
        const bool settled = in_tolerance || at_floor;
        const bool changing = conditions_ && !conditions_->finished();
        if (settled && !changing) {
          if (relax()) continue;
          return finish_settled(in_tolerance);
        }
        if (run_.finer_follows && hands_on()) return finish(Outcome::handed_on, "");
        // What is left of a change waits for equilibrium: each part of it shrinks gaps tenfold, and a step
        // widens them twofold.
        const bool at_once = changing && !conditions_->settles() && conditions_->made();
        if (changing && !hard_.pulling() && (settled || at_once)) {
          change_conditions(settled);
          if (times_held_up_ >= most_held_up)
            return finish(Outcome::infeasible, "the conditions of pseudo-time " +
                                                   three_digits(conditions_->time()) + " cannot be reached" +
                                                   held());
        }
        if (result_.steps - changed_at_.steps == p_.max_steps)
          return finish(Outcome::out_of_steps,
                        "no equilibrium within max_steps = " + std::to_string(p_.max_steps) +
                            "; force residual " + three_digits(result_.force_residual) +
                            (hard_.pulling() ? "; " + hard_.message(result_.x) : ""));
        begin_step();
      }
      if (observer_.checkpoint_due()) observer_.checkpoint(state());
      if (observer_.stop_requested()) return finish(Outcome::cancelled, "stopped on request");
      if (run_.finer_follows && observer_.refine_requested())
        return finish(Outcome::refined_early,
                      "refined on request; force residual " + three_digits(result_.force_residual));
      const double step_size = h_;
      if (!step()) {
        stuck = is_at_rounding_floor();
        if (!stuck) return finish(Outcome::stalled, message_);
        h_ = step_size;
        added_mass_ = 0;
      }
      const double gone = (middle() - begun_at_).norm() / diagonal_;
      if (gone > lost_after)
        return finish(Outcome::infeasible,
                      "nothing holds the cloth: it has moved on by " + three_digits(gone) +
                          " of its diagonals and does not come to rest; pin it, put something under it, or "
                          "raise the friction");
    }
  }

 private:
  /// False where the start has no finite energy and forces.
  bool begin() {
    f_.contacts().begin_step(result_.x);
    evaluate();
    if (std::isfinite(energy_)) update_residual();
    if (!std::isfinite(energy_) || !std::isfinite(result_.force_residual)) return false;
    begun_at_ = middle();
    bring_held_vertices();
    return true;
  }

  /// After begin_step.
  NewtonState state() const {
    NewtonState s;
    s.so_far = result_;
    s.so_far.seconds += watch_.seconds();
    s.step_size = h_;
    s.step_length = alpha_;
    s.residual_scale = scale_;
    s.projection_share = share_;
    std::copy_n(decrements_, 3, s.decrements.begin());
    s.held_by = limit_.by;
    s.relaxed = relaxed_;
    s.positions = hard_.memory();
    if (conditions_) s.so_far.conditions = conditions_->state();
    s.changed_at = changed_at_;
    s.response = response_;
    s.times_held_up = times_held_up_;
    s.iterations_of_step = iterations_of_step_;
    s.strained_for = strained_for_;
    s.slowed = slowed_;
    s.idle = idle_.memory();
    s.begun_at = {begun_at_.x(), begun_at_.y(), begun_at_.z()};
    s.contacts = f_.contacts().memory();
    s.pattern = f_.pattern_memory();
    s.analysis = cholesky_.analysis();
    s.factor_age = age_;
    if (cholesky_.has_factor() && age_ < p_.refresh) {
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
    share_ = s.projection_share;
    std::copy_n(s.decrements.begin(), 3, decrements_);
    limit_.by = s.held_by;
    age_ = s.factor_age;
    origin_ = result_.x;
    relaxed_ = s.relaxed;
    if (relaxed_) f_.relax();
    hard_.restore(s.positions);
    take_positions();
    changed_at_ = s.changed_at;
    response_ = s.response;
    times_held_up_ = s.times_held_up;
    iterations_of_step_ = s.iterations_of_step;
    strained_for_ = s.strained_for;
    slowed_ = s.slowed;
    idle_.restore(s.idle);
    begun_at_ << s.begun_at[0], s.begun_at[1], s.begun_at[2];
    f_.contacts().restore(s.contacts, origin_);
    evaluate();
    if (s.analysis.count == 0) return;
    const std::shared_ptr<const BlockPattern> pattern = f_.restore(s.pattern, origin_);
    cholesky_.restore(pattern, s.analysis);
    if (s.factor_values.empty()) return;
    BlockMatrix matrix(pattern);
    if (s.factor_values.size() != matrix.values.size())
      throw std::runtime_error("the checkpoint's factor is that of another matrix; run the experiment again");
    matrix.values = s.factor_values;
    cholesky_.factorise(matrix, s.factor_shift * model_.masses());
    kept_ = std::move(matrix);
    factored_ = &kept_;
    factor_shift_ = s.factor_shift;
  }

  bool is_static() const { return p_.form == NewtonForm::statics; }
  double inverse_h2() const { return is_static() ? 0 : 1 / (h_ * h_); }

  /// Mean of the free vertices.
  Eigen::RowVector3d middle() const {
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (Eigen::Index i = 0; i < result_.x.rows(); ++i)
      if (!fixed_[i]) sum += result_.x.row(i);
    return sum / std::max(free_count_, 1.0);
  }

  bool converged() {
    if (!(result_.force_residual <= p_.force_tolerance)) return false;  // NaN is no equilibrium
    if (p_.decrement_tolerance > 0 &&
        (result_.iterations < 3 || *std::max_element(decrements_, decrements_ + 3) > p_.decrement_tolerance))
      return false;
    renew_friction();
    return result_.force_residual <= p_.force_tolerance;
  }

  /// Equilibrium is a fixed point of the lag: with the normal forces of here, not of where the step began.
  void renew_friction() {
    if (!f_.contacts().has_friction()) return;
    f_.contacts().renew_lag(result_.x);
    evaluate();
    update_residual();
  }

  /// Whether the forces are no larger than rounding makes them where x is nearest to equilibrium. Takes a
  /// matrix to find out: for where progress has stopped.
  bool is_at_rounding_floor() {
    idle_.restart();
    renew_friction();
    age_ = p_.refresh;  // the factor's matrix is overwritten
    const RoundingFloor floor = rounding_floor(assemble(Projection::none), result_.x, g_, fixed_);
    rounding_residual_ = floor.norm / scale_;
    return floor.reached;
  }

  /// A start is no preview, pins have to be in their places, and the last of changing conditions is followed
  /// by equilibrium.
  bool hands_on() const {
    if (result_.steps == 0 || conditions_ || !hard_.settled() || hard_.given_up()) return false;
    if (result_.force_residual < p_.refine_at) return true;
    return p_.refine_ratio > 0 && result_.steps % residual_check_interval == 0 &&
           result_.force_residual < p_.refine_ratio * run_.residual_above(result_.x);
  }

  /// At the equilibrium of a proxy: whether its plain energy is to be minimised from here, as if begun anew.
  bool relax() {
    if (hard_.given_up() || !f_.relax()) return false;
    relaxed_ = true;
    changed_at_ = {result_.steps, result_.iterations, run_.clock.seconds()};
    h_ = p_.step_size;
    age_ = p_.refresh;
    strained_for_ = 0;
    slowed_ = false;
    idle_.restart();
    evaluate();
    update_residual();
    return true;
  }

  LevelResult finish_settled(bool in_tolerance) {
    if (conditions_) report_change();
    if (!hard_.given_up())
      return in_tolerance
                 ? finish(Outcome::converged, "")
                 : finish(Outcome::converged_to_rounding,
                          "the force residual has come down to " + three_digits(result_.force_residual) +
                              ", not to force_tolerance = " + three_digits(p_.force_tolerance) +
                              ": rounding alone makes up to " + three_digits(rounding_residual_) +
                              " of it here, and no step lowers it");
    return finish(Outcome::infeasible,
                  hard_.message(result_.x) + "; the rest of the cloth is at equilibrium");
  }

  /// The next change of conditions, or what is left of the one under way, as far as it is allowed.
  void change_conditions(bool settled) {
    const bool begins = conditions_->made();
    if (begins && (settled || conditions_->change() > 0)) report_change();
    if (begins) changed_at_ = {result_.steps, result_.iterations, run_.clock.seconds()};
    const Positions from = result_.x;
    double made = settled && !begins ? follow_change() : 0;
    Positions to = result_.x;
    // Less than the last time, which may be no more than the obstacles go by themselves: they do.
    if (made < 1 && made * (1 - response_.part) <= response_.part) {
      const BoundContacts before = model_.contacts();
      limit_ = conditions_->advance(result_.level, result_.x);
      made += limit_.fraction * (1 - made);
      to = from;  // the answer to this is still to come
      model_changed(before, result_.x);
    }
    limit_.fraction = made;
    response_ =
        settled && !conditions_->made() ? ChangeResponse{from, std::move(to), made} : ChangeResponse();
    begun_at_ = middle();
    f_.contacts().barrier(result_.x);  // where the smallest gap is asked for
    const bool stuck = f_.contacts().any() && f_.contacts().smallest_gap() < pinched * diagonal_;
    times_held_up_ = settled && limit_.fraction < held_up ? (stuck ? most_held_up : times_held_up_ + 1) : 0;
    age_ = p_.refresh;
    idle_.restart();
    bring_held_vertices();
  }

  /// How many times as much of a change the cloth's answer to the last part of it is trusted for: less where
  /// equilibrium is far from where it was taken along to.
  double trust() const {
    const double way = (response_.to - response_.from).norm();
    const double wrong = (result_.x - response_.to).norm();
    return wrong * most_trusted < wrong_part * way || way == 0
               ? most_trusted
               : std::max(wrong_part * way / wrong, 1 / most_trusted);
  }

  /// Where a change is held up a small part of it is made, and the cloth answers. More of it is made at once
  /// by taking the cloth along the same way, as far as the answer is trusted: it goes ahead as far as contact
  /// and limits let it, the obstacles come after it, and so on. The part of what was left of the change that
  /// has been made; 0 where there is no answer yet, or nothing gives way.
  double follow_change() {
    const double last = response_.part;
    if (last == 0) return 0;
    const Positions from = result_.x, way = (from - response_.from) * ((1 - last) / last);
    const double reach = std::min(1.0, trust() * last / (1 - last)), gap = f_.contacts().smallest_gap();
    if (reach < held_up) return 0;
    double made = 0, pass = reach;
    for (int tries = 0; tries < most_passes && made < reach && pass >= shortest_pass * reach; ++tries) {
      const Positions here = result_.x;
      pass = std::min(pass, reach - made);
      trial_ = from + (made + pass) * way;
      if (const double allowed = allowed_to(trial_); allowed < 1) {
        pass *= 0.5 * allowed;  // half of what there is: room for the obstacles to come after
        if (pass < shortest_pass * reach) break;
        trial_ = from + (made + pass) * way;
      }
      const BoundContacts before = model_.contacts();
      if (!is_finite_at(trial_) || !conditions_->advance_by(pass / (1 - made), result_.level, trial_)) {
        pass *= 0.5;
        continue;
      }
      result_.x = trial_;
      model_changed(before, here);
      made += pass;
      if (f_.contacts().smallest_gap() < squeezed * gap) break;
      pass *= 2;
    }
    return made;
  }

  double allowed_to(const Positions& x) {
    PhaseTimer t(result_.seconds_by_phase, "step filter");
    return f_.max_step(result_.x, x).fraction;
  }

  bool is_finite_at(const Positions& x) {
    PhaseTimer t(result_.seconds_by_phase, "gradient");
    return std::isfinite(f_.gradient(x, trial_g_));
  }

  /// Contacts were `before`, with the cloth at `from`.
  void model_changed(const BoundContacts& before, const Positions& from) {
    PhaseTimer t(result_.seconds_by_phase, "gradient");  // contact sets are built
    f_.model_changed(before, from, result_.x);
  }

  void report_change() {
    ChangeRow row;
    row.level = result_.level;
    row.change = conditions_->change();
    row.time = conditions_->time();
    row.steps = result_.steps - changed_at_.steps;
    row.iterations = result_.iterations - changed_at_.iterations;
    row.seconds = run_.clock.seconds() - changed_at_.seconds;
    row.energy = energy_ - f_.contacts().friction(result_.x);
    row.force_residual = result_.force_residual;
    row.farthest_missing = hard_.farthest(result_.x);
    observer_.change_finished(row, result_.x);
  }

  /// Where the model holds vertices at other places than x has them: the cloth as a whole is moved there, as
  /// its matrix would have it, or as far as limits and contact let it; then held vertices are pulled.
  void bring_held_vertices() {
    if (f_.brings_held_vertices()) hard_.begin(result_.x);
    take_positions();
    if (!hard_.pulling()) return;
    if (move_with_held_vertices() < 1) {
      hard_.pull(limit_.by);
      take_positions();
    }
  }

  /// Near equilibrium with held vertices pulled: they are put on their places if nothing is in the way, or
  /// pulled harder, or given up.
  void pull_on() {
    idle_.restart();
    if (move_with_held_vertices(true) < 1) {
      hard_.pull_harder(result_.x, limit_.by);
      take_positions();
    }
  }

  /// Moves x by the held vertices' ways and by what the matrix makes of them elsewhere, so far as is allowed;
  /// with `whole`, only if that is all of it. How far.
  double move_with_held_vertices(bool whole = false) {
    const Positions way = hard_.way(result_.x);
    std::vector<char> fixed = fixed_;
    fixed_ = model_.fixed();
    origin_ = result_.x;
    age_ = p_.refresh;
    factorise();
    factored_->multiply(way, r_);
    for (const HeldVertex& h : model_.held()) r_.row(h.vertex).setZero();
    cholesky_.solve(r_, direction_);
    direction_ = way - direction_;
    age_ = p_.refresh;
    trial_ = result_.x + direction_;
    for (const HeldVertex& h : model_.held()) trial_.row(h.vertex) = h.place.transpose();
    limit_ = f_.max_step(result_.x, trial_);
    double fraction = limit_.fraction;
    while (fraction > shortest_step) {
      if (fraction < 1) trial_ = result_.x + fraction * direction_;
      if (std::isfinite(f_.gradient(trial_, trial_g_))) break;
      fraction *= 0.5;
    }
    fixed_ = std::move(fixed);
    if (fraction == 1) {
      hard_.arrive();
      result_.x = trial_;
    } else if (!whole && fraction > shortest_step) {
      result_.x = trial_;
    }
    take_positions();
    return fraction;
  }

  /// What is fixed and pulled has changed, and so has what is minimised.
  void take_positions() {
    fixed_ = hard_.fixed();
    free_count_ = static_cast<double>(std::count(fixed_.begin(), fixed_.end(), 0));
    f_.set_penalty(hard_.penalty());
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
    if (f_.contacts().carried() && f_.contacts().has_friction())
      iterations_of_step_ = std::max(iterations_of_step_, carried_iterations);
    const bool had_friction = f_.contacts().has_friction();
    f_.contacts().begin_step(origin_);
    if (had_friction || f_.contacts().has_friction()) evaluate();
  }

  /// One implicit step, once begun. False when no descent was found.
  bool step() {
    fresh_alpha_ = no_fresh_direction;
    for (int k = 0; k < iterations_of_step_; ++k) {
      if (!iterate(k)) return false;
      if (converged()) break;
      if (k + 1 == iterations_of_step_) continue;
      shifted_gradient();
      if (is_solved_to(solved_part)) break;
    }
    ++result_.steps;
    idle_.note(energy_, result_.force_residual, noise_of_energy());
    adapt_step_size();
    return true;
  }

  /// By how far the last fresh direction led, and by whether steps do any good.
  void adapt_step_size() {
    strained_for_ =
        result_.force_residual > strained ? std::max(strained_for_, 0) + 1 : std::min(strained_for_, 0) - 1;
    if (strained_for_ == most_strained) {
      slowed_ = true;
      strained_for_ = 0;
      h_ = std::max(h_ / slowing, smallest_step_size);
    }
    if (result_.force_residual < relaxed || strained_for_ == -most_strained) slowed_ = false;
    if (slowed_) return;
    if (fresh_alpha_ == 1) h_ = std::max(h_, std::min(h_ * p_.step_growth, p_.step_size_limit));
    if (fresh_alpha_ < shortened) h_ /= p_.step_growth;
  }

  /// Whether what is left of the implicit step's force is less than this part of what its end is asked for.
  bool is_solved_to(double part) const { return free_norm(r_, fixed_) <= part * p_.force_tolerance * scale_; }

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
      if (is_solved_to(rounded_part)) {
        alpha_ = 1;  // of a step that is nothing
        break;
      }
      // A factor kept from an earlier state may give no descent: once more with a fresh one. A step
      // too long for its quadratic model is damped more.
      if (age_ > 0) {
        age_ = p_.refresh;
        continue;
      }
      if (is_static()) {
        if (add_mass()) continue;
        message_ = "the line search found no descent (the direction's slope is " + three_digits(slope_) +
                   ")" + held();
        return false;
      }
      h_ /= 4;
      age_ = p_.refresh;
      if (h_ < smallest_step_size) {
        message_ = "the line search found no descent at any step size down to 1e-8 s" + held();
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
    age_factor();
    return true;
  }

  /// The static form's matrix may be positive definite by rounding alone, as where the cloth falls freely.
  /// Its direction is then so long that contact leaves nothing of it; mass makes it shorter.
  bool add_mass() {
    age_ = p_.refresh;
    added_mass_ = std::max(10 * added_mass_, first_added_mass());
    return added_mass_ < most_added_mass;
  }

  /// Never 0, whatever the step size: multiplying it must lead on.
  double first_added_mass() const { return std::max(1e-3 / (p_.step_size * p_.step_size), 1e-30); }

  /// What kept the last step short, for messages.
  std::string held() const { return limit_.by.empty() ? "" : "; the step is held by " + limit_.by; }

  /// Takes note of how far the last direction led. Only a fresh one says something about h; a shortened step
  /// along an old one says that it is time for a new matrix.
  void age_factor() {
    if (age_ == 0) fresh_alpha_ = std::min(fresh_alpha_, alpha_);
    const bool worn = age_ > 0 && alpha_ < 1;
    age_ = worn ? p_.refresh : age_ + 1;
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
    if (cholesky_.has_factor() && age_ < p_.refresh) return;
    age_ = 0;
    const bool least = p_.projection != Projection::none && p_.projection_share == ProjectionShare::least;
    if (least && factorise_least()) return;
    const BlockMatrix& matrix = assemble(p_.projection);
    if (!least && try_factor(matrix, 0)) return;
    // Without projection, or with a free rigid mode in the static form: add mass until it factorises.
    for (double shift = first_added_mass(); shift < 1e30; shift *= 10)
      if (try_factor(matrix, shift)) return;
    throw std::runtime_error(
        "the Newton matrix is not positive definite with any shift: it holds NaN or infinite entries");
  }

  /// Factorises the Hessian with the smallest share of its projection that works, beginning with the one that
  /// worked last, or one below after a step taken in full.
  bool factorise_least() {
    constexpr int last = static_cast<int>(std::size(shares)) - 1;
    for (share_ = alpha_ == 1 ? std::max(share_ - 1, 0) : share_; share_ <= last; ++share_)
      if (try_factor(assemble({p_.projection, shares[share_]}), 0)) return true;
    share_ = last;
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

  /// Backtracks along the direction, from where limits and contact let it, until the energy has decreased
  /// enough; moves x, g and energy.
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
    for (alpha_ = limit_.fraction; alpha_ >= shortest_step; alpha_ *= 0.5) {
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

  /// Energies that differ by less are the same. Beside them counts the work of the load over the size of the
  /// cloth: energies cancel, their rounding does not.
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
    if (conditions_) row.time = conditions_->time();
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
        !ended_as_asked(outcome) && outcome != Outcome::cancelled && outcome != Outcome::refined_early;
    if (failed && result_.x.allFinite()) add_to_message(weak_barrier(model_, result_.x));
    if (conditions_) result_.conditions = conditions_->state();
    result_.seconds += watch_.seconds();
    result_.analyses = cholesky_.analyses();
    if (f_.contacts().any()) {
      result_.smallest_gap = f_.contacts().smallest_gap();
      // Contact sets are built where energies are evaluated.
      result_.seconds_by_phase["contact set"] = f_.contacts().seconds_building();
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
  Conditions* conditions_;
  HardPositions hard_;
  std::vector<char> fixed_;  // one flag a vertex, 1 where it does not move now
  ChangeBegun changed_at_;   // when the change under way was begun
  ChangeResponse response_;  // to the part of it that was made last
  int times_held_up_ = 0;
  bool relaxed_ = false;  // what was a proxy is the plain energy
  IdleSteps idle_;
  double rounding_residual_ = 0;  // that rounding may make, where that was found out last
  int strained_for_ = 0;          // steps in turn
  bool slowed_ = false;           // h does not grow
  int iterations_of_step_ = 1;    // that the step may take

  BlockCholesky cholesky_;
  const BlockMatrix* factored_ = nullptr;  // the objective's, or kept_, that the factor is of
  BlockMatrix kept_;
  double factor_shift_ = 0;
  LevelResult result_;
  std::string message_;
  StepLimit limit_;
  Positions origin_, g_, r_, direction_, trial_, trial_g_;
  double energy_ = 0, inertia_ = 0, slope_ = 0, alpha_ = 1, scale_ = 1;
  Eigen::RowVector3d begun_at_;
  double diagonal_ = 1;
  double h_, free_count_ = 0, fresh_alpha_ = no_fresh_direction;
  int share_ = std::size(shares) - 1;
  double decrements_[3] = {};
  int age_ = 0;
  double added_mass_ = 0;  // of the static form, as 1/h²
};

}  // namespace

LevelResult minimise(Objective& objective, Positions x, const NewtonParameters& parameters,
                     const LevelRun& run) {
  return Newton(objective, std::move(x), parameters, run).run();
}

}  // namespace drape

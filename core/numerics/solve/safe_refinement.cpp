#include "core/numerics/solve/safe_refinement.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "core/numerics/elements/stretch_penalty.h"
#include "core/numerics/model/stretch_limit.h"
#include "core/numerics/solve/lift_off_folds.h"
#include "core/numerics/solve/newton.h"
#include "core/numerics/solve/within_limits.h"

namespace drape {

namespace {

/// h of the target term [s]: at 1 mm from the target its force is a hundred times the cloth's weight.
constexpr double target_step_size = 1e-3;
/// Force residual at which a round's descent ends, relative to its start.
constexpr double tolerance = 0.05;
/// Relative force residual at which a descent ends that begins at the scene's start: the start is far, and
/// the end must be within a fraction of an edge.
constexpr double flight_tolerance = 5e-4;
constexpr int max_steps = 100, max_rounds = 12;
/// A round ends after this many steps in a row of which the line search left less than this fraction.
constexpr int max_negligible_steps = 8;
constexpr double negligible_step = 1e-3;
/// Consecutive rounds without convergence and without fewer violations, after which refinement fails.
constexpr int max_idle_rounds = 4;
constexpr std::size_t max_named = 5;  // triangles in a message

/// 1/(2h²) ‖y - y^p‖²_M + κ_a Σ_{f ∉ F} V_f Σ_i (σ_i - 1)², with the level's contact, and its strain
/// limits restricted to F, the triangles within them.
class TargetObjective : public Objective {
 public:
  TargetObjective(const LevelModel& model, const Positions& from, Positions target)
      : Objective(model), target_(std::move(target)), pattern_(pattern_for(model)), matrix_(pattern_) {
    contacts().disable_friction();
    contacts().fix_stiffness();
    partition_by_strain_limit(from);
    set_scale(from);
  }

  /// Weakens the target term, which may keep triangles beyond their limit: beside a vertex that is pinned on
  /// this level only, the target is where the coarse cloth was, too far from the pin.
  void relax_target(const Positions& y) {
    relaxation_ *= 10;
    smooth_changed();
    set_scale(y);
  }

  /// Partitions the triangles at y into F and the violating ones; returns the number of violating ones.
  int partition_by_strain_limit(const Positions& y) {
    std::vector<char> violating(model().level().triangle_count(), 0);
    for (const BoundEnergy* energy : model().limits())
      if (const StretchLimited* limit = energy->stretch_limit())
        for (const StretchedTriangle& t : limit->violations(y)) violating[t.triangle] = 1;
    const int count = static_cast<int>(std::count(violating.begin(), violating.end(), 1));
    restricted_limits_.clear();
    std::vector<const BoundEnergy*> limits = model().limits();
    for (const BoundEnergy*& energy : limits)
      if (const StretchLimited* limit = energy->stretch_limit(); limit && count > 0)
        energy = restricted_limits_.emplace_back(limit->restricted(violating)).get();
    set_limits(limits);
    smooth_changed();
    const Material& material = model().material();
    penalty_.reset();
    slots_.reset();
    if (count > 0) {
      penalty_ = make_stretch_penalty(model().level(), material.thickness, material.mean_membrane_modulus(),
                                      violating);
      slots_ = std::make_unique<BlockSlots>(*pattern_, penalty_->stencils());
    }
    return count;
  }

  double residual_scale(const Positions&, const Positions&) const override { return scale_; }
  bool enforces_dirichlet() const override { return false; }

 protected:
  double smooth_gradient(const Positions& y, Positions& g) override {
    g.resize(y.rows(), 3);
    double sum = 0;
    for (Eigen::Index i = 0; i < y.rows(); ++i) {
      const Eigen::RowVector3d away = y.row(i) - target_.row(i);
      g.row(i) = weight(i) * away;
      sum += 0.5 * weight(i) * away.squaredNorm();
    }
    return penalty_ ? sum + penalty_->add_gradient(y, g) : sum;
  }
  BlockMatrix& smooth_matrix(const Positions& y, Projection projection) override {
    matrix_.set_zero();
    for (int i = 0; i < pattern_->rows(); ++i)
      for (int c = 0; c < 3; ++c) matrix_.block(pattern_->row_start[i])[4 * c] = weight(i);
    if (penalty_) {
      BlockSink sink = slots_->sink(matrix_);
      penalty_->add_hessian(y, projection, sink);
    }
    return matrix_;
  }

 private:
  double weight(Eigen::Index i) const {
    return model().masses()[i] / (target_step_size * target_step_size * relaxation_);
  }

  void set_scale(const Positions& y) {
    Positions g;
    smooth_gradient(y, g);
    scale_ = std::max(free_norm(g, model().fixed()), std::numeric_limits<double>::min());
  }

  /// Couples vertices only through triangles, if there are limits. The level's own pattern has hinges too,
  /// which make a factorisation several times as expensive.
  static std::shared_ptr<const BlockPattern> pattern_for(const LevelModel& model) {
    std::vector<Stencils> stencils;
    for (const BoundEnergy* limit : model.limits()) stencils.push_back(limit->stencils());
    if (!stencils.empty()) stencils.push_back(model.level().rest.triangles);
    return BlockPattern::of(model.level().vertex_count(), stencils);
  }

  Positions target_;
  std::shared_ptr<const BlockPattern> pattern_;
  BlockMatrix matrix_;
  std::vector<std::unique_ptr<BoundEnergy>> restricted_limits_;
  std::unique_ptr<BoundEnergy> penalty_;
  std::unique_ptr<BlockSlots> slots_;
  double scale_ = 1, relaxation_ = 1;
};

/// Ends a round's descent once contact or limits leave nothing of its steps; otherwise forwards only stop
/// requests.
class Round : public Observer {
 public:
  explicit Round(Observer& observer) : observer_(observer) {}
  void iteration(const IterationRow& row, const Positions&) override {
    negligible_steps_ = row.step_length < negligible_step ? negligible_steps_ + 1 : 0;
  }
  bool stop_requested() override {
    if (observer_.stop_requested()) cancelled_ = true;
    return cancelled_ || negligible_steps_ == max_negligible_steps;
  }
  bool cancelled() const { return cancelled_; }

 private:
  Observer& observer_;
  int negligible_steps_ = 0;
  bool cancelled_ = false;
};

/// Moves Dirichlet vertices towards their targets as far as contact allows; the level's solve does the rest.
void move_dirichlet_vertices(const LevelModel& model, Positions& y) {
  Positions target = y;
  model.set_dirichlet(target);
  if (target == y) return;
  ActiveContacts contacts(model.contacts());
  const StepLimit limit = contacts.max_step(y, target);
  y = limit.fraction == 1 ? target : Positions(y + limit.fraction * (target - y));
}

/// Whether straight motion from x to y is free of contact.
bool is_collision_free(const LevelModel& model, const Positions& x, const Positions& y) {
  return x == y || ActiveContacts(model.contacts()).max_step(x, y).fraction == 1;
}

bool is_intersection_free(const LevelModel& model, const Positions& x) {
  return std::ranges::all_of(model.contacts(), [&](const auto& c) { return c->intersections(x).empty(); });
}

/// The number of vertices that are farther from their goal than a triangle's edge at rest: such a vertex may
/// be caught behind other cloth.
int left_behind(const Level& level, const Positions& x, const Positions& goal) {
  const double edge = std::sqrt(2 * level.vertex_area.sum() / level.triangle_count());
  return static_cast<int>(((x - goal).rowwise().norm().array() > edge).count());
}

}  // namespace

LevelResult refine_safely(const Problem& problem, int level, const Positions& x,
                          const ProlongationMatrix& weights, const Stopwatch& clock, Observer& observer) {
  const Stopwatch watch;
  const std::shared_ptr<const LevelModel> finer = problem.model(level + 1);
  const LevelModel& model = *finer;
  const auto add_offsets = [&](Positions& fine) {
    problem.hierarchy.offsets[level].add(problem.model(level)->level().rest.triangles, x, fine);
  };
  Positions target = weights * x;
  add_offsets(target);
  model.set_dirichlet(target);
  LevelResult refined;
  std::optional<Positions> goal;  // of a cloth that begins far from its target
  bool is_feasible = model.contacts().empty() && model.limits().empty();
  if (!is_feasible) {
    refined.x = problem.hierarchy.midpoints[level] * x;
    if (problem.hierarchy.splits(level)) {
      // the surface has not moved
    } else if (std::optional<Positions> lifted = lifted_off_folds(model, refined.x);
               lifted && left_behind(model.level(), *lifted, refined.x) == 0) {
      if (refined.x != *lifted) {
        refined.x = target = std::move(*lifted);
        add_offsets(target);
        model.set_dirichlet(target);
      }
      target = within_limits(model, std::move(target));
    } else {
      refined.x = problem.starts[level + 1];
      goal = target;
      if (!is_intersection_free(model, refined.x)) {  // under a schedule obstacles have moved
        refined.outcome = Outcome::stalled;
        refined.message = "the state intersects something on the finer mesh";
        return refined;
      }
    }
    move_dirichlet_vertices(model, refined.x);
    is_feasible = strain_limit_violations(model.limits(), target, 1).empty() &&
                  is_collision_free(model, refined.x, target);
  }
  if (is_feasible) {
    refined.x = std::move(target);
  } else {
    TargetObjective objective(model, refined.x, std::move(target));
    NewtonParameters newton;
    newton.form = NewtonForm::statics;
    newton.psd_blend = PsdBlend::full;
    newton.force_tolerance = goal ? flight_tolerance : tolerance;
    newton.max_steps = max_steps;
    newton.stability = StabilityMode::off;  // the target term is not an energy of the cloth
    newton.step_size = target_step_size;    // scales the mass that damps a step without descent
    int fewest = model.level().triangle_count() + 1, idle = 0;
    for (int round = 0; round < max_rounds; ++round) {
      Round descent(observer);
      LevelResult result = minimise(objective, std::move(refined.x), newton, {clock, descent});
      refined.x = std::move(result.x);
      refined.iterations += result.iterations;
      refined.factorisations += result.factorisations;
      refined.analyses += result.analyses;
      refined.flops += result.flops;
      const int violating = objective.partition_by_strain_limit(refined.x);
      if (descent.cancelled()) refined.outcome = Outcome::cancelled;
      idle = violating < fewest || has_converged(result.outcome) ? 0 : idle + 1;
      fewest = std::min(fewest, violating);
      if (violating == 0 || descent.cancelled() || idle == max_idle_rounds) break;
      objective.relax_target(refined.x);
    }
    const std::string violations = strain_limit_violations(model.limits(), refined.x, max_named);
    if (refined.outcome != Outcome::cancelled && !violations.empty()) {
      refined.outcome = Outcome::stalled;
      refined.message = "the refined state violates the strain limit: " + violations;
    }
    const int left = goal ? left_behind(model.level(), refined.x, *goal) : 0;
    if (refined.outcome != Outcome::cancelled && left > 0) {
      refined.outcome = Outcome::stalled;
      refined.message = "contact keeps " + std::to_string(left) + " vertices from the coarse state";
    }
  }
  refined.seconds = refined.seconds_by_phase["refinement"] = watch.seconds();
  return refined;
}

}  // namespace drape

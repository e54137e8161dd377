#include "core/numerics/safe_refinement.h"

#include <algorithm>
#include <limits>

#include "core/model/stretch_limit.h"
#include "core/numerics/newton.h"
#include "core/numerics/stretch_penalty.h"

namespace drape {

namespace {

/// h of the pull towards the target [s]: a millimetre then weighs a hundred times the cloth's own weight.
constexpr double pull = 1e-3;
/// The descent ends where the force left over is this part of what it was.
constexpr double tolerance = 0.05;
constexpr int most_steps = 100, most_rounds = 12;
/// Or where so many rounds in turn have neither converged nor brought triangles into the limits.
constexpr int most_idle = 4;
constexpr std::size_t most_named = 5;  // triangles, in a message

/// 1/(2h²) ‖y - y^p‖²_M + κ_a Σ_{f ∉ F} V_f Σ_i (σ_i - 1)², with the level's contact, and its limits on F.
class PullToTarget : public Objective {
 public:
  PullToTarget(const LevelModel& model, const Positions& from, Positions target)
      : Objective(model), target_(std::move(target)), pattern_(pattern_for(model)), matrix_(pattern_) {
    contacts().disable_friction();
    divide(from);
    take_scale(from);
  }

  /// Lets go of the target by so much, for what the pull keeps outside its limits: beside a vertex that is
  /// pinned on this level alone, the target is where the coarse cloth was, and too far.
  void loosen(const Positions& y) {
    looseness_ *= 10;
    smooth_changed();
    take_scale(y);
  }

  /// Sorts the triangles at y into F and the others; the number of others.
  int divide(const Positions& y) {
    outside_.assign(model().level().triangle_count(), 0);
    for (const BoundEnergy* energy : model().limits())
      if (const auto* limit = dynamic_cast<const StretchLimited*>(energy))
        for (const StretchedTriangle& t : limit->beyond(y)) outside_[t.triangle] = 1;
    const int count = static_cast<int>(std::count(outside_.begin(), outside_.end(), 1));
    inside_limits_.clear();
    std::vector<const BoundEnergy*> limits;
    for (const BoundEnergy* energy : model().limits()) {
      const auto* limit = dynamic_cast<const StretchLimited*>(energy);
      if (limit && count > 0) {
        inside_limits_.push_back(limit->without(outside_));
        limits.push_back(inside_limits_.back().get());
      } else {
        limits.push_back(energy);
      }
    }
    set_limits(limits);
    smooth_changed();
    const Material& material = model().material();
    penalty_.reset();
    slots_.reset();
    if (count > 0) {
      penalty_ =
          make_stretch_penalty(model().level(), material.thickness, material.membrane_modulus, outside_);
      slots_ = std::make_unique<BlockSlots>(*pattern_, penalty_->stencils());
    }
    return count;
  }

  double residual_scale(const Positions&, const Positions&) const override { return scale_; }
  bool is_proxy() const override { return false; }
  bool brings_held_vertices() const override { return false; }

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
      BlockSink sink(*slots_, matrix_);
      penalty_->add_hessian(y, projection, sink);
    }
    return matrix_;
  }

 private:
  double weight(Eigen::Index i) const { return model().masses()[i] / (pull * pull * looseness_); }

  void take_scale(const Positions& y) {
    Positions g;
    smooth_gradient(y, g);
    scale_ = std::max(free_norm(g, model().fixed()), std::numeric_limits<double>::min());
  }

  /// Between vertices there is nothing but contact and, with limits, these and triangles. The level's own
  /// pattern has hinges beside, which make a factorisation several times dearer.
  static std::shared_ptr<const BlockPattern> pattern_for(const LevelModel& model) {
    std::vector<Stencils> stencils;
    for (const BoundEnergy* limit : model.limits()) stencils.push_back(limit->stencils());
    if (!stencils.empty()) stencils.push_back(model.level().rest.triangles);
    return BlockPattern::of(model.level().vertex_count(), stencils);
  }

  Positions target_;
  std::shared_ptr<const BlockPattern> pattern_;
  BlockMatrix matrix_;
  std::vector<char> outside_;
  std::vector<std::unique_ptr<BoundEnergy>> inside_limits_;
  std::unique_ptr<BoundEnergy> penalty_;
  std::unique_ptr<BlockSlots> slots_;
  double scale_ = 1, looseness_ = 1;
};

/// Passes on nothing but the wish to stop.
class Quiet : public Observer {
 public:
  explicit Quiet(Observer& observer) : observer_(observer) {}
  bool stop_requested() override { return observer_.stop_requested(); }

 private:
  Observer& observer_;
};

/// Moves held vertices to their places as far as nothing is in the way; the level's own solve goes on with
/// it.
void move_pins(const LevelModel& model, Positions& y) {
  Positions placed = y;
  for (const HeldVertex& h : model.held()) placed.row(h.vertex) = h.place.transpose();
  if (placed == y) return;
  ActiveContacts contacts(model.contacts());
  const StepLimit limit = contacts.max_step(y, placed);
  y = limit.fraction == 1 ? placed : Positions(y + limit.fraction * (placed - y));
}

/// Whether straight motion from x to y meets no contact.
bool is_collision_free(const LevelModel& model, const Positions& x, const Positions& y) {
  return x == y || ActiveContacts(model.contacts()).max_step(x, y).fraction == 1;
}

}  // namespace

Refined refine_safely(const Problem& problem, int level, const Positions& x,
                      const ProlongationMatrix& weights, const Stopwatch& clock, Observer& observer) {
  const Stopwatch watch;
  const LevelModel& model = *problem.models[level + 1];
  Refined refined;
  if (model.contacts().empty() && model.limits().empty()) {
    refined.x = problem.carry_up(weights, level, x);
    refined.seconds = watch.seconds();
    return refined;
  }
  refined.x = problem.hierarchy.midpoints[level] * x;
  move_pins(model, refined.x);
  Positions target = problem.carry_up(weights, level, x);
  const bool allowed = beyond_limits(model.limits(), target, 1).empty();
  if (allowed && is_collision_free(model, refined.x, target)) {
    refined.x = std::move(target);
  } else {
    PullToTarget objective(model, refined.x, std::move(target));
    NewtonParameters newton;
    newton.form = NewtonForm::statics;
    newton.projection_share = ProjectionShare::full;
    newton.force_tolerance = tolerance;
    newton.max_steps = most_steps;
    Quiet quiet(observer);
    int fewest = model.level().triangle_count() + 1, idle = 0;
    for (int round = 0; round < most_rounds; ++round) {
      LevelResult result = minimise(objective, std::move(refined.x), newton, {clock, quiet});
      refined.x = std::move(result.x);
      refined.iterations += result.iterations;
      const int left = objective.divide(refined.x);
      refined.cut_short = result.outcome == Outcome::cancelled;
      idle = left < fewest || has_converged(result.outcome) ? 0 : idle + 1;
      fewest = std::min(fewest, left);
      if (left == 0 || refined.cut_short || idle == most_idle) break;
      objective.loosen(refined.x);
    }
    if (!refined.cut_short) refined.fault = beyond_limits(model.limits(), refined.x, most_named);
    if (!refined.fault.empty())
      refined.fault = "the refined state is beyond the strain limit: " + refined.fault;
  }
  refined.seconds = watch.seconds();
  return refined;
}

}  // namespace drape

#pragma once

#include <memory>
#include <string>

#include "core/numerics/model/active_contacts.h"
#include "core/numerics/model/hessian_assembler.h"
#include "core/numerics/model/level_model.h"

namespace drape {

/// Function F of n×3 positions that Newton minimises on one level, with its gradient and a matrix for search
/// directions.
///
/// F is the sum of a smooth part, which a derived class gives, and of terms on the level's own mesh: strain
/// limits S_l, barrier B_l and friction D_l. Not thread-safe: it owns the work space of its evaluations.
class Objective {
 public:
  explicit Objective(std::shared_ptr<const LevelModel> model)
      : model_(std::move(model)), limits_(model_->limits()), contacts_(model_->contacts()) {}
  /// Refers to `model`, which must outlive the objective.
  explicit Objective(const LevelModel& model)
      : Objective(std::shared_ptr<const LevelModel>(std::shared_ptr<void>(), &model)) {}
  virtual ~Objective() = default;

  /// The level's plain model, which gives masses, fixed vertices and the force scale.
  const LevelModel& model() const { return *model_; }

  /// F(x) [J]; overwrites g with ∇F(x) [N]. +∞ outside the domain.
  double gradient(const Positions& x, Positions& g);
  /// The plain energy E_l(x) of the level [J], without friction, even if F is a proxy.
  double plain_energy(const Positions& x) { return model_->energy_without_contact(x) + contacts_.barrier(x); }
  /// The matrix at x [N/m]; valid until the next call. Its pattern object stays the same while its sparsity
  /// does.
  const BlockMatrix& matrix(const Positions& x, Projection projection);

  /// What the pattern of the last matrix depends on beyond the level.
  struct PatternState {
    HessianAssembler::ExtraPattern extra;
    bool smooth_only = true;   ///< nothing was added to the smooth part
    bool invalidated = false;  ///< F has changed since: the next matrix gets another pattern
  };
  PatternState pattern_state() const { return {assembler_.extra(), smooth_only_, invalidated_}; }
  /// Restores the pattern of an objective of the same level. Returns the pattern of its last matrix, null if
  /// that was invalidated. x is any state in the domain.
  std::shared_ptr<const BlockPattern> restore(PatternState state, const Positions& x);

  /// Largest step from x0 towards x1 that satisfies all strain limits and is free of intersections. Until the
  /// next call F may be evaluated at x0 and up to that step; with contact, nowhere else.
  StepLimit max_step(const Positions& x0, const Positions& x1);

  /// Replaces the model by that of the same level under another load. The cloth was at `from` when the load
  /// changed, and is now at x.
  void set_model(std::shared_ptr<const LevelModel> model, const Positions& from, const Positions& x);
  /// The value of the penalty at x [J]; 0 without one.
  double penalty(const Positions& x) const { return penalty_ ? penalty_->value(x) : 0; }
  /// Sets an additional energy that is not part of the model, such as a position penalty; null for none.
  /// Refers to it until the next call.
  void set_penalty(const BoundEnergy* penalty) {
    if (penalty || penalty_) invalidate_pattern();
    penalty_ = penalty;
  }
  /// Whether the solver is to move the model's Dirichlet vertices to their targets.
  virtual bool enforces_dirichlet() const { return true; }

  /// Contacts, and friction's lagged state.
  ActiveContacts& contacts() { return contacts_; }

  /// Scale [N] of the force residual: the norm of ∇F over free vertices is divided by it.
  virtual double residual_scale(const Positions& x, const Positions& gradient) const {
    return model_->residual_scale(x, gradient);
  }
  /// Whether the smooth part differs from the level's plain energy.
  virtual bool is_proxy() const { return false; }
  /// Whether matrix() without projection is the Hessian of F.
  virtual bool has_exact_hessian() const { return true; }
  /// Replaces a proxy's smooth part by the level's plain energy, once the proxy's minimum is reached. Returns
  /// false if nothing changes.
  virtual bool switch_to_plain() { return false; }
  /// What the level's result is to say of F; empty for nothing.
  virtual std::string remark() const { return ""; }

 protected:
  /// Must depend on x alone until smooth_changed() or set_model() is called: the last value is cached.
  virtual double smooth_gradient(const Positions& x, Positions& g) = 0;
  /// Other terms are added to the matrix in place if its pattern has all their blocks.
  virtual BlockMatrix& smooth_matrix(const Positions& x, Projection projection) = 0;

  /// set_model() has given the level another model. For objectives that hold more than model().
  virtual void model_changed() {}

  /// To be called when the smooth part becomes another function.
  void smooth_changed() { evaluated_at_.resize(0, 3); }

  /// To be called when the pattern of the smooth matrix changes.
  void smooth_pattern_changed();

  /// Replaces the strain limits of the model.
  void set_limits(std::vector<const BoundEnergy*> limits) {
    limits_ = std::move(limits);
    invalidate_pattern();  // the assembler has cached the limits' block indices
  }

 private:
  void invalidate_pattern();

  std::shared_ptr<const LevelModel> model_;
  std::vector<const BoundEnergy*> limits_;
  const BoundEnergy* penalty_ = nullptr;
  ActiveContacts contacts_;
  HessianAssembler assembler_;
  bool smooth_only_ = true, invalidated_ = false;  // of the last matrix' pattern
  // Cache of the last evaluation of the smooth part. Between steps only friction changes at the same x, and a
  // proxy's smooth part is expensive.
  Positions evaluated_at_, smooth_gradient_;
  double smooth_energy_ = 0;
};

/// The plain energy E_l.
class PlainObjective : public Objective {
 public:
  using Objective::Objective;

 protected:
  double smooth_gradient(const Positions& x, Positions& g) override { return model().gradient(x, g); }
  BlockMatrix& smooth_matrix(const Positions& x, Projection projection) override {
    model().hessian(x, projection, matrix_);
    return matrix_;
  }

 private:
  BlockMatrix matrix_{model().pattern()};
};

}  // namespace drape

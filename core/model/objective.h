#pragma once

#include <memory>

#include "core/model/active_contacts.h"
#include "core/model/level_model.h"
#include "core/numerics/sum_matrix.h"

namespace drape {

/// What one Newton minimises on one level: a function of n×3 positions with its gradient and a matrix
/// for the directions. It is the sum of a smooth part, which a derived class gives, and of what belongs to
/// the level's own mesh whatever is minimised: strain limits S_l, barrier B_l and friction D_l. Not
/// thread-safe: it owns the work space of its evaluations.
class Objective {
 public:
  explicit Objective(const LevelModel& model)
      : model_(model), limits_(model.limits()), contacts_(model.contacts()) {}
  virtual ~Objective() = default;

  /// The level's plain model: its masses, fixed vertices and force scale.
  const LevelModel& model() const { return model_; }

  /// F(x) [J]; overwrites g with ∇F(x) [N]. +∞ outside the domain.
  double gradient(const Positions& x, Positions& g);
  /// The plain energy E_l(x) of the level, without friction, whatever is minimised [J].
  double plain_energy(const Positions& x);
  /// The matrix at x [N/m]; valid until the next call. Its pattern object stays the same as long as
  /// its sparsity does.
  const BlockMatrix& matrix(const Positions& x, Projection projection);

  /// What the pattern of the last matrix depends on beyond the level.
  struct PatternMemory {
    SumMatrix::Room room;
    bool smooth_alone = true;  ///< nothing was added to the smooth part
    bool gone = false;         ///< what is minimised has changed since, so that it will not come again
  };
  PatternMemory pattern_memory() const { return {sum_.room(), smooth_alone_, gone_}; }
  /// Is as the objective of the same level that remembers this; the pattern of its last matrix, null where
  /// that is gone. x is any state of the domain.
  std::shared_ptr<const BlockPattern> restore(PatternMemory memory, const Positions& x);

  /// How far from x0 towards x1 every limit holds and nothing touches. Until the next call the function may
  /// be evaluated at x0 and at states that far, and with contact nowhere else.
  StepLimit max_step(const Positions& x0, const Positions& x1);

  /// The model is under other conditions, its contacts having been `before` with the cloth at `from`, which
  /// is now at x.
  void model_changed(const BoundContacts& before, const Positions& from, const Positions& x);
  /// Adds an energy that is no part of the model, such as a pull to a place; null for none.
  void set_penalty(const BoundEnergy* penalty) {
    if (penalty || penalty_) forget_room();
    penalty_ = penalty;
  }
  /// Whether the vertices that the model holds are to be brought to their places.
  virtual bool brings_held_vertices() const { return true; }

  /// Contacts, their gaps and friction's memory; what a step does with them.
  ActiveContacts& contacts() { return contacts_; }

  /// What the norm of ∇F over free vertices is divided by to give the force residual.
  virtual double residual_scale(const Positions& x, const Positions& gradient) const {
    return model_.residual_scale(x, gradient);
  }
  /// Whether the smooth part is something else than the plain energy of the level.
  virtual bool is_proxy() const = 0;
  /// Makes the smooth part of a proxy at its minimum the plain energy of the level, for what may still relax.
  /// False where nothing changes.
  virtual bool relax() { return false; }

 protected:
  /// A function of x alone until smooth_changed() or model_changed() is called: it is kept where x stays.
  virtual double smooth_gradient(const Positions& x, Positions& g) = 0;
  /// To which the rest is added in place, where its pattern has room for it.
  virtual BlockMatrix& smooth_matrix(const Positions& x, Projection projection) = 0;

  /// The smooth part is another function from now on.
  void smooth_changed() { evaluated_at_.resize(0, 3); }

  /// The pattern of the smooth part's matrix is another one from now on.
  void smooth_pattern_changed();

  /// Restricts or replaces the limits of the model.
  void set_limits(std::vector<const BoundEnergy*> limits) {
    limits_ = std::move(limits);
    forget_room();  // the sum keeps the places of the elements that limits had
  }

 private:
  void forget_room();
  double kept_smooth_gradient(const Positions& x, Positions& g);

  const LevelModel& model_;
  std::vector<const BoundEnergy*> limits_;
  const BoundEnergy* penalty_ = nullptr;
  ActiveContacts contacts_;
  SumMatrix sum_;
  bool smooth_alone_ = true, gone_ = false;  // of the last matrix' pattern
  // Where the smooth part was evaluated last, and what it was. Friction changes from step to step where x
  // does not, and of a proxy the smooth part is by far the larger one.
  Positions evaluated_at_, smooth_gradient_;
  double smooth_energy_ = 0;
};

/// E_l itself.
class PlainObjective : public Objective {
 public:
  explicit PlainObjective(const LevelModel& model) : Objective(model), matrix_(model.pattern()) {}
  bool is_proxy() const override { return false; }

 protected:
  double smooth_gradient(const Positions& x, Positions& g) override { return model().gradient(x, g); }
  BlockMatrix& smooth_matrix(const Positions& x, Projection projection) override {
    model().hessian(x, projection, matrix_);
    return matrix_;
  }

 private:
  BlockMatrix matrix_;
};

}  // namespace drape

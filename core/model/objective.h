#pragma once

#include <memory>

#include "core/model/level_model.h"

namespace drape {

/// What one Newton minimises on one level: a function of n×3 positions with its gradient and a matrix
/// for the directions. Not thread-safe: it owns the work space of its evaluations.
class Objective {
 public:
  virtual ~Objective() = default;

  /// The level's plain model: its masses, fixed vertices and force scale.
  virtual const LevelModel& model() const = 0;
  /// F(x) [J]; overwrites g with ∇F(x) [N].
  virtual double gradient(const Positions& x, Positions& g) = 0;
  /// F(x) alone.
  virtual double value(const Positions& x) = 0;
  /// The matrix at x [N/m]; valid until the next call. Its pattern object stays the same as long as
  /// its sparsity does.
  virtual const BlockMatrix& matrix(const Positions& x, Projection projection) = 0;
  /// What the norm of ∇F over free vertices is divided by to give the force residual.
  virtual double residual_scale(const Positions& x, const Positions& gradient) = 0;
  /// Whether F is something else than the plain energy of the level.
  virtual bool is_proxy() const = 0;
};

/// E_l itself.
class PlainObjective : public Objective {
 public:
  explicit PlainObjective(const LevelModel& model) : model_(model), matrix_(model.pattern()) {}

  const LevelModel& model() const override { return model_; }
  double gradient(const Positions& x, Positions& g) override { return model_.gradient(x, g); }
  double value(const Positions& x) override { return model_.value(x); }
  const BlockMatrix& matrix(const Positions& x, Projection projection) override {
    model_.hessian(x, projection, matrix_);
    return matrix_;
  }
  double residual_scale(const Positions& x, const Positions& gradient) override {
    return model_.residual_scale(x, gradient);
  }
  bool is_proxy() const override { return false; }

 private:
  const LevelModel& model_;
  BlockMatrix matrix_;
};

}  // namespace drape

#pragma once

#include "core/kernel/interfaces/energy.h"

namespace drape {

/// E(x) = c - Σ f_i · x_i: constant forces f, n×3 [N].
class LinearEnergy final : public BoundEnergy {
 public:
  explicit LinearEnergy(Positions forces, double constant = 0)
      : forces_(std::move(forces)), constant_(constant) {}

  double value(const Positions& x) const override;
  double add_gradient(const Positions& x, Positions& g) const override;
  Stencils stencils() const override { return Stencils(0, 1); }
  void add_hessian(const Positions&, Projection, BlockSink&) const override {}

 private:
  Positions forces_;
  double constant_;  // [J]
};

}  // namespace drape

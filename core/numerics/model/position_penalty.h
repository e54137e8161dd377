#pragma once

#include <vector>

#include "core/kernel/interfaces/energy.h"

namespace drape {

/// Quadratic penalty Σ_k w_k/2 ‖x_k − x̃_k‖² that pulls vertices to targets x̃ (supplement, section 4,
/// equation 1; w_k = κ_B m_k).
class PositionPenalty final : public BoundEnergy {
 public:
  struct Term {
    int vertex = 0;
    Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< x̃ [m]
    double weight = 0;                                 ///< w [N/m]
  };
  explicit PositionPenalty(std::vector<Term> terms) : terms_(std::move(terms)) {}

  double value(const Positions& x) const override;
  double add_gradient(const Positions& x, Positions& g) const override;
  Stencils stencils() const override;
  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override;

 private:
  std::vector<Term> terms_;
};

}  // namespace drape

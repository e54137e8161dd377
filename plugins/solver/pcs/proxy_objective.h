#pragma once

#include <memory>
#include <vector>

#include "core/hierarchy/transfer.h"
#include "core/model/objective.h"
#include "core/model/solver.h"
#include "core/numerics/galerkin.h"

namespace drape {

/// F_l(x) = Ψ_L(P_l x) + B_l(x) + D_l(x) + S_l(x): the finest level's shell and loads, seen from the vertices
/// of level l, with that level's own contact and limits (PCS, section 4). The gradient is exact; the matrix
/// is the plain model of level l (`depth` 0, the paper's) or the Galerkin product of the plain model `depth`
/// levels up.
class ProxyObjective : public Objective {
 public:
  ProxyObjective(const Problem& problem, int level, int depth);
  bool is_proxy() const override { return true; }

 protected:
  double smooth_value(const Positions& x) override;
  double smooth_gradient(const Positions& x, Positions& g) override;
  BlockMatrix& smooth_matrix(const Positions& x, Projection projection) override;

 private:
  /// x carried `count` levels up; the result is owned by carried_.
  const Positions& carry(const Positions& x, int count);

  const Problem& problem_;
  int level_, depth_;
  std::vector<Transfer> transfers_;          // level_ + k → level_ + k + 1
  std::vector<Positions> carried_, forces_;  // work space on level_ + 1 + k
  std::vector<GalerkinProduct> products_;    // from level_ + depth_ downwards
  std::vector<BlockMatrix> matrices_;        // the plain one first, then each product
};

}  // namespace drape

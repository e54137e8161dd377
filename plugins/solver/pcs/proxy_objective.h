#pragma once

#include <memory>
#include <vector>

#include "core/hierarchy/transfer.h"
#include "core/model/objective.h"
#include "core/model/solver.h"
#include "core/numerics/galerkin.h"

namespace drape {

/// A part of a proxy: the energies of some roles, of the plain model `above` levels up, at the state carried
/// there.
struct ProxyPart {
  Roles roles;
  double factor = 1;     ///< on their energy
  int above = 0;         ///< levels from the proxy's to the model's; 0: the level's own model
  int matrix_above = 0;  ///< the same of the model that gives the matrix, at most `above`
  /// By which a level's state is carried to the next, one matrix a level; must outlive the proxy. Null where
  /// `above` is 0.
  const std::vector<ProlongationMatrix>* interpolation = nullptr;
};

/// Which matrix makes the directions on the coarse levels.
enum class ProxyMatrix {
  coarse,   ///< the plain model's of the level itself (PCS, section 4.2)
  galerkin  ///< the parts' own: Pᵀ H P of the model `matrix_above` levels up
};

/// F_l(x) = Σ parts(x) + B_l(x) + D_l(x) + S_l(x): shell and loads of finer levels as they are seen from the
/// vertices of level l, with that level's own contact and limits (PCS, section 4). The gradient is exact.
class ProxyObjective : public Objective {
 public:
  /// With `relaxes`, relax() makes it the plain energy.
  ProxyObjective(const Problem& problem, int level, const std::vector<ProxyPart>& parts, ProxyMatrix matrix,
                 bool relaxes = false);
  bool is_proxy() const override { return !relaxed_; }
  bool relax() override;

 protected:
  double smooth_gradient(const Positions& x, Positions& g) override;
  BlockMatrix& smooth_matrix(const Positions& x, Projection projection) override;

 private:
  /// A part that is evaluated on a finer level, with its work space.
  struct FinerPart {
    ProxyPart part;
    std::vector<Transfer> transfers;         // level_ + k → level_ + k + 1
    std::vector<Positions> carried, forces;  // on level_ + 1 + k
    std::vector<GalerkinProduct> products;   // from level_ + matrix_above downwards
    std::vector<BlockMatrix> matrices;       // the finer model's first, then each product
    std::vector<int> place;                  // of each block of the last in matrix_

    const Positions& carry(const Positions& x, int count);
  };

  void lay_out(const std::vector<std::shared_ptr<const BlockPattern>>& patterns);
  void add_own_hessians(const Positions& x, Projection projection, BlockMatrix& matrix) const;

  const Problem& problem_;
  const LevelModel& plain_;
  int level_;
  ProxyMatrix kind_;
  bool relaxes_, relaxed_ = false;
  std::vector<ProxyPart> own_;  // parts that the level's own model gives
  std::vector<FinerPart> finer_;
  BlockMatrix own_matrix_, matrix_;  // of own_ where the sum has another pattern; the sum
  std::vector<int> own_place_;       // of each block of own_matrix_ in matrix_
  Positions part_gradient_;
};

}  // namespace drape

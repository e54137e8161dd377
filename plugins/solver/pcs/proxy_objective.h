#pragma once

#include <memory>
#include <vector>

#include "core/kernel/interfaces/solver.h"
#include "core/kernel/plugin/declaration.h"
#include "core/numerics/hierarchy/transfer.h"
#include "core/numerics/linear_algebra/galerkin.h"
#include "core/numerics/model/objective.h"

namespace drape {

/// Interpolation through which a proxy's energies see the fine mesh, for each role.
struct ProxyInterpolation {
  Interpolation membrane = Interpolation::midpoint;
  Interpolation bending = Interpolation::midpoint;
  Interpolation external = Interpolation::midpoint;
  Interpolation state = Interpolation::midpoint;

  static void declare(Declaration<ProxyInterpolation>& d);
};

/// Matrix for search directions on coarse levels.
enum class ProxyMatrix {
  coarse,   ///< Hessian of the level's own plain model (PCS, section 4.2)
  galerkin  ///< Galerkin product Pᵀ H P of the model `matrix_above` levels up
};

/// Choices of a proxy.
struct ProxyOptions {
  ProxyInterpolation seen_by;
  ProxyMatrix hessian = ProxyMatrix::galerkin;
  int depth = 2;  ///< matrix_above of a part on the finest level, unless that is nearer
  /// The level's own membranes are LevelModel::with_effective_membranes, unless the refiner sees them.
  bool effective = true;
  bool relaxes = true;  ///< switch_to_plain() replaces the parts by the level's own energies
};

/// Part of a proxy: the energies of some roles in the plain model `above` levels up, at the prolonged state.
struct ProxyPart {
  Roles roles;
  double factor = 1;     ///< multiplies their energy
  int above = 0;         ///< levels from the proxy's up to the model's; 0: the level's own model
  int matrix_above = 0;  ///< the same for the model that gives the matrix; at most `above`
  /// Prolongations, one for each level; must outlive the proxy. Null if `above` is 0.
  const std::vector<ProlongationMatrix>* interpolation = nullptr;

  bool operator==(const ProxyPart&) const = default;
};

/// Parts of the proxy of a coarse level, whose own model is `own`, for the finest model. An energy that
/// midpoint refinement multiplies by a known factor (LevelModel::midpoint_factor) is evaluated on the level
/// itself, any other on the finest one. `halvings` is the level's Fineness::levels. The parts refer to the
/// problem's hierarchy.
std::vector<ProxyPart> proxy_parts(const Problem& problem, int level, const LevelModel& own, double halvings,
                                   const ProxyOptions& options);

/// Proxy F_l(x) = Σ parts(x) + B_l(x) + D_l(x) + S_l(x): shell energies and loads of finer levels as
/// functions of the vertices of level l, with that level's own contact and strain limits (PCS, section 4).
/// The gradient is exact.
class ProxyObjective : public Objective {
 public:
  /// Refers to `problem`. Chooses the parts again for every load: a schedule may change an energy's midpoint
  /// factor.
  ProxyObjective(const Problem& problem, int level, const ProxyOptions& options);
  bool is_proxy() const override { return !is_plain_ || effective_; }
  /// Parts of finer levels have matrices from below the finest level, or none.
  bool has_exact_hessian() const override {
    return is_plain_ || (finer_.empty() && options_.hessian == ProxyMatrix::galerkin);
  }
  bool switch_to_plain() override;
  std::string remark() const override;

 protected:
  double smooth_gradient(const Positions& x, Positions& g) override;
  BlockMatrix& smooth_matrix(const Positions& x, Projection projection) override;
  void model_changed() override;

 private:
  /// Part that is evaluated on a finer level, with its work space.
  struct FinerPart {
    ProxyPart part;
    std::shared_ptr<const LevelModel> model, matrix_model;  // part.above and part.matrix_above levels up
    std::vector<Transfer> transfers;                        // level_ + k → level_ + k + 1
    std::vector<const Triangles*> triangles;                // of level_ + k
    std::vector<const NormalOffsets*> offsets;              // level_ + k → level_ + k + 1
    std::vector<Positions> prolonged, forces;               // on level_ + 1 + k
    std::vector<GalerkinProduct> products;                  // from level_ + matrix_above downwards
    std::vector<BlockMatrix> matrices;                      // the finer model's first, then each product
    std::vector<int> slots;  // index in matrix_ of each block of the last matrix

    const Positions& prolong(const Positions& x, int count);
    /// The forces on the level, in `coarse`, of those on the finest one in forces.back(), at x as prolonged.
    void restrict(const Positions& x, Positions& coarse);
  };

  void make_parts();
  void make_matrices();
  /// Whether the level's own membranes are LevelModel::with_effective_membranes.
  bool buckles_below_mesh() const {
    return options_.effective && options_.seen_by.membrane == Interpolation::midpoint;
  }
  /// The level's own energies.
  const LevelModel& own_model() const {
    return !is_plain_ && folded_ ? *folded_ : effective_ ? *effective_ : model();
  }
  void add_own_hessians(const Positions& x, Projection projection, BlockMatrix& matrix) const;

  const Problem& problem_;
  int level_;
  ProxyOptions options_;
  Fineness finest_;
  bool is_plain_ = false;
  std::shared_ptr<const LevelModel>
      effective_;  // the level's model that bends, and buckles, as the finest, or null
  std::shared_ptr<const LevelModel> folded_;  // the same with folds as sharp as on the finest level; null for
                                              // folds that the refiner's surface has
  std::vector<ProxyPart> parts_, own_;        // all, and those of the level's own model
  std::vector<FinerPart> finer_;
  BlockMatrix own_matrix_, matrix_;  // of own_, if its pattern differs from the sum's; the sum
  std::vector<int> own_slots_;       // index in matrix_ of each block of own_matrix_
  Positions part_gradient_;
};

}  // namespace drape

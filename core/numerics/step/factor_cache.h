#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/linear_algebra/block_cholesky.h"
#include "core/numerics/multigrid/multigrid.h"
#include "core/numerics/step/hessian_modification.h"
#include "core/numerics/step/iterate.h"

namespace drape {

/// The factorised Newton matrix of an iteration. The analysis of its pattern is kept until that changes.
///
/// A matrix that LinearSolver::multigrid or mixed, in single precision, finds not to be positive definite has
/// more of the projection blended in. If the whole does not suffice, or cycles converge too slowly, the next
/// solver is used for some iterations: mixed after multigrid, double precision after mixed. The static form,
/// whose matrix has no inertia and may be singular, always has factors in double precision.
class FactorCache {
 public:
  struct State {
    int blend = HessianModification::blend_count - 1;  ///< HessianModification::blend
    Objective::PatternState pattern;
    BlockCholesky::Analysis analysis;
    LinearSolver fallback = LinearSolver::mixed;  ///< used instead of the preferred one …
    int fallback_solves = 0;                      ///< … for this many further solves
  };
  State state() const;
  /// The iterate must have been evaluated.
  void restore(const State& state);

  /// Refers to the iterate. Its result counts the factorisations, their operations and seconds. Multigrid
  /// needs the hierarchy of its level.
  FactorCache(Iterate& iterate, const NewtonParameters& parameters, const Hierarchy* hierarchy = nullptr);

  /// Factorises the Hessian at the iterate plus `mass_shift` [1/s²] times the masses, without the rows and
  /// columns of its fixed vertices, and solves with it; n×3 right-hand side [N] and solution [m], whose fixed
  /// rows are zero. `step_length` is the last α. Returns false if that fails; fault() then says why.
  bool solve(double mass_shift, double step_length, const Positions& right_hand_side, Positions& solution);
  /// Factorises in double precision, as solve() would, but without the model's Dirichlet vertices, a matrix
  /// that any number of right-hand sides follow.
  bool update(double mass_shift, double step_length);
  /// Why the last factorisation failed; empty if it did not.
  const std::string& fault() const { return fault_; }

  /// Solves with the factor of update().
  void solve(const Positions& right_hand_side, Positions& solution) {
    cholesky_.solve(right_hand_side, solution);
  }
  /// The factorised matrix without the shift.
  const BlockMatrix& matrix() const { return *factored_; }

  /// The Hessian at the iterate with this projection [N/m], valid until the next one. It takes the place of
  /// the factorised matrix.
  const BlockMatrix& hessian(Projection projection);

  /// Makes precondition() an approximation of the inverse of a matrix of hessian()'s pattern plus
  /// diag(shift_i I₃), shift by vertex [N/m]: a V-cycle where multigrid is preferred and serves, else a
  /// factor in double precision. Returns false if that finds the sum not to be positive definite. Refers to
  /// the matrix until the next call.
  bool prepare(const BlockMatrix& matrix, const Eigen::VectorXd& shift);
  /// n×3 right-hand side [N] and solution [m], whose fixed rows are zero.
  void precondition(const Positions& right_hand_side, Positions& solution);
  /// Whether it is to be a V-cycle.
  bool prefers_cycle() const { return multigrid_ != nullptr; }

  /// The solver of the last factorisation.
  LinearSolver solver() const { return solver_; }
  /// Number of symbolic analyses.
  int analyses() const { return cholesky_.analysis().count; }

 private:
  void use(LinearSolver solver);
  /// Modifies the Hessian at the iterate until `factorise` succeeds, and sets fault_.
  bool modify(const std::vector<char>& fixed, double step_length,
              const HessianModification::Factorise& factorise);
  void analyse(const BlockMatrix& matrix, const std::vector<char>& fixed);
  bool factorise(const BlockMatrix& matrix, const std::vector<char>& fixed, const Eigen::VectorXd& shift);
  bool solve_with_factor(const Positions& right_hand_side, Positions& solution);

  Iterate& iterate_;
  const LinearSolver direct_;             // for matrices of which nothing is known
  std::unique_ptr<Multigrid> multigrid_;  // null where it is not to be used
  const LinearSolver preferred_;
  HessianModification modification_;
  BlockCholesky cholesky_;
  const BlockMatrix* factored_ = nullptr;  // the objective's matrix
  LinearSolver solver_;                    // in use
  bool too_slow_ = false;                  // the last solve did not converge
  LinearSolver fallback_ = LinearSolver::mixed;
  int fallback_solves_ = 0;
  std::string fault_;
};

}  // namespace drape

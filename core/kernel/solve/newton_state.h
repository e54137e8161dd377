#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/kernel/linear_algebra/block_cholesky.h"
#include "core/kernel/model/active_contacts.h"
#include "core/kernel/model/objective.h"
#include "core/kernel/model/solver.h"
#include "core/kernel/solve/dirichlet_enforcer.h"
#include "core/kernel/solve/rounding_floor.h"

namespace drape {

/// Counts of a level when the current increment began.
struct IncrementStart {
  int steps = 0, iterations = 0;
  double seconds = 0;
};

/// Motion of the cloth in answer to a partly applied increment; the predictor extrapolates it.
struct IncrementResponse {
  Positions from;       ///< the equilibrium before (n×3) [m]
  Positions predicted;  ///< where the predictor moved it (n×3) [m]
  double fraction = 0;  ///< applied of what remained of the increment; 0 without a response
};

/// Number of fractions that the adaptive PSD blend chooses from.
constexpr int psd_blend_count = 7;

/// State of a level at the beginning of an implicit step: everything on which later steps depend, bit for
/// bit. Energy, gradient, contacts and the layout of the factor are recomputed from it.
struct NewtonState {
  LevelResult so_far;         ///< x, counts and seconds up to here
  double step_size = 0;       ///< h of the next step [s]
  double step_length = 1;     ///< α of the last line search
  double residual_scale = 1;  ///< scale of the force residual [N]
  int psd_blend = 0;          ///< index of the fraction that worked last
  std::array<double, 3> decrements{};
  std::string limited_by;          ///< name of what limited the last step
  bool switched_to_plain = false;  ///< the objective was a proxy and is now the plain energy
  DirichletEnforcer::State dirichlet;
  IncrementStart increment_start;
  IncrementResponse response;
  int iterations_of_step = 1;  ///< maximum of the next step
  int stall_count = 0;         ///< consecutive steps with forces far beyond the load; negative: without
  bool backed_off = false;     ///< h was reduced because of a stall and does not grow
  IdleSteps::State idle;
  int blocked_increments = 0;  ///< consecutive attempts at the current increment that applied almost nothing
  std::array<double, 3> initial_centroid{};  ///< of the free vertices, at the start or the last increment [m]
  ContactMemory contacts;
  Objective::PatternState pattern;
  BlockCholesky::Analysis analysis;

  // A factor that later iterations reuse; without values there is none.
  int factor_age = 0;                 ///< iterations since the Hessian was updated
  double factor_shift = 0;            ///< multiple of the masses that was added to the matrix [1/s²]
  std::vector<double> factor_values;  ///< blocks of the factorised matrix
};

/// State of a method, between two levels or within one.
struct MethodState {
  std::vector<LevelResult> finished;     ///< in order
  int level = 0;                         ///< the level to continue with
  std::optional<NewtonState> under_way;  ///< state of that level; none if it has not begun
  double seconds = 0;                    ///< of the method so far

  /// The state of level l if it is under way, else null.
  const NewtonState* of(int l) const { return l == level && under_way ? &*under_way : nullptr; }
};

/// Returns the levels of a problem to the loads that they had in the state.
inline void restore_load_stepping(const Problem& problem, const MethodState& state) {
  if (!problem.load_stepping) return;
  for (const LevelResult& level : state.finished)
    problem.load_stepping->restore(level.level, level.load_stepping);
  if (state.under_way) problem.load_stepping->restore(state.level, state.under_way->so_far.load_stepping);
}

}  // namespace drape

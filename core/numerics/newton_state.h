#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/model/active_contacts.h"
#include "core/model/objective.h"
#include "core/model/solver.h"
#include "core/numerics/block_cholesky.h"
#include "core/numerics/hard_positions.h"
#include "core/numerics/rounding_floor.h"

namespace drape {

/// Where a level was when the change of conditions under way was begun.
struct ChangeBegun {
  int steps = 0, iterations = 0;
  double seconds = 0;
};

/// What the cloth did after a part of a change of conditions had been made.
struct ChangeResponse {
  Positions from;   ///< where it was before (n×3) [m]
  Positions to;     ///< where it was taken along to
  double part = 0;  ///< of what was left of the change; 0 where there was no answer, or no more to be made
};

/// How many shares of the projection there are to choose from.
constexpr int projection_share_count = 7;

/// A level under way, at the beginning of an implicit step: all that the steps to come depend on, bit for
/// bit. What follows from the rest (energy, gradient, contacts, the layout of the factor) is not in it.
struct NewtonState {
  LevelResult so_far;         ///< x, counts and seconds up to here
  double step_size = 0;       ///< h of the step to come [s]
  double step_length = 1;     ///< α of the last line search
  double residual_scale = 1;  ///< of the force residual [N]
  int projection_share = 0;   ///< which of the shares of the projection worked last
  std::array<double, 3> decrements{};
  std::string held_by;   ///< what kept the last step short, in words
  bool relaxed = false;  ///< the objective was a proxy and is the plain energy now
  HardPositions::Memory positions;
  ChangeBegun changed_at;
  ChangeResponse response;
  int iterations_of_step = 1;  ///< that the step to come may take
  int strained_for = 0;  ///< steps in turn that ended with forces far beyond the load; negative: without
  bool slowed = false;   ///< for that, so that h does not grow
  IdleSteps::Memory idle;
  int times_held_up = 0;             ///< in turn, the change of conditions under way
  std::array<double, 3> begun_at{};  ///< middle of the free vertices, at the start or the last change [m]
  ContactMemory contacts;
  Objective::PatternMemory pattern;
  BlockCholesky::Analysis analysis;

  // Of a factor that more than one iteration shares; without values there is none to keep.
  int factor_age = 0;
  double factor_shift = 0;            ///< what was added to it, in units of the masses [1/s²]
  std::vector<double> factor_values;  ///< the blocks of the matrix that it is of
};

/// Where a method is: between two levels, or in the middle of one.
struct MethodState {
  std::vector<LevelResult> finished;     ///< levels, in order
  int level = 0;                         ///< the one to go on with
  std::optional<NewtonState> under_way;  ///< of that level; without it, the level is to begin
  double seconds = 0;                    ///< of the method so far

  /// The state of a level under way, null of any other.
  const NewtonState* of(int l) const { return l == level && under_way ? &*under_way : nullptr; }
};

/// Puts a problem's models under the conditions that its levels had in the state.
inline void restore_conditions(const Problem& problem, const MethodState& state) {
  if (!problem.conditions) return;
  for (const LevelResult& level : state.finished) problem.conditions->restore(level.level, level.conditions);
  if (state.under_way) problem.conditions->restore(state.level, state.under_way->so_far.conditions);
}

}  // namespace drape

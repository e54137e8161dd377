#pragma once

#include <exception>
#include <semaphore>
#include <thread>
#include <utility>
#include <vector>

#include "core/kernel/interfaces/solver.h"
#include "core/kernel/threads/stopwatch.h"
#include "core/numerics/hierarchy/hierarchy.h"
#include "core/numerics/model/level_model.h"
#include "core/numerics/solve/newton_state.h"

namespace drape {

/// A solve that its caller advances one Newton iteration at a time, to look at the state or to intervene in
/// between. Its results have the same bits as Solver::solve.
///
/// The solver runs in a thread of its own. It and the caller take turns, so no member is read and written at
/// the same time. One thread at a time may call the members.
class SteppedSolve : private Observer {
 public:
  /// The solver and the problem must outlive the object. `from` is a state to resume from.
  /// Throws std::runtime_error if the solver cannot resume and `from` is not the beginning.
  SteppedSolve(const Solver& solver, const Problem& problem, MethodState from = {});
  /// Stops the solve at its next step and waits for that.
  ~SteppedSolve() override;
  SteppedSolve(const SteppedSolve&) = delete;
  SteppedSolve& operator=(const SteppedSolve&) = delete;

  /// Runs to the end of the next iteration. Returns false if the solve has ended instead. Rethrows what the
  /// solver throws.
  bool advance();

  const IterationRow& row() const { return row_; }  ///< of the last iteration
  const Positions& x() const { return x_; }         ///< n×3, the state after it [m]
  bool ended() const { return ended_; }
  const std::vector<LevelResult>& finished() const { return finished_; }  ///< levels, in order
  /// The state at the beginning of the step of the last iteration. Resuming from it repeats that step. Of a
  /// solver that cannot resume, only its finished levels.
  const MethodState& checkpoint() const { return checkpoint_; }

  /// Ends the level at the beginning of the next step. Without effect on the finest level.
  void refine() { refine_ = true; }
  /// Ends the solve at the beginning of the next step: its level is cancelled.
  void stop() { stop_ = true; }

 private:
  void run();

  void level_started(int) override { refine_ = false; }
  void iteration(const IterationRow& row, const Positions& x) override;
  void level_finished(const LevelResult& result) override;
  bool stop_requested() override { return stop_; }
  bool refine_requested() override { return std::exchange(refine_, false); }
  bool checkpoint_due() override { return true; }
  void checkpoint(const NewtonState& state) override;

  const Solver& solver_;
  const Problem& problem_;
  const MethodState from_;
  const Stopwatch clock_;  // of the method, for checkpoints
  IterationRow row_;
  Positions x_;
  std::vector<LevelResult> finished_;
  MethodState checkpoint_;
  bool refine_ = false, stop_ = false;

  std::binary_semaphore solvers_turn_{0}, callers_turn_{0};
  bool ended_ = false;
  std::exception_ptr error_;
  std::thread thread_;  // begins with the first advance
};

}  // namespace drape

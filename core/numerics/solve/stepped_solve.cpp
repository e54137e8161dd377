#include "core/numerics/solve/stepped_solve.h"

#include <stdexcept>

#include "core/kernel/threads/held_signals.h"

namespace drape {

SteppedSolve::SteppedSolve(const Solver& solver, const Problem& problem, MethodState from)
    : solver_(solver),
      problem_(problem),
      from_(std::move(from)),
      clock_(from_.seconds),
      finished_(from_.finished),
      checkpoint_(from_) {
  const bool from_beginning = from_.finished.empty() && from_.level == 0 && !from_.under_way;
  if (!from_beginning && !solver.can_resume())
    throw std::runtime_error("the solver cannot go on from a state; start it at the beginning");
}

SteppedSolve::~SteppedSolve() {
  if (!thread_.joinable()) return;
  stop_ = true;
  try {
    while (advance()) {
    }
  } catch (...) {  // nobody is left who could be told
  }
  thread_.join();
}

bool SteppedSolve::advance() {
  if (ended_) return false;
  const HeldSignals held;  // as its solver's thread, which may be within METIS
  if (thread_.joinable())
    solvers_turn_.release();
  else
    thread_ = std::thread([this] { run(); });
  callers_turn_.acquire();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  return !ended_;
}

void SteppedSolve::run() {
  try {
    solver_.resume(problem_, from_, *this);
  } catch (...) {
    error_ = std::current_exception();
  }
  ended_ = true;
  callers_turn_.release();
}

void SteppedSolve::iteration(const IterationRow& row, const Positions& x) {
  row_ = row;
  x_ = x;
  callers_turn_.release();
  solvers_turn_.acquire();
}

void SteppedSolve::level_finished(const LevelResult& result) {
  finished_.push_back(result);
  if (result.outcome == Outcome::cancelled) return;  // its checkpoint stays, to be resumed
  checkpoint_ = {finished_, result.level + 1, std::nullopt, clock_.seconds()};
}

void SteppedSolve::checkpoint(const NewtonState& state) {
  checkpoint_.level = state.so_far.level;
  checkpoint_.under_way = state;
  checkpoint_.seconds = clock_.seconds();
}

}  // namespace drape
